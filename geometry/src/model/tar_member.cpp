#include "model/tar_member.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

#include "model/raw_mesh.hpp"

namespace routebench::models {
namespace {

constexpr std::size_t kBlock = 512;

struct CloseGz {
  void operator()(gzFile file) const { gzclose_r(file); }
};

class TarGz {
 public:
  explicit TarGz(const std::filesystem::path& path)
      : path_(path.string()), file_(gzopen(path.c_str(), "rb")) {
    if (!file_) refuse_model(path_, "cannot be opened");
  }

  /// Goes to the next file; false at the end of the archive.
  bool next() {
    skip_rest();
    std::array<char, kBlock> header{};
    if (!fill(header.data(), header.size())) return false;
    const auto field = [&](std::size_t offset, std::size_t size) {
      const std::string_view text(header.data() + offset, size);
      return text.substr(0, text.find('\0'));
    };
    name_ = field(0, 100);
    if (name_.empty()) return false;  // two empty blocks end an archive
    if (const std::string_view prefix = field(345, 155); !prefix.empty()) {
      name_ = std::string(prefix) + '/' + name_;
    }
    size_ = 0;
    for (const char digit : field(124, 12)) {
      if (digit >= '0' && digit <= '7') size_ = size_ * 8 + static_cast<std::size_t>(digit - '0');
    }
    left_ = (size_ + kBlock - 1) / kBlock * kBlock;
    return true;
  }

  [[nodiscard]] const std::string& name() const { return name_; }

  /// The content of the present file.
  std::string content() {
    std::string text;
    std::array<char, 1U << 14U> chunk{};
    while (text.size() < size_) {
      const std::size_t part = std::min(chunk.size(), size_ - text.size());
      if (!fill(chunk.data(), part)) refuse_model(path_, "a damaged archive");
      text.append(chunk.data(), part);
      left_ -= part;
    }
    return text;
  }

 private:
  bool fill(char* to, std::size_t bytes) {
    return gzread(file_.get(), to, static_cast<unsigned>(bytes)) == static_cast<int>(bytes);
  }

  void skip_rest() {
    std::array<char, 1U << 14U> chunk{};
    while (left_ > 0) {
      const std::size_t part = std::min(chunk.size(), left_);
      if (!fill(chunk.data(), part)) refuse_model(path_, "a damaged archive");
      left_ -= part;
    }
  }

  std::string path_;
  std::unique_ptr<gzFile_s, CloseGz> file_;
  std::string name_;
  std::size_t size_ = 0;
  std::size_t left_ = 0;  ///< bytes of the present file, with padding, that were not read
};

}  // namespace

std::optional<std::string> read_tar_gz_member(const std::filesystem::path& archive,
                                              const std::string& member,
                                              std::vector<std::string>* names) {
  TarGz tar(archive);
  while (tar.next()) {
    if (tar.name() == member) return tar.content();
    if (names != nullptr) names->push_back(tar.name());
  }
  return std::nullopt;
}

}  // namespace routebench::models
