#!/bin/sh
# What the archive runs in the folder that it was unpacked into: copies itself to FOLDER.
# usage: sh rubble-VERSION-MACHINE.run [-- FOLDER]     FOLDER: ~/rubble unless told; must not exist
set -eu
target=${1:-${HOME:?}/rubble}
if [ -e "$target" ]; then
  echo "$target is there already: remove it, or choose another folder: sh ARCHIVE -- FOLDER" >&2
  exit 1
fi
mkdir -p "$target"
cp -R bin lib libexec share "$target"
if ! said=$("$target/bin/rubble" --version 2>&1); then
  echo "$said" >&2
  echo "the program does not start here: it needs the GNU C library 2.36 or newer" >&2
  exit 1
fi
echo "$said is in $target"
echo "try: $target/bin/rubble run $target/share/rubble/scripts/first_pile.lua --out first_pile"
