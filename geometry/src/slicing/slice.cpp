#include "routebench/geometry/slice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <span>
#include <utility>

#include "model/blocks.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/simplify.hpp"
#include "slicing/chain_segments.hpp"
#include "slicing/close_gaps.hpp"
#include "slicing/cut_triangles.hpp"
#include "slicing/slivers.hpp"
#include "slicing/voxel_layers.hpp"

namespace routebench {
namespace {

using slicing::Closing;
using slicing::Contours;
using slicing::CutTable;
using slicing::Planes;

constexpr int kMaxLayers = 100'000;
/// Beyond this a coordinate has no place on the grid that clippers work on.
constexpr double kMaxCoordinateMm = 1e6;

[[noreturn]] void refuse(const std::string& model_name, const std::string& what) {
  throw Error(ErrorKind::kBadInput, model_name + ": " + what);
}

std::string text(double value) {
  std::array<char, 32> buffer;
  const int length = std::snprintf(buffer.data(), buffer.size(), "%.6g", value);
  return {buffer.data(), static_cast<std::size_t>(length)};
}

std::string name_of(const Layer& layer) {
  return "layer " + std::to_string(layer.index) + " (z = " + text(layer.z_mm) + " mm)";
}

/// A contour without the points where it runs straight on, most of which are cuts of diagonals of
/// flat faces: half of all points of technical parts, and what makes equal layers differ.
Ring straightened(const Ring& ring, double straight_mm) {
  // Files round coordinates to about this. Noise goes first, so that it cannot decide which points
  // of a curve are kept.
  constexpr double kNoiseMm = 1e-5;
  const Ring clean = straightened_ring(ring, std::min(kNoiseMm, straight_mm));
  return straightened_ring(slicing::without_spikes(clean), straight_mm);
}

/// "1 gap", "2 gaps".
std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

/// Refuses vertices that lie nowhere, and returns the first of the highest ones.
std::size_t checked_highest(const std::vector<Point3>& vertices, const std::string& model_name,
                            const ParallelFor& parallel_for) {
  // Written so that NaN fails too.
  const auto is_within = [](double coordinate) { return std::abs(coordinate) <= kMaxCoordinateMm; };
  const auto refuse_outside = [&](std::size_t v) {
    const Point3& p = vertices[v];
    if (is_within(p.x) && is_within(p.y) && is_within(p.z)) return;
    refuse(model_name, "vertex " + std::to_string(v) + " at x = " + text(p.x) +
                           ", y = " + text(p.y) + ", z = " + text(p.z) +
                           " mm: coordinates must be numbers of at most 1000 m");
  };
  struct Top {
    double z_mm;
    std::size_t begin;  ///< of the block
  };
  std::vector<Top> tops(models::block_count(vertices.size()));
  const auto check = [&](std::size_t block, std::size_t begin, std::size_t end) {
    // Without branches; which vertex it is matters only if one is outside.
    unsigned outside = 0;
    double top_mm = vertices[begin].z;
    for (std::size_t v = begin; v < end; ++v) {
      const Point3& p = vertices[v];
      outside |= static_cast<unsigned>(!is_within(p.x)) | static_cast<unsigned>(!is_within(p.y)) |
                 static_cast<unsigned>(!is_within(p.z));
      top_mm = std::max(top_mm, p.z);
    }
    for (std::size_t v = begin; outside != 0 && v < end; ++v) refuse_outside(v);
    tops[block] = {top_mm, begin};
  };
  models::for_each_block(vertices.size(), parallel_for, check);
  if (tops.empty()) return 0;
  std::size_t highest = 0;
  for (const Top& top : tops)
    if (top.z_mm > vertices[highest].z)
      for (highest = top.begin; vertices[highest].z != top.z_mm;) ++highest;
  return highest;
}

/// Refuses a triangle that names a vertex which is not there.
void refuse_wrong_corner(const Mesh& mesh, std::size_t triangle, const std::string& model_name) {
  for (const std::uint32_t corner : mesh.triangles[triangle])
    if (corner >= mesh.vertices.size())
      refuse(model_name, "triangle " + std::to_string(triangle) + " names vertex " +
                             std::to_string(corner) + ", but there are only " +
                             std::to_string(mesh.vertices.size()));
}

/// Returns the height of the highest vertex that belongs to a triangle; at least 0.
double checked_top_mm(const Mesh& mesh, const std::string& model_name,
                      const ParallelFor& parallel_for) {
  const std::size_t highest = checked_highest(mesh.vertices, model_name, parallel_for);
  std::vector<std::uint8_t> has_highest(models::block_count(mesh.triangles.size()));
  const auto check = [&](std::size_t block, std::size_t begin, std::size_t end) {
    // Several corners at a time; where a triangle is wrong matters only if one is.
    std::uint32_t last = 0;
    unsigned found = 0;
    for (std::size_t t = begin; t < end; ++t)
      for (const std::uint32_t corner : mesh.triangles[t]) {
        last = std::max(last, corner);
        found |= static_cast<unsigned>(corner == highest);
      }
    for (std::size_t t = begin; last >= mesh.vertices.size() && t < end; ++t)
      refuse_wrong_corner(mesh, t, model_name);
    has_highest[block] = static_cast<std::uint8_t>(found);
  };
  models::for_each_block(mesh.triangles.size(), parallel_for, check);
  double top_mm = 0;
  if (std::find(has_highest.begin(), has_highest.end(), 1) != has_highest.end())
    return std::max(top_mm, mesh.vertices[highest].z);
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle) top_mm = std::max(top_mm, mesh.vertices[corner].z);
  return top_mm;
}

void check_options(const SliceOptions& options) {
  if (!(options.layer_height_mm > 0 && std::isfinite(options.layer_height_mm)))
    throw Error(ErrorKind::kBadInput, "layer_height_mm = " + text(options.layer_height_mm) +
                                          ": must be a number above 0, for example 0.2");
  if (!(options.cell_mm > 0 && std::isfinite(options.cell_mm)))
    throw Error(ErrorKind::kBadInput, "cell_mm = " + text(options.cell_mm) +
                                          ": must be a number above 0, for example 0.45");
  if (!(options.crack_mm >= 0 && std::isfinite(options.crack_mm)))
    throw Error(ErrorKind::kBadInput, "crack_mm = " + text(options.crack_mm) +
                                          ": must be a number of at least 0, for example 0.1");
  if (!(options.straight_mm >= 0 && std::isfinite(options.straight_mm)))
    throw Error(ErrorKind::kBadInput, "straight_mm = " + text(options.straight_mm) +
                                          ": must be a number of at least 0, for example 0.001");
}

/// The planes below a height.
Planes planes_below(double top_mm, double layer_height_mm, const std::string& model_name) {
  if (top_mm / layer_height_mm > kMaxLayers)
    refuse(model_name, "layers of " + text(layer_height_mm) + " mm would be more than " +
                           std::to_string(kMaxLayers) + ": take at least " +
                           text(top_mm / kMaxLayers) + " mm");
  // As in Planes::level the comparison with the planes themselves decides.
  Planes planes{layer_height_mm, static_cast<int>(top_mm / layer_height_mm + 0.5)};
  while (planes.count > 0 && planes.z_mm(planes.count - 1) >= top_mm) --planes.count;
  while (planes.z_mm(planes.count) < top_mm) ++planes.count;
  if (planes.count == 0)
    refuse(model_name, "nothing to print: the model is " + text(top_mm) +
                           " mm high, which is not more than half a layer of " +
                           text(layer_height_mm) +
                           " mm; scale it (?size=...) or take thinner layers");
  return planes;
}

[[noreturn]] void refuse_open(const Layer& layer, const Closing& closing, double crack_mm,
                              const std::string& model_name) {
  refuse(model_name, name_of(layer) + ": a contour is open by " + text(closing.widest_open_mm) +
                         " mm at x = " + text(closing.widest_open_at.x) + ", y = " +
                         text(closing.widest_open_at.y) + "; only cracks up to " + text(crack_mm) +
                         " mm are closed unasked: mend the model, or slice it with --repair");
}

SliceReport summarise(const std::vector<Layer>& layers, const std::vector<Closing>& closings,
                      double crack_mm) {
  SliceReport report;
  std::size_t dropped = 0, turned = 0;
  double longest_dropped_mm = 0;
  const Layer* first_repaired = nullptr;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const Closing& closing = closings[i];
    report.cracks_closed += closing.cracks;
    report.widest_crack_mm = std::max(report.widest_crack_mm, closing.widest_crack_mm);
    report.gaps_repaired += closing.gaps;
    report.widest_gap_mm = std::max(report.widest_gap_mm, closing.widest_gap_mm);
    dropped += closing.dropped;
    longest_dropped_mm = std::max(longest_dropped_mm, closing.longest_dropped_mm);
    turned += closing.turned;
    if (!layers[i].repaired) continue;
    ++report.repaired_layers;
    if (first_repaired == nullptr) first_repaired = &layers[i];
  }
  if (report.cracks_closed > 0)
    report.warnings.push_back("closed " + counted(report.cracks_closed, "crack") +
                              " in contours, the widest " + text(report.widest_crack_mm) + " mm");
  if (report.repaired_layers > 0)
    report.warnings.push_back("repaired " + counted(report.repaired_layers, "layer") +
                              ", the first is " + name_of(*first_repaired));
  if (report.gaps_repaired > 0)
    report.warnings.push_back("closed " + counted(report.gaps_repaired, "gap") + " wider than " +
                              text(crack_mm) + " mm in contours, the widest " +
                              text(report.widest_gap_mm) + " mm");
  if (dropped > 0)
    report.warnings.push_back("left out " + counted(dropped, "open line") +
                              " of surfaces without thickness, the longest " +
                              text(longest_dropped_mm) + " mm");
  if (turned > 0)
    report.warnings.push_back("joined " + counted(turned, "line") +
                              " against their direction: facets disagree on what is outside");
  return report;
}

