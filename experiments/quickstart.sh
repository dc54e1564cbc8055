#!/usr/bin/env bash
# From a bare Debian 12 machine to a scored comparison of planners with plots: installs packages,
# builds, runs experiments/quickstart.toml, draws its plots and writes its report. A second call takes
# up where the first ended.
set -euo pipefail
cd "$(dirname "$0")/.."

experiments/build.sh release routebench_program
program=build/release/bin/routebench

echo "quickstart: running experiments/quickstart.toml"
status=0
"$program" run experiments/quickstart.toml || status=$?
# 1 says that some cells are not valid; they are shown in the plots like all others.
if [ "$status" -gt 1 ]; then
  echo "quickstart.sh: the run failed (exit code $status); its message stands above" >&2
  exit "$status"
fi

echo "quickstart: drawing plots"
"$program" plot results/quickstart
echo "quickstart: writing the report"
"$program" report results/quickstart
echo "quickstart: done. Results in results/quickstart/results.sqlite, plots in results/quickstart/plots;"
echo "quickstart: open results/quickstart/report.html in a browser to look at all of it"
exit "$status"
