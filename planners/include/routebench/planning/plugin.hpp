#pragma once
/// All that a planner's source includes, and what makes it a plugin.
///
/// The same file is compiled into the program (one word in planners/CMakeLists.txt) or built as a
/// shared library that is loaded at run time. Either way it ends with
///
///     ROUTEBENCH_REGISTER(spiral) { registry.add<Spiral>(); }

#include <filesystem>
#include <string>

#include "routebench/planning/planner.hpp"
#include "routebench/planning/registry.hpp"

namespace routebench {

/// Grows whenever a type that crosses the border between program and plugin changes.
inline constexpr int kPluginAbi = 3;

/// Standard library, its ABI flag and debug containers, language level: what must agree between
/// program and plugin because C++ types cross the border.
[[nodiscard]] constexpr const char* plugin_build_id() noexcept;

/// What a plugin's one exported C function returns. Stays as it is in every version, so that a
/// plugin of another version can be told from ours before anything else of it is touched.
struct PluginDescription {
  int abi;
  const char* build_id;
  const char* name;
  void (*register_planners)(Registry& registry);
};

/// One file that was looked at.
struct PluginRecord {
  std::string file;
  bool by_name = true;  ///< asked for; else it was found on the search path
  bool loaded = false;
  std::string refused_because;  ///< empty if loaded
  std::string build_id;
  std::string sha256;                 ///< of the file
  std::vector<std::string> planners;  ///< names that it registered
};

/// Opens a shared library, checks that it was built for this program, and registers its planners.
/// The library stays open until the program ends: its code outlives every object made from it.
/// Returns a record that says what happened; never throws for a bad plugin.
[[nodiscard]] PluginRecord load_plugin(Registry& registry, const std::filesystem::path& file);

/// Registers the planners that are compiled in (generated from the list in
/// planners/CMakeLists.txt).
void register_builtin_planners(Registry& registry);

}  // namespace routebench

#define ROUTEBENCH_STRINGIFY_(x) #x
#define ROUTEBENCH_STRINGIFY(x) ROUTEBENCH_STRINGIFY_(x)

namespace routebench {
constexpr const char* plugin_build_id() noexcept {
#if defined(_LIBCPP_VERSION)
  return "libc++ " ROUTEBENCH_STRINGIFY(_LIBCPP_VERSION) " c++" ROUTEBENCH_STRINGIFY(__cplusplus);
#else
  return "libstdc++ abi " ROUTEBENCH_STRINGIFY(_GLIBCXX_USE_CXX11_ABI)
#if defined(_GLIBCXX_DEBUG)
      " debug-containers"
#endif
      " " ROUTEBENCH_STRINGIFY(__cplusplus);
#endif
}
}  // namespace routebench

#if defined(ROUTEBENCH_BUILTIN)
#define ROUTEBENCH_REGISTER(NAME) void routebench_register_##NAME(::routebench::Registry& registry)
#else
#define ROUTEBENCH_REGISTER(NAME)                                                   \
  static void routebench_register_##NAME(::routebench::Registry& registry);         \
  extern "C" __attribute__((visibility("default"))) ::routebench::PluginDescription \
  routebench_plugin() {                                                             \
    return {::routebench::kPluginAbi, ::routebench::plugin_build_id(), #NAME,       \
            &routebench_register_##NAME};                                           \
  }                                                                                 \
  static void routebench_register_##NAME(::routebench::Registry& registry)
#endif