/// The closed contours of one layer.
struct ClosedContours {
  std::vector<Ring> rings;
  Closing closing;        ///< what was closed for them
  bool at_edges = false;  ///< as of Contours
};

ClosedContours contours_of(std::span<const slicing::Cut> cuts, const Mesh& mesh, double z_mm,
                           const SliceOptions& options) {
  Contours contours = slicing::chain_cuts(cuts, mesh, z_mm);
  ClosedContours closed{{}, {}, contours.at_edges};
  if (!contours.open.empty())
    closed.closing = slicing::close_gaps(contours.open, options.crack_mm, contours.rings);
  if (options.straight_mm > 0) {
    // Slivers first: where the side beside one moves, it would become a notch.
    std::erase_if(contours.rings, [](const Ring& ring) { return slicing::is_sliver(ring); });
    for (Ring& ring : contours.rings) ring = straightened(ring, options.straight_mm);
  }
  closed.rings = std::move(contours.rings);
  return closed;
}

/// Of each layer the lowest one from which walls run straight up to it; itself if there is none.
std::vector<std::size_t> lowest_straight_below(const CutTable& table, const Mesh& mesh,
                                               const SliceOptions& options, std::size_t layers,
                                               const ParallelFor& parallel_for) {
  // Of what straightening may move a side by.
  constexpr double kLeanShare = 0.01;
  std::vector<std::size_t> lowest(layers);
  std::iota(lowest.begin(), lowest.end(), std::size_t{0});
  // Where it moves nothing, each layer has the points of its own cuts.
  if (options.straight_mm <= 0) return lowest;
  parallel_for(layers, [&](std::size_t i) {
    if (i > 0 &&
        run_straight_up(table.layer(i - 1), table.layer(i), mesh, kLeanShare * options.straight_mm))
      lowest[i] = i - 1;
  });
  for (std::size_t& below : lowest) below = lowest[below];
  return lowest;
}

