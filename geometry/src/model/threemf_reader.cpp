#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "model/face_sink.hpp"
#include "model/threemf.hpp"
#include "model/zip_archive.hpp"

namespace routebench::models {
namespace {

/// More than any plate holds; a small file can ask for any number of copies.
constexpr std::size_t kMostInstances = 100'000;
constexpr std::size_t kMostFaces = 50'000'000;

/// The name of a node or an attribute without its namespace.
std::string_view local(const char* name) {
  const std::string_view whole = name;
  return whole.substr(whole.rfind(':') + 1);  // npos + 1 is 0
}

pugi::xml_node child(const pugi::xml_node& node, std::string_view name) {
  return node.find_child([&](const pugi::xml_node& c) { return local(c.name()) == name; });
}

std::string attribute(const pugi::xml_node& node, std::string_view name) {
  const auto found =
      node.find_attribute([&](const pugi::xml_attribute& a) { return local(a.name()) == name; });
  return found.as_string();
}

/// Rows of x, y, z and of the displacement, as the format has them: p' = p * matrix.
struct Transform {
  std::array<double, 12> m{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};

  [[nodiscard]] Point3 apply(const Point3& p) const {
    return {p.x * m[0] + p.y * m[3] + p.z * m[6] + m[9],
            p.x * m[1] + p.y * m[4] + p.z * m[7] + m[10],
            p.x * m[2] + p.y * m[5] + p.z * m[8] + m[11]};
  }
  /// First this, then `next`.
  [[nodiscard]] Transform then(const Transform& next) const {
    Transform both;
    for (std::size_t row = 0; row < 4; ++row) {
      const Point3 from{m[3 * row], m[3 * row + 1], m[3 * row + 2]};
      Transform turn = next;
      if (row < 3) turn.m[9] = turn.m[10] = turn.m[11] = 0;  // directions are not displaced
      const Point3 to = turn.apply(from);
      both.m[3 * row] = to.x;
      both.m[3 * row + 1] = to.y;
      both.m[3 * row + 2] = to.z;
    }
    return both;
  }
  /// Whether inside and outside change places.
  [[nodiscard]] bool mirrors() const {
    return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
               m[2] * (m[3] * m[7] - m[4] * m[6]) <
           0;
  }
};

class ThreeMf {
 public:
  ThreeMf(std::span<const char> bytes, const ReadContext& context)
      : context_(context), archive_(bytes, context.name), sink_(context) {}

  RawMesh read() {
    const std::string root = root_path();
    const Part& part = load(root);
    const double unit_mm = unit_of(part);
    Transform scale;
    scale.m[0] = scale.m[4] = scale.m[8] = unit_mm;
    const pugi::xml_node build = child(part.model, "build");
    for (const pugi::xml_node& item : build) {
      if (local(item.name()) != "item" || attribute(item, "printable") == "0") continue;
      place(item, root, scale, 0);
    }
    if (instances_ == 0) refuse(root + ": the build has no item to print");
    RawMesh raw = sink_.finish(false);
    warn_about_settings(raw);
    raw.warnings.insert(raw.warnings.end(), warnings_.begin(), warnings_.end());
    return raw;
  }

 private:
  /// One XML file of the package.
  struct Part {
    std::string text;  ///< which the document points into
    pugi::xml_document document;
    pugi::xml_node model;
    std::map<std::string, pugi::xml_node> objects;
  };

  [[noreturn]] void refuse(const std::string& complaint) const {
    refuse_model(context_.name, complaint);
  }

  void parse(Part& part, const std::string& path) const {
    const pugi::xml_parse_result result =
        part.document.load_buffer_inplace(part.text.data(), part.text.size());
    if (result) return;
    refuse(path + ", byte " + std::to_string(result.offset) + ": " + result.description());
  }

  /// The model that the package begins with.
  std::string root_path() {
    Part relations;
    if (auto text = archive_.read("_rels/.rels")) {
      relations.text = *std::move(text);
      parse(relations, "_rels/.rels");
      for (const pugi::xml_node& relation : child(relations.document, "Relationships")) {
        if (attribute(relation, "Type").ends_with("/3dmodel")) {
          return without_slash(attribute(relation, "Target"));
        }
      }
    }
    for (const std::string& name : archive_.names()) {
      if (name.ends_with(".model")) return name;
    }
    refuse("not a 3MF file: the zip archive holds no model");
  }

  static std::string without_slash(std::string path) {
    if (path.starts_with('/')) path.erase(0, 1);
    return path;
  }

  Part& load(const std::string& path) {
    const auto [found, added] = parts_.try_emplace(path);
    Part& part = found->second;
    if (!added) return part;
    auto text = archive_.read(path);
    if (!text) refuse("the archive lacks " + path);
    part.text = *std::move(text);
    parse(part, path);
    part.model = child(part.document, "model");
    if (!part.model) refuse(path + ": no element model");
    for (const pugi::xml_node& object : child(part.model, "resources")) {
      if (local(object.name()) == "object") part.objects.emplace(attribute(object, "id"), object);
    }
    return part;
  }

  [[nodiscard]] double unit_of(const Part& part) const {
    const std::string unit = attribute(part.model, "unit");
    constexpr std::array<std::pair<std::string_view, double>, 7> kUnits{{{"", 1},
                                                                         {"millimeter", 1},
                                                                         {"micron", 0.001},
                                                                         {"centimeter", 10},
                                                                         {"meter", 1000},
                                                                         {"inch", 25.4},
                                                                         {"foot", 304.8}}};
    for (const auto& [name, mm] : kUnits) {
      if (name == unit) return mm;
    }
    refuse("unit " + in_quotes(unit) +
           " is unknown: micron, millimeter, centimeter, inch, foot or meter");
  }

