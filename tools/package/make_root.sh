#!/bin/sh
# Makes an empty Debian or Ubuntu in a folder, by debootstrap; with a package, installs that there.
# Needs root, debootstrap and an archive.
# usage: tools/package/make_root.sh ROOT [PACKAGE.deb [SUITE]]
#   ROOT: made, and used again when it is there
#   SUITE: bookworm unless told; of Ubuntu set MIRROR, too
# Environment: MIRROR (http://deb.debian.org/debian)
set -eu
root=$1
package=${2:-}
suite=${3:-bookworm}
mirror=${MIRROR:-http://deb.debian.org/debian}
mkdir -p "$root"

if [ ! -e "$root/installed" ]; then
  # An interrupted debootstrap leaves its own folder.
  [ ! -e "$root/debootstrap" ] || rm -rf "$root"
  # Suites that this debootstrap does not know yet are made as their elders are.
  script=/usr/share/debootstrap/scripts/$suite
  if [ ! -e "$script" ]; then
    case $mirror in *ubuntu*) script=/usr/share/debootstrap/scripts/gutsy ;; *) script=/usr/share/debootstrap/scripts/sid ;; esac
  fi
  if ! debootstrap --variant=minbase "$suite" "$root" "$mirror" "$script" >"$root.log" 2>&1; then
    tail -5 "$root.log" >&2
    exit 1
  fi
  touch "$root/installed"
fi
[ -n "$package" ] || exit 0
cp "$package" "$root/tmp/rubble.deb"
in_root() {
  env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/tmp DEBIAN_FRONTEND=noninteractive chroot "$root" "$@"
}
in_root apt-get -q update >>"$root.log" 2>&1
if ! in_root apt-get -q -y --no-install-recommends install --reinstall /tmp/rubble.deb >>"$root.log" 2>&1; then
  tail -5 "$root.log" >&2
  exit 1
fi
rm "$root/tmp/rubble.deb"
