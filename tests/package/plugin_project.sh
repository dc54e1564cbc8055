#!/usr/bin/env bash
# plugin_project.sh BUILD_DIR SOURCE_DIR: what an author of a plugin does with nothing but the installed
# package: the commands of planners/README.md, from new-planner to plot. Prints how long each of them
# and all but the compiler took. Then builds and checks the example planners.
set -euo pipefail

build=$1
source=$2
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
    routebench_gate/__main__.py routebench_report/__main__.py routebench_report/web/viewer.js; do
  if [ ! -f "$work/moved/share/routebench/$file" ]; then
    echo "plugin_project.sh: $file is not installed" >&2
    exit 1
  fi
done

PYTHONPATH=$work/moved/lib/python3.11/dist-packages /usr/bin/python3 -B -c "import routebench
if not routebench.__file__.startswith('$work/moved/'):
    raise SystemExit('plugin_project.sh: not the installed module: ' + routebench.__file__)
routebench.plan(routebench.slice_model('shape:box'), 'greedy_shell')"
"$program" new-planner my_python "$work/my_python" --python
"$program" plan shape:box --fill my_python --plugin "$work/my_python/my_python.py" \
  --task perimeters=0 --task density=1 >/dev/null

# What a package lacks is named, and costs nothing but the calls that want it.
printf 'PK\3\4' >"$work/part.3mf"
without() {  # LIBRARY CODE WHAT COMMAND...: a call without that library
  local library=$1 expected=$2 what=$3 code complaint
  shift 3
  mkdir "$work/$library"
  find "$work/moved" -name "libroutebench_$library.so*" -exec mv {} "$work/$library" \;
  complaint=$("$program" "$@" 2>&1 >/dev/null) && code=0 || code=$?
  mv "$work/$library"/* "$(dirname "$(find "$work/moved" -name 'libroutebench_geometry.so')")"
  if [ "$code" != "$expected" ] || [[ $complaint != *"$what cannot be loaded: "*"$library"* ]]; then
    echo "plugin_project.sh: without $what: exit code $code, $complaint" >&2
    exit 1
  fi
}
without 3mf 3 "the reader of 3MF files" slice "$work/part.3mf"
without experiments 3 "the library of commands on experiments" run nothing.toml
by_skeleton=(plan shape:box --fill concentric --set fill.method=skeleton --task perimeters=0)
without skeleton 1 "CGAL's straight skeleton" "${by_skeleton[@]}"
"$program" "${by_skeleton[@]}" --task density=1 >/dev/null

# The page's first block of commands, one a line.
mapfile -t commands < <(sed -n '/^```sh$/,/^```$/{/^```/!p;/^```$/q}' "$source/planners/README.md")
if [ "${#commands[@]}" -lt 6 ]; then
  echo "plugin_project.sh: planners/README.md has no commands to run" >&2
  exit 1
fi
cp -r "$work/moved/share/routebench/example_planners" "$work/examples"
cd "$work"
export PATH="$work/moved/bin:$PATH" CMAKE_PREFIX_PATH="$work/moved"
unset ROUTEBENCH_PLUGIN_PATH
export XDG_DATA_HOME="$work/data"

now() { date +%s%N; }
seconds() { awk "BEGIN { printf \"%.1f\", $1 / 1e9 }"; }
total=0
for command in "${commands[@]}"; do
  begin=$(now)
  eval "$command" >"$work/output.txt" || { cat "$work/output.txt"; exit 1; }
  took=$(($(now) - begin))
  echo "$(seconds $took) s  $command"
  [[ $command == cmake* ]] || total=$((total + took))
done
echo "without compiling: $(seconds $total) s"
grep -qF "my\_rings" results/plots/summary.md

# A plugin in the user's own folder is found without being named.
mkdir -p "$XDG_DATA_HOME/routebench/plugins"
cp build/my_rings.so "$XDG_DATA_HOME/routebench/plugins/"
routebench planners my_rings >/dev/null

cd "$work/examples"
cmake -B build >/dev/null
cmake --build build >/dev/null
(cd build && ctest --output-on-failure >/dev/null)
routebench run compare.toml --out results
