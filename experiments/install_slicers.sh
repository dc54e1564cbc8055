#!/usr/bin/env bash
# Installs the slicers of Debian 12 that experiments can compare with: PrusaSlicer, Slic3r and
# CuraEngine. CuraEngine needs the setting definitions of the package cura, which would bring a whole
# desktop program along, so that package is only unpacked, into the user's cache folder. Does
# nothing, at once, where all is there.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)

"$here/install_packages.sh" prusa-slicer slic3r cura-engine

definitions=usr/share/cura/resources/definitions/fdmprinter.def.json
cache=${XDG_CACHE_HOME:-$HOME/.cache}/routebench/cura
if [ -e "/$definitions" ] || [ -e "$cache/$definitions" ]; then
  echo "cura: the definitions are there"
  exit 0
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
# As root, apt would download as a user of its own, who must be let in.
chmod 755 "$folder"
if ! apt-get -q download cura >log 2>&1; then
  tail -n 20 log >&2
  echo "install_slicers.sh: apt-get download cura failed; its last words stand above" >&2
  exit 2
fi
mkdir unpacked
dpkg -x cura_*.deb unpacked
# Only what the engine reads; put in its place when it is whole.
resources=usr/share/cura/resources
mkdir -p "$cache.new/$resources"
cp -r "unpacked/$resources/definitions" "unpacked/$resources/extruders" "$cache.new/$resources/"
rm -rf "$cache"
mv "$cache.new" "$cache"
echo "cura: the definitions are in $cache"
