#!/usr/bin/env bash
# pictures.sh: draws the pictures of planners/README.md, one layer of a gear by each planner, examples
# included.
set -euo pipefail
cd "$(dirname "$0")/.."

program=${ROUTEBENCH_PROGRAM:-build/release/bin/routebench}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p planners/pictures
draw() {
  local name=$1
  shift
  "$program" plan "shape:gear?teeth=14&bore=6" --layers 20 --task density=0.25 --svg "$work/$name" \
    --shell greedy_shell "$@" >/dev/null || [ $? -eq 1 ]
  mv "$work/$name"/layer_0020.svg "planners/pictures/$name.svg"
}
draw greedy_shell
for fill in rectilinear concentric eulerian voxel; do draw "$fill" --fill "$fill"; done
# The examples are plugins, which the tests build.
plugins=${ROUTEBENCH_PLUGINS_FOLDER:-build/release/tests/planners/plugins}
draw boustrophedon --fill boustrophedon --plugin "$plugins/boustrophedon.so"
# So dense that there are spirals to be seen.
draw fermat_spirals --fill fermat_spirals --plugin "$plugins/fermat_spirals.so" --task density=0.5