/// Gives each layer its polygons; returns what was closed for them.
std::vector<Closing> fill_layers(const CutTable& table, const Mesh& mesh,
                                 const SliceOptions& options, std::vector<Layer>& layers,
                                 const ParallelFor& parallel_for) {
  std::vector<ClosedContours> contours(layers.size());
  const auto make_contours = [&](std::size_t i) {
    contours[i] = contours_of(table.layer(i), mesh, layers[i].z_mm, options);
  };
  const auto make_polygons = [&](std::size_t i) {
    // Where facets gape by a crack they also overlap by as much; two sides that were straightened
    // may have moved apart by twice what one may.
    const double sliver_mm = std::max(
        {slicing::kSliverMm, contours[i].closing.widest_crack_mm, 2 * options.straight_mm});
    layers[i].polygons = slicing::without_slivers(
        polygons_from_rings(std::move(contours[i].rings), FillRule::kNonZero), sliver_mm);
  };
  // Technical parts have the same contours on many layers, one above the other. There the lowest is
  // done for all; but contours are kept for that only where it is likely, as most layers' would be
  // memory that nothing else needs.
  const auto resembles_next = [&](std::size_t i) {
    return i + 1 < contours.size() && table.layer(i).size() == table.layer(i + 1).size();
  };
  std::vector<std::size_t> first =
      lowest_straight_below(table, mesh, options, contours.size(), parallel_for);
  parallel_for(contours.size(), [&](std::size_t i) {
    if (first[i] != i) return;
    make_contours(i);
    if (!resembles_next(i) && (i == 0 || !resembles_next(i - 1))) make_polygons(i);
  });
  // A gap in a wall may be wider higher up.
  parallel_for(contours.size(), [&](std::size_t i) {
    if (first[i] == i || contours[first[i]].at_edges) return;
    make_contours(i);
    first[i] = i;
  });
  std::vector<std::size_t> kept, equal;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (first[i] == i && i > 0 && resembles_next(i - 1)) {
      const ClosedContours &here = contours[i], &below = contours[first[i - 1]];
      if (here.rings == below.rings &&
          here.closing.widest_crack_mm == below.closing.widest_crack_mm)
        first[i] = first[i - 1];
    }
    first[i] = first[first[i]];
    if (first[i] != i)
      equal.push_back(i);
    else if (!contours[i].rings.empty())
      kept.push_back(i);
  }
  for (const std::size_t i : equal)
    contours[i].rings = std::vector<Ring>{};  // memory for the copies
  parallel_for(kept.size(), [&](std::size_t k) { make_polygons(kept[k]); });
  parallel_for(equal.size(), [&](std::size_t k) {
    layers[equal[k]].polygons = layers[first[equal[k]]].polygons;
  });
  std::vector<Closing> closings;
  for (const ClosedContours& made : contours) closings.push_back(made.closing);
  return closings;
}

