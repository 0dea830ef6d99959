#!/usr/bin/env bash
# Builds Limpid on a Debian of its own, runs all tests there but those in a virtual machine, and
# tries the package on a Debian that has nothing else. As root:
#   tests/distributions/run.sh 12|13 [WHAT CTEST IS TO BE TOLD]
# What is made stays under LIMPID_DISTRIBUTIONS (build/distributions): the next run goes on from it.
# Debian's packages come from LIMPID_MIRROR.
set -euo pipefail
source=$(realpath "$(dirname "$0")/../..")
release=${1:-}
shift || true
case $release in
  12) suite=bookworm ;;
  13) suite=trixie ;;
  *) sed -n '2,6s/^# //p' "$0"; exit 2 ;;
esac
[ "$(id -u)" = 0 ] || { echo "run.sh: only root can make a root folder" >&2; exit 1; }
command -v mmdebstrap >/dev/null || { echo "run.sh: sudo apt install mmdebstrap" >&2; exit 1; }
place=$(realpath -m "${LIMPID_DISTRIBUTIONS:-$source/build/distributions}")
root=$place/$release
bare=$place/$release-bare
mkdir -p "$place" "$source/build"

say() { echo "run.sh: Debian $release, $(date +%T): $*"; }

# The archive that all roots of this release start from.
if [ ! -f "$bare.tar" ]; then
  say "a new root"
  mmdebstrap --quiet --variant=apt --include=ca-certificates "$suite" "$bare.part.tar" \
    "${LIMPID_MIRROR:-http://deb.debian.org/debian}"
  mv "$bare.part.tar" "$bare.tar"
fi
unpack() {
  mkdir -p "$1"
  tar -x -f "$bare.tar" -C "$1"
  cp -L /etc/resolv.conf "$1/etc/resolv.conf"
  mkdir -p "$1/limpid" "$1/build"
}
[ -d "$root" ] || unpack "$root"

# inside ROOT COMMAND: with the sources, which cannot be written, and a build folder. What it starts
# and mounts ends with it.
inside() {
  ROOT=$1 SOURCE=$source COMMAND=$2 unshare --mount --pid --ipc --fork --kill-child bash -euc '
    for each in dev sys; do mount --rbind /$each "$ROOT/$each"; done
    mount -t proc proc "$ROOT/proc"
    mount -t tmpfs -o mode=1777 tmp "$ROOT/dev/shm"
    mount --bind "$SOURCE" "$ROOT/limpid"
    mount -o remount,bind,ro "$ROOT/limpid"
    mount --bind "$ROOT/build" "$ROOT/limpid/build"
    exec env -i HOME=/root LANG=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin TERM=dumb \
      chroot "$ROOT" bash -euo pipefail -c "cd /limpid; $COMMAND"'
}

say "packages"
inside "$root" '.ci/install --tests; git config --global --replace-all safe.directory "*"'
say "build"
inside "$root" 'cmake --preset release >/dev/null; cmake --build --preset release'
say "tests"
failed=0
inside "$root" "ctest --preset release -j $(nproc) --exclude-regex ^vm_ ${*@Q}" || failed=$?

say "package"
inside "$root" 'rm -f build/release/*.deb; cd build/release; cpack >/dev/null'
rm -rf "$bare"
unpack "$bare"
cp "$root"/build/release/limpid_*.deb "$bare/build/"
inside "$bare" 'export DEBIAN_FRONTEND=noninteractive; cd /
  apt-get update -qq; apt-get install -qq -y --no-install-recommends /build/limpid_*.deb >/dev/null
  limpid --version; limpid doctor || true
  limpid run --duration 1 --record /tmp/session.h5; limpid info /tmp/session.h5 >/dev/null'
rm -rf "$bare"
[ "$failed" = 0 ] && say "all is well"
exit "$failed"
