#include "routebench/geometry/model.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/cgal_data.hpp"
#include "model/formats.hpp"
#include "model/mapped_file.hpp"
#include "model/mend.hpp"
#include "model/model_spec.hpp"
#include "model/placement.hpp"
#include "model/raw_mesh.hpp"
#include "model/simplify_mesh.hpp"
#include "shapes/shapes.hpp"

namespace routebench {
namespace {

using models::MappedFile;
using models::ModelSpec;
using models::RawMesh;

/// How messages call a model: without the parameters that say how large it shall be.
std::string name_of(const std::string& spec, const ModelSpec& parsed) {
  switch (parsed.scheme) {
    case ModelSpec::Scheme::kShape:
      return spec;
    case ModelSpec::Scheme::kCgal:
      return "cgal:" + parsed.subject;
    case ModelSpec::Scheme::kFile:
      break;
  }
  return parsed.subject;
}

RawMesh read_model(const ModelSpec& parsed, const models::ReadContext& context) {
  if (parsed.scheme == ModelSpec::Scheme::kShape) {
    return {shapes::make_shape(context.name, parsed.subject, parsed.query), {}, false};
  }
  if (!parsed.query.empty()) {
    models::refuse_model(context.name, "unknown parameter " +
                                           models::in_quotes(parsed.query.begin()->first) +
                                           "; a file knows only ?size= and ?simplify=");
  }
  if (parsed.scheme == ModelSpec::Scheme::kCgal) {
    return models::read_mesh(models::read_cgal_data(context.name, parsed.subject), context);
  }
  const MappedFile file(parsed.subject);
  return models::read_mesh(file.bytes(), context);
}

}  // namespace

Model load_model(const std::string& spec, const ModelOptions& options,
                 const ParallelFor& parallel_for) {
  ModelSpec parsed = models::parse_model_spec(spec);
  const std::optional<double> size_mm = models::take_size_mm(spec, parsed);
  const std::optional<double> simplify_share = models::take_simplify_share(spec, parsed);
  const std::string name = name_of(spec, parsed);
  RawMesh raw = read_model(parsed, {name, options.repair, parallel_for});

  Model model;
  model.spec = spec;
  models::mend(raw.mesh, name, model.report, raw.warnings, parallel_for);
  if (simplify_share)
    model.report.simplification = models::simplify_mesh(raw.mesh, *simplify_share, name);
  const auto [scale, bounds] = models::place(raw, size_mm, name, parallel_for);
  if (model.report.simplification) model.report.simplification->deviation_mm *= scale;
  model.report.volume_mm3 *= scale * scale * scale;
  model.report.lower_mm = bounds.lower;
  model.report.upper_mm = bounds.upper;
  model.mesh = std::move(raw.mesh);
  model.warnings = std::move(raw.warnings);
  return model;
}

}  // namespace routebench