constexpr double kMostVoxelBytes = 1U << 30U;

/// The container of a mesh, or a refusal if it is too large.
slicing::VoxelFrame checked_frame(const Mesh& mesh, const Planes& planes, double cell_mm,
                                  const std::string& model_name) {
  const slicing::VoxelFrame frame = slicing::frame_of(mesh, planes, cell_mm);
  if (!(frame.bytes() <= kMostVoxelBytes))
    refuse(model_name, "cells of " + text(cell_mm) + " x " + text(cell_mm) + " x " +
                           text(planes.height_mm) + " mm would take " +
                           text(frame.bytes() / kMostVoxelBytes) +
                           " GiB, more than the 1 GiB that there may be: take larger cells");
  return frame;
}

/// What a closed surface encloses.
double volume_mm3(const Mesh& mesh) {
  double sum = 0;
  for (const auto& [i, k, m] : mesh.triangles) {
    const Point3 &a = mesh.vertices[i], &b = mesh.vertices[k], &c = mesh.vertices[m];
    sum += a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) +
           a.z * (b.x * c.y - b.y * c.x);
  }
  return sum / 6;
}

Slices slice_by_voxels(const Mesh& mesh, const Planes& planes, const SliceOptions& options,
                       const std::string& model_name, const ParallelFor& parallel_for) {
  // Less than the mesh encloses is found only where the flood came in.
  constexpr double kLeastShare = 0.98;
  const slicing::VoxelFrame frame = checked_frame(mesh, planes, options.cell_mm, model_name);
  std::vector<Polygons> polygons = slicing::voxel_layers(mesh, frame, parallel_for);
  Slices slices;
  double cells_mm3 = 0;
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    Layer& layer = slices.layers.emplace_back();
    layer.index = static_cast<int>(i);
    layer.z_mm = planes.z_mm(layer.index);
    layer.height_mm = options.layer_height_mm;
    layer.polygons = std::move(polygons[i]);
    cells_mm3 += area_mm2(layer.polygons) * layer.height_mm;
  }
  const double mesh_mm3 = volume_mm3(mesh);
  if (cells_mm3 < kLeastShare * mesh_mm3)
    slices.report.warnings.push_back(
        "the cells hold " + text(cells_mm3) + " mm3, the mesh " + text(mesh_mm3) +
        " mm3: its surface is open by more than a cell, or its shells overlap");
  return slices;
}

}  // namespace

