#include "model/threemf.hpp"

#include <dlfcn.h>

#include <string>

#include "routebench/geometry/error.hpp"

namespace routebench::models {
namespace {

using Reader = decltype(routebench_read_3mf);

/// From where this library lies; loaded once, for good.
Reader& reader() {
  static Reader* const found = [] {
    void* const library = dlopen(ROUTEBENCH_3MF_LIBRARY, RTLD_NOW | RTLD_LOCAL);
    void* const symbol = library != nullptr ? dlsym(library, "routebench_read_3mf") : nullptr;
    if (symbol == nullptr)
      throw Error(ErrorKind::kInternal,
                  std::string("the reader of 3MF files cannot be loaded: ") + dlerror());
    return reinterpret_cast<Reader*>(symbol);
  }();
  return *found;
}

}  // namespace

RawMesh read_3mf(std::span<const char> bytes, const ReadContext& context) {
  RawMesh mesh;
  reader()(bytes, context, mesh);
  return mesh;
}

}  // namespace routebench::models
