#include "routebench/planning/sha256.hpp"

#include <sha2.h>
#include <sys/types.h>

#include <array>
#include <cstdint>
#include <fstream>

namespace routebench {
namespace {

class Digest {
 public:
  Digest() { SHA256Init(&context_); }

  void add(std::string_view bytes) {
    SHA256Update(&context_, reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  }

  std::string finish() {
    std::string text(SHA256_DIGEST_STRING_LENGTH, '\0');
    SHA256End(&context_, text.data());
    text.pop_back();  // the zero at its end
    return text;
  }

 private:
  SHA2_CTX context_{};
};

}  // namespace

std::string sha256(std::string_view bytes) {
  Digest digest;
  digest.add(bytes);
  return digest.finish();
}

std::optional<std::string> sha256_of_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return std::nullopt;
  Digest digest;
  std::array<char, 65536> chunk{};
  do {
    in.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    digest.add({chunk.data(), static_cast<std::size_t>(in.gcount())});
  } while (in);
  if (!in.eof()) return std::nullopt;
  return digest.finish();
}

}  // namespace routebench
