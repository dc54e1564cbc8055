#pragma once
/// Model files made by tests, and what load_model says about them.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "routebench/geometry/error.hpp"
#include "routebench/geometry/model.hpp"
#include "routebench/geometry/stl.hpp"

namespace routebench::test {

/// A file that is there as long as the object.
class ModelFile {
 public:
  ModelFile(std::string_view name, std::string_view bytes) {
    std::string pattern = (std::filesystem::temp_directory_path() / "routebench-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
    folder_ = pattern;
    path_ = folder_ / name;
    rewrite(bytes);
  }
  ~ModelFile() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  ModelFile(const ModelFile&) = delete;
  ModelFile& operator=(const ModelFile&) = delete;

  void rewrite(std::string_view bytes) const {
    std::ofstream(path_, std::ios::binary | std::ios::trunc) << bytes;
  }
  [[nodiscard]] std::string path() const { return path_.string(); }

 private:
  std::filesystem::path folder_;
  std::filesystem::path path_;
};

/// What load_model says when it refuses; the law for every refusal is checked on the way: bad
/// input, one line that begins with the model's name.
inline std::string refusal_of(const std::string& spec, const ModelOptions& options = {}) {
  try {
    static_cast<void>(load_model(spec, options));
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_EQ(error.kind(), ErrorKind::kBadInput) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_TRUE(message.starts_with(spec.substr(0, spec.find('?')))) << message;
    return message;
  }
  ADD_FAILURE() << spec << " was not refused";
  return {};
}

/// Whether some line contains a text.
inline bool mentions(const std::vector<std::string>& lines, std::string_view text) {
  return std::any_of(lines.begin(), lines.end(),
                     [&](const std::string& line) { return line.find(text) != std::string::npos; });
}

/// A mesh as ASCII STL, with all digits of single precision.
inline std::string ascii_stl(const Mesh& mesh, const char* line_end = "\n") {
  std::string text = std::string("solid part") + line_end;
  for (const auto& triangle : mesh.triangles) {
    text += std::string("facet normal 0 0 0") + line_end + "outer loop" + line_end;
    for (const std::uint32_t v : triangle) {
      const Point3& p = mesh.vertices[v];
      const auto single = [](double mm) { return static_cast<double>(static_cast<float>(mm)); };
      std::array<char, 96> line{};
      std::snprintf(line.data(), line.size(), "vertex %.9g %.9g %.9g", single(p.x), single(p.y),
                    single(p.z));
      text += std::string(line.data()) + line_end;
    }
    text += std::string("endloop") + line_end + "endfacet" + line_end;
  }
  return text + "endsolid part" + line_end;
}

}  // namespace routebench::test
