#!/usr/bin/env bash
# build.sh PRESET [TARGET...]: installs what is missing, configures and builds (everything, or the
# named targets). Leaves the program in build/PRESET/bin/. Quick when there is nothing to do.
set -euo pipefail
cd "$(dirname "$0")/.."

preset=${1:?usage: build.sh PRESET [TARGET...]}
shift
experiments/install_packages.sh

log=$(mktemp)
trap 'rm -f "$log"' EXIT
run_step() {
  local what=$1
  shift
  if ! "$@" >"$log" 2>&1; then
    tail -n 40 "$log" >&2
    echo "build.sh: $what failed; its last words stand above" >&2
    exit 2
  fi
}

echo "build: configuring preset '$preset'"
run_step "cmake --preset $preset" cmake --preset "$preset"
echo "build: compiling into build/$preset (several minutes the first time)"
targets=()
[ $# -eq 0 ] || targets=(--target "$@")
run_step "cmake --build --preset $preset" cmake --build --preset "$preset" "${targets[@]}"
