#!/usr/bin/env bash
# plugin_project.sh BUILD_DIR: what an author of a plugin does with nothing but the installed package:
# new-planner, build, check-planner, run, plot. Prints how long all but the compiler took.
set -euo pipefail

build=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/prefix" >/dev/null
# Moved, and without the libraries of the build folder: nothing may point back.
mv "$work/prefix" "$work/moved"
program=$work/moved/bin/routebench
libraries=$(ldd "$program")
if [[ $libraries == *"$build"* ]]; then
  echo "plugin_project.sh: the installed program uses libraries of the build folder" >&2
  exit 1
fi
# Where these are missing, the program takes those of the source tree, if that is still there.
for file in planner_template/cpp/planner.cpp routebench_plots/__main__.py \
    routebench_report/__main__.py routebench_report/web/viewer.js; do
  if [ ! -f "$work/moved/share/routebench/$file" ]; then
    echo "plugin_project.sh: $file is not installed" >&2
    exit 1
  fi
done

start=$SECONDS
"$program" new-planner my_rings "$work/my_rings"
cd "$work/my_rings"
compile_start=$SECONDS
cmake -B build -DCMAKE_PREFIX_PATH="$work/moved" >/dev/null
cmake --build build >/dev/null
compile=$((SECONDS - compile_start))
(cd build && ctest --output-on-failure >/dev/null)
"$program" check-planner my_rings --plugin build/my_rings.so
"$program" run experiment.toml --out results
"$program" plot results --formats png >plots.txt
grep -q "summary.md" plots.txt
grep -qF "my\_rings" results/plots/summary.md
echo "without compiling: $((SECONDS - start - compile)) s"