  [[nodiscard]] double number(std::string_view text, const std::string& what) const {
    double value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || stop != text.data() + text.size()) {
      refuse(what + ": " + in_quotes(text) + " is not a number");
    }
    return value;
  }

  [[nodiscard]] Transform transform_of(const pugi::xml_node& node, const std::string& what) const {
    Transform transform;
    const std::string text = attribute(node, "transform");
    std::size_t count = 0;
    for (std::size_t at = 0; (at = text.find_first_not_of(" \t\r\n", at)) != std::string::npos;) {
      const std::size_t end = std::min(text.find_first_of(" \t\r\n", at), text.size());
      if (count == 12) refuse(what + ": a transformation has 12 numbers, not more");
      transform.m[count++] = number(std::string_view(text).substr(at, end - at), what);
      at = end;
    }
    if (count != 0 && count != 12) {
      refuse(what + ": a transformation has 12 numbers, not " + std::to_string(count));
    }
    return transform;
  }

  /// Adds the object that an item or a component names.
  void place(const pugi::xml_node& reference, const std::string& from, const Transform& around,
             std::size_t depth) {
    const std::string id = attribute(reference, "objectid");
    const std::string path = without_slash(attribute(reference, "path"));
    const std::string what = "object " + id;
    // A chain longer than there are instances bites its own tail.
    if (++instances_ > kMostInstances || depth > 100) {
      refuse(what + ": components within components without end, or more than " +
             std::to_string(kMostInstances) + " parts");
    }
    const std::string& home = path.empty() ? from : path;
    const Part& part = load(home);
    const auto found = part.objects.find(id);
    if (found == part.objects.end()) refuse(home + ": there is no object " + in_quotes(id));
    const pugi::xml_node object = found->second;
    const std::string type = attribute(object, "type");
    if (!type.empty() && type != "model") return;  // supports and surfaces are no material

    const Transform transform = transform_of(reference, what).then(around);
    if (const pugi::xml_node mesh = child(object, "mesh")) {
      add_mesh(mesh, what, transform);
    } else if (const pugi::xml_node components = child(object, "components")) {
      for (const pugi::xml_node& component : components) {
        if (local(component.name()) == "component") place(component, home, transform, depth + 1);
      }
    } else {
      refuse(what + " is neither a mesh nor made of components");
    }
  }

  void add_mesh(const pugi::xml_node& mesh, const std::string& what, const Transform& transform) {
    if (child(mesh, "beamlattice")) {
      if (!context_.repair) refuse(what + " has a beam lattice, which cannot be read");
      warnings_.push_back(what + ": its beam lattice is left out");
    }
    const auto base = static_cast<std::int64_t>(sink_.vertices());
    for (const pugi::xml_node& vertex : child(mesh, "vertices")) {
      if (local(vertex.name()) != "vertex") continue;
      const auto coordinate = [&](const char* axis) {
        return number(vertex.attribute(axis).value(), what + ", a vertex");
      };
      sink_.add_vertex(transform.apply({coordinate("x"), coordinate("y"), coordinate("z")}));
    }
    const auto count = static_cast<std::int64_t>(sink_.vertices()) - base;
    const bool mirrors = transform.mirrors();
    std::size_t index = 0;
    for (const pugi::xml_node& triangle : child(mesh, "triangles")) {
      if (local(triangle.name()) != "triangle") continue;
      const auto place = [&] { return what + ", triangle " + std::to_string(index); };
      std::array<std::int64_t, 3> corners{};
      for (std::size_t c = 0; c < 3; ++c) {
        corners[c] = corner(triangle.attribute(kCorners[c]).value(), count, place) + base;
      }
      if (mirrors) std::swap(corners[1], corners[2]);
      if (sink_.faces() >= kMostFaces) {
        refuse("more than " + std::to_string(kMostFaces) + " triangles with all copies");
      }
      sink_.add_face(corners, place);
      ++index;
    }
  }

  std::int64_t corner(std::string_view text, std::int64_t count,
                      const FaceSink::Place& place) const {
    std::int64_t value = -1;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || stop != text.data() + text.size() || value < 0 || value >= count) {
      refuse(place() + ": " + in_quotes(text) + " is none of the " + std::to_string(count) +
             " vertices (counted from 0)");
    }
    return value;
  }

  /// Slicers keep in files of their own which parts are no material.
  void warn_about_settings(RawMesh& raw) const {
    for (const char* const file :
         {"Metadata/Slic3r_PE_model.config", "Metadata/model_settings.config"}) {
      const auto settings = archive_.read(file);
      if (!settings) continue;
      for (const char* const word :
           {"ParameterModifier", "NegativeVolume", "SupportBlocker", "SupportEnforcer",
            "modifier_part", "negative_part", "support_blocker", "support_enforcer"}) {
        if (settings->find(word) == std::string::npos) continue;
        raw.warnings.push_back(std::string(file) + " marks parts as " + word +
                               ": they are read as material like the rest");
      }
    }
  }

  static constexpr std::array<const char*, 3> kCorners{"v1", "v2", "v3"};

  const ReadContext& context_;
  ZipArchive archive_;
  FaceSink sink_;
  std::map<std::string, Part> parts_;
  std::size_t instances_ = 0;
  std::vector<std::string> warnings_;
};

}  // namespace
}  // namespace routebench::models

// See threemf.hpp.
void routebench_read_3mf(std::span<const char> bytes,
                         const routebench::models::ReadContext& context,
                         routebench::models::RawMesh& mesh) {
  mesh = routebench::models::ThreeMf(bytes, context).read();
}
