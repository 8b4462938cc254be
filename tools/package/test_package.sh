#!/bin/sh
# Installs a Debian package into an empty Debian and makes a dataset there, without a network and
# without this checkout: what a user of a bare machine does. Takes minutes; needs root, debootstrap and
# the archive that this machine installs from.
# usage: tools/package/test_package.sh PACKAGE.deb FOLDER [MISSION]
#   FOLDER: for the root of that Debian; made, and used again when it is there (removing it is yours)
#   MISSION: below /usr/share/rubble/scripts; default first_pile.lua
set -eu
package=$1
root=$2/root
mission=${3:-first_pile.lua}
mkdir -p "$2"
suite=bookworm
mirror=${MIRROR:-http://deb.debian.org/debian}

if [ ! -e "$root/installed" ]; then
  debootstrap --variant=minbase "$suite" "$root" "$mirror" >"$2/debootstrap.log"
  touch "$root/installed"
fi
cp "$package" "$root/tmp/rubble.deb"
in_root() { env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/tmp DEBIAN_FRONTEND=noninteractive "$@"; }
in_root chroot "$root" apt-get -q update >"$2/install.log"
in_root chroot "$root" apt-get -q -y --no-install-recommends install /tmp/rubble.deb >>"$2/install.log"
rm -rf "$root/tmp/out"
start=$(date +%s)
# Network off, as nobody: the package needs neither.
make="cd /tmp && rubble --version &&
  rubble run /usr/share/rubble/scripts/$mission --out /tmp/out --quiet && rubble info /tmp/out"
in_root unshare --net --mount --pid --fork /bin/sh -c \
  'mount -t proc proc "$1/proc" && exec chroot --userspec=65534:65534 "$1" /bin/sh -c "$2"' sh "$root" "$make"
echo "the dataset took $(($(date +%s) - start)) s; the root has $(du -sm "$root" | cut -f1) MB"
