#!/usr/bin/env bash
# clean_machine.sh PACKAGE.deb: what a newcomer does on a bare Debian 12 with the package alone: install
# it, write a planner, build it, check it, compare it and plot. Needs root and debootstrap, and fetches
# some hundred packages from the mirror that apt uses here. No test of ctest; run it before a release.
#
#   cmake --build --preset release --target package
#   sudo tests/package/clean_machine.sh build/release/routebench_*.deb
#
# CHROOT=DIR keeps the bare system there (and takes it from there, if it is there already).
set -euo pipefail

package=$(realpath "$1")
[ "$(id -u)" = 0 ] || { echo "clean_machine.sh: must be run as root" >&2; exit 2; }
command -v debootstrap >/dev/null || { echo "clean_machine.sh: needs debootstrap" >&2; exit 2; }

mirror=$(apt-get indextargets --format '$(REPO_URI)' | awk '/\/debian\/?$/ && !n++')
work=$(mktemp -d)
bare=${CHROOT:-$work/bare}
machine=$work/machine
trap 'umount "$machine/proc" 2>/dev/null || true; rm -rf --one-file-system "$work"' EXIT

if [ ! -d "$bare/etc" ]; then
  debootstrap --variant=minbase bookworm "$bare" "$mirror" >"$work/debootstrap.log" ||
    { tail -n 5 "$work/debootstrap.log" >&2; exit 1; }
fi
cp -a "$bare" "$machine"
cp "$package" "$machine/tmp/routebench.deb"
cp /etc/resolv.conf "$machine/etc/resolv.conf"
mount -t proc proc "$machine/proc"
inside() { env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 HOME=/root chroot "$machine" "$@"; }

start=$SECONDS
inside apt-get update -qq
inside env DEBIAN_FRONTEND=noninteractive apt-get install -qq -y /tmp/routebench.deb >"$work/apt.log" 2>&1 ||
  { tail -n 20 "$work/apt.log" >&2; exit 1; }
echo "installed in $((SECONDS - start)) s"
inside useradd --create-home --shell /bin/bash newcomer
as_newcomer() {
  local begin=$SECONDS
  inside su - newcomer -c "$1"
  echo "[$((SECONDS - begin)) s] $1"
}
start=$SECONDS
as_newcomer "routebench new-planner my_rings my_rings"
compile_start=$SECONDS
as_newcomer "cd my_rings && cmake -B build >/dev/null && cmake --build build"
compile=$((SECONDS - compile_start))
as_newcomer "cd my_rings && routebench check-planner my_rings --plugin build/my_rings.so"
as_newcomer "cd my_rings && routebench run experiment.toml --out results"
as_newcomer "cd my_rings && routebench plot results"
inside grep -qF 'my\_rings' /home/newcomer/my_rings/results/plots/summary.md
echo "without installing and compiling: $((SECONDS - start - compile)) s"
