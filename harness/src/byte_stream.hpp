#pragma once
/// Records as bytes: for what a child process sends to its parent and for what is hashed. Fields
/// carry their length, so that different records never have equal bytes.

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "routebench/geometry/error.hpp"

namespace routebench {

class ByteWriter {
 public:
  ByteWriter& add(std::uint64_t value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    bytes_.append(bytes, sizeof value);
    return *this;
  }
  ByteWriter& add(std::int64_t value) { return add(std::bit_cast<std::uint64_t>(value)); }
  /// The two zeros are one value.
  ByteWriter& add(double value) { return add(std::bit_cast<std::uint64_t>(value + 0.0)); }
  ByteWriter& add(std::string_view text) {
    add(std::uint64_t{text.size()});
    bytes_.append(text);
    return *this;
  }

  [[nodiscard]] const std::string& bytes() const noexcept { return bytes_; }

 private:
  std::string bytes_;
};

/// Reads what a ByteWriter wrote. Throws Error{kInternal} where the bytes end too early.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : left_(bytes) {}

  [[nodiscard]] std::uint64_t whole() {
    std::uint64_t value = 0;
    const std::string_view bytes = take(sizeof value);
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }
  [[nodiscard]] std::int64_t integer() { return std::bit_cast<std::int64_t>(whole()); }
  [[nodiscard]] double real() { return std::bit_cast<double>(whole()); }
  [[nodiscard]] std::string text() { return std::string(take(whole())); }
  /// A number of records of at least `least_bytes` each: no more than the bytes that are left.
  [[nodiscard]] std::size_t count(std::size_t least_bytes) {
    const std::uint64_t records = whole();
    if (records > left_.size() / least_bytes) fail();
    return records;
  }
  /// To be called when all was read.
  void finish() const {
    if (!left_.empty()) fail();
  }

 private:
  [[noreturn]] static void fail() { throw Error(ErrorKind::kInternal, "a record is garbled"); }

  std::string_view take(std::uint64_t size) {
    if (size > left_.size()) fail();
    const std::string_view bytes = left_.substr(0, size);
    left_.remove_prefix(size);
    return bytes;
  }

  std::string_view left_;
};

}  // namespace routebench
