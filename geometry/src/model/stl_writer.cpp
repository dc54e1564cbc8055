#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>

#include "model/raw_mesh.hpp"
#include "routebench/geometry/stl.hpp"

namespace routebench {
namespace {

using Float3 = std::array<float, 3>;

Float3 single(const Point3& p) noexcept {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

/// The unit normal, or zeros where a triangle has none.
Float3 normal_of(const Point3& a, const Point3& b, const Point3& c) noexcept {
  const Point3 u{b.x - a.x, b.y - a.y, b.z - a.z};
  const Point3 v{c.x - a.x, c.y - a.y, c.z - a.z};
  const Point3 n{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
  const double length = std::hypot(n.x, n.y, n.z);
  return length > 0 ? single({n.x / length, n.y / length, n.z / length}) : Float3{};
}

}  // namespace

std::string stl_bytes(const Mesh& mesh) {
  if (mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max()) {
    models::refuse_model("binary STL", "cannot hold more than 4294967295 triangles");
  }
  constexpr std::size_t kHeaderText = 80;
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  std::string bytes = "binary STL in mm";
  bytes.resize(kHeaderText + sizeof count + mesh.triangles.size() * 50, '\0');
  char* at = bytes.data() + kHeaderText;
  const auto put = [&at](const auto& value) {
    std::memcpy(at, &value, sizeof value);
    at += sizeof value;
  };
  put(count);
  for (const auto& [i, j, k] : mesh.triangles) {
    const Point3& a = mesh.vertices[i];
    const Point3& b = mesh.vertices[j];
    const Point3& c = mesh.vertices[k];
    put(normal_of(a, b, c));
    put(single(a));
    put(single(b));
    put(single(c));
    put(std::uint16_t{0});
  }
  return bytes;
}

void write_stl(const std::filesystem::path& path, const Mesh& mesh) {
  const std::string bytes = stl_bytes(mesh);
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) models::refuse_model(path.string(), "cannot be written");
}

}  // namespace routebench
