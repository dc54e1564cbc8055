#include "model/threemf.hpp"

#include <dlfcn.h>

#include <filesystem>
#include <string>

#include "routebench/geometry/error.hpp"

namespace routebench::models {
namespace {

using Reader = decltype(routebench_read_3mf);

/// From the folder of this library, whatever path others are sought in; loaded once, for good.
Reader& reader() {
  static Reader* const found = [] {
    Dl_info self{};
    dladdr(reinterpret_cast<const void*>(&read_3mf), &self);
    const std::filesystem::path file =
        std::filesystem::path(self.dli_fname).replace_filename(ROUTEBENCH_3MF_LIBRARY);
    void* const library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
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
