#!/bin/sh
# Installs a Debian package into an empty Debian and makes a dataset there, without a network and
# without this checkout: what a user of a bare machine does. Takes minutes; needs root, debootstrap and
# the archive that this machine installs from.
# usage: tools/package/test_package.sh PACKAGE.deb FOLDER [MISSION]
#   FOLDER: for the root of that Debian; made, and used again when it is there (removing it is yours)
#   MISSION: below /usr/share/rubble/scripts; default first_pile.lua
set -eu
here=$(dirname "$0")
root=$2/root
mission=${3:-first_pile.lua}
start=$(date +%s)
"$here/make_root.sh" "$root" "$1"
echo "the package was downloaded and installed in $(($(date +%s) - start)) s"
rm -rf "$root/tmp/out"
start=$(date +%s)
"$here/run_in_root.sh" "$root" "cd /tmp && rubble --version &&
  rubble run /usr/share/rubble/scripts/$mission --out /tmp/out --quiet && rubble info /tmp/out"
echo "the dataset took $(($(date +%s) - start)) s; the root has $(du -sm "$root" | cut -f1) MB"
