# routebench_add_planner(<name> <source>...)
#
# Builds a planner as a plugin: the shared library <name>.so, loaded at run time. The source ends with
# ROUTEBENCH_REGISTER(<name>) { ... }.
function(routebench_add_planner name)
  add_library(${name} MODULE ${ARGN})
  set_target_properties(${name} PROPERTIES
    PREFIX "" CXX_STANDARD 20 CXX_STANDARD_REQUIRED ON CXX_EXTENSIONS OFF)
  # Contraction into fused multiply-add would make routes differ between machines.
  target_compile_options(${name} PRIVATE -ffp-contract=off)
  target_link_libraries(${name} PRIVATE routebench::planning)
endfunction()
