#!/usr/bin/env bash
# speed.sh [OPTIONS]: measures the whole job beside the slicers that are installed and renews
# results/reference/speed. Takes what speed_report.py takes, such as --only armadillo,bunny
# --repetitions 1. ROUTEBENCH_MODELS names the folder of models (one with a MANIFEST.csv),
# ROUTEBENCH_BEFORE an older build of the program for instruction counts before and after.
set -euo pipefail
cd "$(dirname "$0")/.."

models=${ROUTEBENCH_MODELS:-../shared/models}
[ -e "$models/MANIFEST.csv" ] || {
  echo "speed.sh: $models: no MANIFEST.csv there; set ROUTEBENCH_MODELS to a folder of models" >&2
  exit 2
}
experiments/build.sh release routebench_program
experiments/build.sh bench routebench_bench
before=()
[ -z "${ROUTEBENCH_BEFORE:-}" ] || before=(--before "$ROUTEBENCH_BEFORE")
exec /usr/bin/python3 experiments/speed_report.py build/release/bin/routebench \
  --models "$models" --out results/reference/speed --bench build/bench/bin/routebench-bench \
  "${before[@]}" "$@"