std::string_view to_string(SliceMethod method) {
  switch (method) {
    case SliceMethod::kBucket:
      return "bucket";
    case SliceMethod::kSweep:
      return "sweep";
    case SliceMethod::kNaive:
      return "naive";
    case SliceMethod::kVoxel:
      break;
  }
  return "voxel";
}

SliceMethod slice_method(std::string_view name) {
  for (const SliceMethod method :
       {SliceMethod::kBucket, SliceMethod::kSweep, SliceMethod::kNaive, SliceMethod::kVoxel})
    if (name == to_string(method)) return method;
  throw Error(ErrorKind::kBadUsage, "unknown slicing method '" + std::string(name) +
                                        "': choose bucket, sweep, naive or voxel");
}

VoxelContainer voxel_container(const Mesh& mesh, const SliceOptions& options,
                               const std::string& model_name) {
  check_options(options);
  const double top_mm = checked_top_mm(mesh, model_name, serial_for);
  const slicing::VoxelFrame frame = checked_frame(
      mesh, planes_below(top_mm, options.layer_height_mm, model_name), options.cell_mm, model_name);
  return {frame.count, frame.bytes()};
}

Slices slice_mesh(const Mesh& mesh, const SliceOptions& options, const std::string& model_name,
                  const ParallelFor& parallel_for) {
  check_options(options);
  const Planes planes = planes_below(checked_top_mm(mesh, model_name, parallel_for),
                                     options.layer_height_mm, model_name);
  if (options.method == SliceMethod::kVoxel)
    return slice_by_voxels(mesh, planes, options, model_name, parallel_for);
  Slices slices;
  slices.layers.resize(static_cast<std::size_t>(planes.count));
  for (std::size_t i = 0; i < slices.layers.size(); ++i) {
    Layer& layer = slices.layers[i];
    layer.index = static_cast<int>(i);
    layer.z_mm = planes.z_mm(layer.index);
    layer.height_mm = options.layer_height_mm;
  }
  const CutTable table = cut_triangles(mesh, planes, options.method, model_name, parallel_for);
  const std::vector<Closing> closings =
      fill_layers(table, mesh, options, slices.layers, parallel_for);
  for (std::size_t i = 0; i < slices.layers.size(); ++i) {
    slices.layers[i].repaired = closings[i].widest_open_mm > 0;
    if (slices.layers[i].repaired && !options.repair)
      refuse_open(slices.layers[i], closings[i], options.crack_mm, model_name);
  }
  if (std::all_of(slices.layers.begin(), slices.layers.end(),
                  [](const Layer& layer) { return layer.polygons.empty(); }))
    refuse(model_name,
           "nothing to print: no layer has any area, the model is a surface without volume");
  slices.report = summarise(slices.layers, closings, options.crack_mm);
  return slices;
}

}  // namespace routebench
