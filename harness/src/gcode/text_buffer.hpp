#pragma once
/// G-code as it is put together.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "fixed_point.hpp"

namespace routebench {

/// A text that grows by pieces of bounded length, without asking for room at every number.
class TextBuffer {
 public:
  /// Makes room for so many more characters to be put.
  void make_room(std::size_t count) {
    if (text_.size() - used_ < count) text_.resize(std::max(2 * text_.size(), used_ + count));
  }
  void put(char c) { text_[used_++] = c; }
  void put(std::string_view piece) {
    piece.copy(text_.data() + used_, piece.size());
    used_ += piece.size();
  }
  void put_number(std::int64_t units, int decimals) {
    used_ =
        static_cast<std::size_t>(put_units(text_.data() + used_, units, decimals) - text_.data());
  }
  [[nodiscard]] std::string_view view() const { return {text_.data(), used_}; }
  /// Leaves it empty.
  [[nodiscard]] std::string take() {
    text_.resize(std::exchange(used_, 0));
    return std::exchange(text_, {});
  }

 private:
  std::string text_;
  std::size_t used_ = 0;
};

}  // namespace routebench
