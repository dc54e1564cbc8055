#include "model/threemf.hpp"

#include "routebench/geometry/lazy_library.hpp"

namespace routebench::models {

RawMesh read_3mf(std::span<const char> bytes, const ReadContext& context) {
  using Reader = decltype(routebench_read_3mf);
  static Reader* const reader = reinterpret_cast<Reader*>(function_in_library(
      ROUTEBENCH_3MF_LIBRARY, "routebench_read_3mf", "the reader of 3MF files"));
  RawMesh mesh;
  reader(bytes, context, mesh);
  return mesh;
}

}  // namespace routebench::models
