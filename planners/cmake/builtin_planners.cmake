# routebench_builtin_planners(<name>...)
#
# Compiles <name>.cpp for every name into the static library routebench::planners, with the helpers
# that the variable <name>_HELPERS lists, and writes the one function that registers them: no static
# initialiser, which a linker drops from an archive in silence. Helpers include each other relative
# to the folder of the planners.
function(routebench_builtin_planners)
  set(declarations "")
  set(calls "")
  set(sources "")
  foreach(name IN LISTS ARGN)
    string(APPEND declarations "void routebench_register_${name}(routebench::Registry& registry);\n")
    string(APPEND calls "  routebench_register_${name}(registry);\n")
    list(APPEND sources ${name}.cpp ${${name}_HELPERS})
  endforeach()
  set(generated ${CMAKE_CURRENT_BINARY_DIR}/builtin_planners.cpp)
  file(CONFIGURE OUTPUT ${generated} @ONLY CONTENT [=[
// Generated from the list in planners/CMakeLists.txt.
#include "routebench/planning/plugin.hpp"

@declarations@
namespace routebench {
void register_builtin_planners([[maybe_unused]] Registry& registry) {
@calls@}
}  // namespace routebench
]=])
  add_library(routebench_planners STATIC ${generated} ${sources})
  add_library(routebench::planners ALIAS routebench_planners)
  target_compile_definitions(routebench_planners PRIVATE ROUTEBENCH_BUILTIN)
  target_include_directories(routebench_planners PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  target_link_libraries(routebench_planners PUBLIC routebench::planning PRIVATE routebench_warnings)
endfunction()
