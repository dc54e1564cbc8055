#!/usr/bin/env bash
# Builds and runs every test, on a bare Debian 12 machine too. tests/run.sh [PRESET], default release.
set -euo pipefail
cd "$(dirname "$0")/.."

preset=${1:-release}
experiments/build.sh "$preset"
echo "tests: running"
# In parallel, but one test a core: they start children of their own.
if ! ctest --preset "$preset" --parallel "$(nproc)"; then
  echo "tests/run.sh: some tests failed; they are named above" >&2
  exit 1
fi
