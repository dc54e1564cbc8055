#include "routebench/geometry/model.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/content_hash.hpp"
#include "model/mapped_file.hpp"
#include "model/mend.hpp"
#include "model/model_spec.hpp"
#include "model/placement.hpp"
#include "model/raw_mesh.hpp"
#include "model/stl_reader.hpp"
#include "shapes/shapes.hpp"

namespace routebench {
namespace {

RawMesh read_model(const std::string& spec, ModelSpec& parsed, const ModelOptions& options) {
  if (parsed.scheme == ModelSpec::Scheme::kShape) {
    return {make_shape(spec, parsed.subject, parsed.query), {}, false};
  }
  if (!parsed.query.empty()) {
    refuse_model(
        spec, "unknown parameter '" + parsed.query.begin()->first + "'; a file knows only ?size=");
  }
  const MappedFile file(parsed.subject);
  return read_stl(file.bytes(), {parsed.subject, options.repair});
}

}  // namespace

Model load_model(const std::string& spec, const ModelOptions& options) {
  ModelSpec parsed = parse_model_spec(spec);
  const std::optional<double> size_mm = take_size_mm(spec, parsed);
  RawMesh raw = read_model(spec, parsed, options);

  Model model;
  model.spec = spec;
  const bool made = parsed.scheme == ModelSpec::Scheme::kShape;
  const std::string& name = made ? spec : parsed.subject;
  mend(raw.mesh, name, model.report, raw.warnings);
  const double scale = place(raw, size_mm, name);
  const Bounds bounds = bounds_of(raw.mesh);
  model.report.volume_mm3 *= scale * scale * scale;
  model.report.lower_mm = bounds.lower;
  model.report.upper_mm = bounds.upper;
  model.mesh = std::move(raw.mesh);
  model.warnings = std::move(raw.warnings);
  model.content_hash = content_hash(model.mesh);
  return model;
}

}  // namespace routebench
