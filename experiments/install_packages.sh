#!/usr/bin/env bash
# install_packages.sh [PACKAGE...]: installs these Debian 12 packages; without any, all that
# routebench is built from, run with and tested with. Does nothing, at once, where all are there.
# Needs root or sudo only if one is missing.
set -euo pipefail

packages=(
  # build
  cmake g++ make ninja-build pkg-config git
  # geometry and planners
  libboost-dev libcgal-dev libeigen3-dev liblemon-dev libmd-dev libpolyclipping-dev libpugixml-dev libzip-dev
  zlib1g-dev
  # harness
  libcli11-dev libsqlite3-dev libtomlplusplus-dev nlohmann-json3-dev
  # tests and benchmarks
  libbenchmark-dev libgtest-dev
  # plots and reports
  python3 python3-matplotlib python3-numpy libjs-three
  # the Python module
  pybind11-dev python3-dev python3-pandas
  # tests of the report in a browser
  chromium chromium-driver
  # the meshes behind cgal: models
  libcgal-demo
)
[ $# -eq 0 ] || packages=("$@")

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$status" = installed ] || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then
  echo "packages: all ${#packages[@]} are installed"
  exit 0
fi

if ! command -v apt-get >/dev/null; then
  echo "install_packages.sh: no apt-get here; install these by hand: ${missing[*]}" >&2
  exit 2
fi
as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "install_packages.sh: run as root, or install sudo; missing: ${missing[*]}" >&2
    exit 2
  fi
  as_root=(sudo)
fi

log=$(mktemp)
trap 'rm -f "$log"' EXIT
echo "packages: installing ${missing[*]}"
apt_get() {
  if ! "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q "$@" >"$log" 2>&1; then
    tail -n 20 "$log" >&2
    echo "install_packages.sh: apt-get $1 failed; its last words stand above" >&2
    exit 2
  fi
}
apt_get update
apt_get install -y --no-install-recommends "${missing[@]}"
echo "packages: done"
