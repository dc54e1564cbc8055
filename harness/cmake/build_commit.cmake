# Writes the header that says which commit a program was built from. Run at every build; the header
# changes only when the answer does, so that nothing is compiled for nothing.
#
# Takes SOURCE_DIR, OUTPUT. Outside a git work tree the commit is empty.
set(commit "")
set(dirty false)
find_program(GIT git)
if(GIT)
  # An archive unpacked inside somebody's work tree is not of that tree.
  execute_process(COMMAND ${GIT} -C ${SOURCE_DIR} ls-files --error-unmatch CMakeLists.txt
    RESULT_VARIABLE untracked OUTPUT_QUIET ERROR_QUIET)
  execute_process(COMMAND ${GIT} -C ${SOURCE_DIR} rev-parse HEAD
    OUTPUT_VARIABLE found RESULT_VARIABLE failed OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT failed AND NOT untracked)
    set(commit ${found})
    execute_process(COMMAND ${GIT} -C ${SOURCE_DIR} status --porcelain --untracked-files=no
      OUTPUT_VARIABLE changes ERROR_QUIET)
    if(changes)
      set(dirty true)
    endif()
  endif()
endif()
set(text "#pragma once
#include <string_view>

namespace routebench {
/// Empty if the program was not built from a git work tree.
inline constexpr std::string_view kGitCommit = \"${commit}\";
inline constexpr bool kGitDirty = ${dirty};
}  // namespace routebench
")
set(before "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} before)
endif()
if(NOT before STREQUAL text)
  file(WRITE ${OUTPUT} "${text}")
endif()
