#pragma once
/// From a model's name to a mesh that can be sliced.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "routebench/geometry/parallel.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench {

/// What became of a mesh that was simplified.
struct Simplification {
  std::size_t triangles_before = 0;
  std::size_t triangles_after = 0;
  /// Largest distance between both surfaces, each looked at from the vertices and the middles of
  /// the triangles of the other.
  double deviation_mm = 0;
};

/// What was found in a mesh, as it came (before anything was mended).
struct MeshReport {
  std::size_t triangles = 0;
  std::size_t vertices = 0;  ///< after exact welding
  Point3 lower_mm;           ///< bounding box after scaling and placing
  Point3 upper_mm;
  std::size_t components = 0;          ///< pieces joined by edges
  std::size_t open_edges = 0;          ///< edges with one triangle
  std::size_t non_manifold_edges = 0;  ///< edges with three or more triangles
  std::size_t flipped_triangles =
      0;  ///< triangles that disagree with their neighbours on what is outside
  std::size_t degenerate_triangles = 0;
  std::size_t duplicate_triangles = 0;
  double volume_mm3 = 0;  ///< signed, after mending; what the outside orientation encloses
  std::optional<Simplification>
      simplification;  ///< if the spec asks for one; all above is from before
};

struct ModelOptions {
  bool repair = false;  ///< go on where a sound reader would refuse (NaN corners, truncated files)
};

/// A model ready to be sliced: on z = 0, oriented, without degenerate triangles.
struct Model {
  std::string spec;  ///< as the user wrote it
  Mesh mesh;
  MeshReport report;
  std::vector<std::string> warnings;  ///< one line each, without the model's name
};

/// Reads or makes a model.
///
/// Takes  a spec: `shape:NAME?key=value&...`, `cgal:PATH?...`, or a path to an STL (binary or
/// ASCII, told apart by
///        content), OBJ, OFF, PLY or 3MF file. `?size=60` scales the largest side to 60 mm;
///        `?simplify=0.1` leaves a tenth of the triangles.
/// Returns the model moved to z = 0. x and y stay as they are unless they lie further than 1 m from
/// the origin: then the
///        bounding box is moved to begin at x = y = 0 and a warning says so.
/// The mesh does not depend on the loop that runs it.
/// Throws Error{kBadInput} in one line for what cannot be used.
/// Cost   linear in the file and the triangles; simplifying takes far longer than all else.
[[nodiscard]] Model load_model(const std::string& spec, const ModelOptions& options = {},
                               const ParallelFor& parallel_for = serial_for);

/// One number that tells whether two meshes are the same surface, bit for bit. It depends on the
/// coordinates and directions of the triangles; neither on their order nor on the order of the
/// vertices nor on the corner at which a triangle starts.
/// Cost   linear in vertices and triangles.
[[nodiscard]] std::uint64_t content_hash(const Mesh& mesh,
                                         const ParallelFor& parallel_for = serial_for);

}  // namespace routebench
