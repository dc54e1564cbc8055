#include "routebench/geometry/lazy_library.hpp"

#include <dlfcn.h>

#include <filesystem>

#include "routebench/geometry/error.hpp"

namespace routebench {

void* function_in_library(const std::string& library, const std::string& function,
                          const std::string& what) {
  // From the folder of this library, whatever path others are sought in.
  Dl_info self{};
  dladdr(reinterpret_cast<const void*>(&function_in_library), &self);
  const std::filesystem::path file =
      std::filesystem::path(self.dli_fname).replace_filename(library);
  void* const found = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  void* const address = found != nullptr ? dlsym(found, function.c_str()) : nullptr;
  if (address == nullptr)
    throw Error(ErrorKind::kInternal, what + " cannot be loaded: " + dlerror());
  return address;
}

}  // namespace routebench
