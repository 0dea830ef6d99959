#!/usr/bin/env bash
# Builds Limpid on a Debian of its own, runs all tests there but those in a virtual machine, and
# tries the package on a Debian that has nothing else:
#   tests/distributions/run.sh 12|13 [WHAT CTEST IS TO BE TOLD]
#   tests/distributions/run.sh aarch64    for 64-bit ARM: the tests of core and the shipped sessions
# Needs root, mmdebstrap and the network. What is made stays under LIMPID_DISTRIBUTIONS
# (build/distributions): the next run goes on from it. Packages come from LIMPID_MIRROR.
# Exits with 77 where no root folder can be made.
set -euo pipefail
source=$(realpath "$(dirname "$0")/../..")
release=${1:-}
shift || true
case $release in
  12) suite=bookworm more=(mount) ;;
  13) suite=trixie more=(mount weston) ;;  # windows open on Wayland, too
  aarch64) suite=trixie more=() ;;
  *) sed -n '2,8s/^# //p' "$0"; exit 2 ;;
esac
cannot() { echo "run.sh: $*" >&2; exit 77; }
[ "$(id -u)" = 0 ] || cannot "only root can make a root folder"
command -v mmdebstrap >/dev/null || cannot "sudo apt install mmdebstrap"
unshare --mount --pid --ipc --fork true 2>/dev/null || cannot "nothing can be mounted here"
place=$(realpath -m "${LIMPID_DISTRIBUTIONS:-$source/build/distributions}")
root=$place/$release
mkdir -p "$place" "$source/build"

say() { echo "Debian $release, $(date +%T): $*"; }

if [ ! -f "$root.tar" ]; then
  say "a new root"
  mmdebstrap --quiet --variant=apt --include=ca-certificates "$suite" "$root.part.tar" \
    "${LIMPID_MIRROR:-http://deb.debian.org/debian}"
  mv "$root.part.tar" "$root.tar"
fi
if [ ! -d "$root/mnt/source" ]; then
  mkdir -p "$root"
  tar -x -f "$root.tar" -C "$root"
  cp -L /etc/resolv.conf "$root/etc/resolv.conf"
  mkdir "$root/build" "$root/mnt/source"
fi

# Runs a command there, with the sources, which cannot be written, and a build folder. What it
# starts and mounts ends with it.
inside() {
  ROOT=$root SOURCE=$source COMMAND=$1 unshare --mount --pid --ipc --fork --kill-child bash -euc '
    for each in dev sys; do mount --rbind /$each "$ROOT/$each"; done
    mount -t proc proc "$ROOT/proc"
    mount -t tmpfs -o mode=1777 tmp "$ROOT/dev/shm"
    mount --bind "$SOURCE" "$ROOT/mnt/source"
    mount -o remount,bind,ro "$ROOT/mnt/source"
    mount --bind "$ROOT/build" "$ROOT/mnt/source/build"
    exec env -i HOME=/root LANG=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin TERM=dumb \
      chroot "$ROOT" bash -euo pipefail -c "cd /mnt/source; $COMMAND"'
}

if [ "$release" = aarch64 ]; then
  say "packages"
  # The libraries that .ci/install names, for the other processor where they depend on it.
  inside 'dpkg --add-architecture arm64
    apt-get update -qq
    libraries=()
    for each in $(sed -n "/^needed=(/,/^)/p" .ci/install | grep -oE "\b(lib[a-z0-9+-]+|nlohmann-json3-dev)\b"); do
      [ "$(apt-cache show "$each" | sed -n "s/^Architecture: //p;T;q")" = all ] || each+=:arm64
      libraries+=("$each")
    done
    DEBIAN_FRONTEND=noninteractive apt-get install -qq -y --no-install-recommends crossbuild-essential-arm64 \
      qemu-user cmake ninja-build pkgconf ccache git python3-h5py "${libraries[@]}" >/dev/null
    git config --global --replace-all safe.directory "*"'
  say "build"
  inside 'cmake --preset release --toolchain tests/distributions/aarch64.cmake >/dev/null
    .ci/build core_tests limpid'
  say "tests of core"
  # qemu knows no seccomp.
  inside 'qemu-aarch64 build/release/tests/core_tests --gtest_brief=1 --gtest_filter=-Sandbox*'
  say "shipped sessions"
  inside 'PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 tests/distributions/sessions_again.py \
    --bodies-may-differ qemu-aarch64 build/release/app/limpid'
  exit
fi

say "packages"
inside ".ci/install --tests
  for each in ${more[*]}; do
    command -v \$each >/dev/null || apt-get install -qq -y --no-install-recommends \$each >/dev/null
  done
  git config --global --replace-all safe.directory '*'"
say "build"
inside 'cmake --preset release -DCMAKE_COMPILE_WARNING_AS_ERROR=ON >/dev/null; .ci/build all'
say "tests"
failed=0
inside "ctest --preset release -j $(nproc) --exclude-regex ^vm_ ${*@Q}" || failed=1
say "package"
inside 'cd build/release; rm -f limpid[-_]*.deb; cpack >/dev/null'
CLEAN_ROOT_TAR=$root.tar "$source/tests/shipped/clean_root.sh" "$root"/build/release/limpid[-_]*.deb || failed=1
[ "$failed" = 1 ] || say "all is well"
exit "$failed"
