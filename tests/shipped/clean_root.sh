#!/usr/bin/env bash
# Installs the program's packages into a Debian 12 of its own, starts it as the menu does, and removes them:
#   tests/shipped/clean_root.sh limpid_VERSION_amd64.deb limpid-common_VERSION_amd64.deb
# Into another Debian with CLEAN_ROOT_TAR, the archive of a root that has apt.
# Needs root, mmdebstrap, Xvfb, xdotool and the network; takes some minutes.
set -euo pipefail
debs=("$@")
place=$(mktemp -d /var/tmp/limpid-root-XXXXXX)
root=$place/root
screen=
finish() {
  [ -z "$screen" ] || kill "$screen" 2>/dev/null || true
  umount "$root/tmp/.X11-unix" "$root/proc" 2>/dev/null || true
  rm -rf --one-file-system "$place"
}
trap finish EXIT

say() { echo "clean root: $*"; }
# grep reads to the end: who is left alone by it has failed, for pipefail.
fail() { say "FAILED: $*" >&2; exit 1; }
# Without anything of this computer's environment.
alone=(env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8)
inside() { "${alone[@]}" chroot "$root" "$@"; }
quiet_apt() { DEBIAN_FRONTEND=noninteractive inside apt-get -qq -o Dpkg::Use-Pty=0 "$@" >"$place/apt.log" 2>&1 || { cat "$place/apt.log"; fail "apt-get $*"; }; }
# What there is, but for what any package leaves behind.
files() { (cd "$root" && find . -path ./proc -prune -o -path ./tmp -prune -o -path ./var/cache -prune -o -path ./var/log -prune -o -path ./var/lib/apt -prune -o -path ./var/lib/dpkg -prune -o -print | sort); }

say "a minimal Debian"
if [ -n "${CLEAN_ROOT_TAR:-}" ]; then
  mkdir "$root" && tar -C "$root" -xf "$CLEAN_ROOT_TAR"
else
  mmdebstrap --quiet --variant=apt bookworm "$root" http://deb.debian.org/debian
fi
mount -t proc proc "$root/proc"
printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d"  # no services in here
chmod +x "$root/usr/sbin/policy-rc.d"
quiet_apt update

# All that it needs comes first, so that what is left over is its own.
say "what it depends on and recommends"
cp -- "${debs[@]}" "$root/tmp/"
packages=("${debs[@]##*/}")
quiet_apt install -y "${packages[@]/#//tmp/}"
quiet_apt install -y desktop-file-utils shared-mime-info libglib2.0-bin man-db
quiet_apt purge -y limpid limpid-common
inside groupmod -g 1500 realtime  # an ordinary group, as people with ROS have it
files >"$place/before"

say "installed"
quiet_apt install -y "${packages[@]/#//tmp/}"
inside limpid --version
inside getent group realtime >/dev/null || fail "no group realtime"
[ -f "$root/etc/security/limits.d/limpid.conf" ] || fail "no limits"
inside man limpid-run | grep -e --record >/dev/null || fail "no manual page"
status=0
inside limpid doctor >"$place/doctor" || status=$?
cat "$place/doctor"
[ "$status" -le 1 ] || fail "doctor says $status"
inside limpid run --duration 0.2 --record /tmp/one.h5 --picture /tmp/one.png >/dev/null
inside limpid play /tmp/one.h5 --video /tmp/one.gif --size 320x180 >/dev/null || fail "no video"
[ "$(inside gio info -a standard::content-type /tmp/one.h5 | sed -n 's/.*content-type: //p')" = \
  application/x-limpid-session ] || fail "a session is not known as one"
inside gio mime application/x-limpid-session | grep limpid.desktop >/dev/null || fail "nothing opens a session"

say "started as the menu does"
command=$(sed -n 's/^Exec=//p' "$root/usr/share/applications/limpid.desktop")
Xvfb -displayfd 3 -screen 0 1280x800x24 -nolisten tcp -ac 3>"$place/display" 2>/dev/null &
screen=$!
for _ in $(seq 100); do [ -s "$place/display" ] && break || sleep 0.1; done
display=:$(cat "$place/display")
mkdir -p "$root/tmp/.X11-unix"
mount --bind /tmp/.X11-unix "$root/tmp/.X11-unix"
for file in "" /tmp/one.h5; do
  # shellcheck disable=SC2086  # the entry's words
  "${alone[@]}" DISPLAY="$display" chroot "$root" ${command/\%f/$file} --print-state >"$place/state" 2>"$place/said" &
  started=$!
  window=$(DISPLAY=$display timeout 60 xdotool search --sync --onlyvisible --name '^Limpid' | head -1) || true
  [ -n "$window" ] || { cat "$place/said"; fail "no window of '$command'"; }
  for _ in $(seq 300); do [ -s "$place/state" ] && break || sleep 0.1; done
  head -c 300 "$place/state"; echo
  kill "$started" 2>/dev/null || true
  wait "$started" || true
done

say "removed"
quiet_apt purge -y limpid limpid-common
rm -rf "$root/root/.config" "$root/root/.local" "$root/root/.cache"
files >"$place/after"
diff "$place/before" "$place/after" || fail "something is left"
say "all is well"
