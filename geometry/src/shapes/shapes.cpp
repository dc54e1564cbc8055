#include "shapes/shapes.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "model/raw_mesh.hpp"
#include "routebench/geometry/nearest_name.hpp"

namespace routebench::shapes {
namespace {

struct Maker {
  const char* name;
  Mesh (*make)(ShapeQuery&);
};

constexpr std::array kMakers{
    Maker{"box", make_box},       Maker{"cylinder", make_cylinder},
    Maker{"sphere", make_sphere}, Maker{"torus", make_torus},
    Maker{"hotend", make_hotend}, Maker{"bracket", make_bracket},
    Maker{"gear", make_gear},     Maker{"comb", make_comb},
    Maker{"text", make_text},     Maker{"islands", make_islands},
    Maker{"gyroid", make_gyroid}, Maker{"voronoi", make_voronoi},
    Maker{"grate", make_grate},
};

}  // namespace

Mesh make_shape(const std::string& spec, const std::string& name,
                const std::map<std::string, std::string>& parameters) {
  const auto* const maker =
      std::find_if(kMakers.begin(), kMakers.end(), [&](const Maker& m) { return name == m.name; });
  if (maker == kMakers.end()) {
    std::vector<std::string> names;
    std::string list;
    for (const Maker& m : kMakers) {
      names.emplace_back(m.name);
      list += (list.empty() ? "" : ", ") + names.back();
    }
    const auto near = nearest_name(name, names);
    models::refuse_model(spec,
                         "unknown shape " + models::in_quotes(name) +
                             (near ? ", did you mean " + models::in_quotes(*near) + "?" : "") +
                             " (known: " + list + ")");
  }
  ShapeQuery query(spec, parameters);
  return maker->make(query);
}

}  // namespace routebench::shapes
