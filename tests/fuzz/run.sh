#!/usr/bin/env bash
# Fuzzes the readers of G-code, STL and configs, each for so many seconds, with one job.
# tests/fuzz/run.sh SECONDS [KIND...], kinds gcode, stl, config. What fails is kept in build/fuzz/found
# and makes the exit code 1. Needs the Debian packages clang and libclang-rt-14-dev.
set -euo pipefail
cd "$(dirname "$0")/../.."

seconds=${1:?usage: tests/fuzz/run.sh SECONDS [gcode|stl|config]...}
shift
kinds=("$@")
[ $# -gt 0 ] || kinds=(gcode stl config)
if ! command -v clang++ >/dev/null; then
  echo "tests/fuzz/run.sh: there is no clang++; install clang and libclang-rt-14-dev" >&2
  exit 2
fi

cmake --preset fuzz >/dev/null
cmake --build --preset fuzz --target "${kinds[@]/#/fuzz_}"
failed=0
for kind in "${kinds[@]}"; do
  mkdir -p "build/fuzz/corpus/$kind" build/fuzz/found
  echo "fuzz: $kind for $seconds s"
  "build/fuzz/bin/fuzz_$kind" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 \
    -max_len=8192 -print_final_stats=1 -verbosity=0 -artifact_prefix="build/fuzz/found/$kind-" \
    "build/fuzz/corpus/$kind" "tests/fuzz/seeds/$kind" || failed=1
done
exit "$failed"
