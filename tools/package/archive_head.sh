#!/bin/sh
# Rubble @VERSION@ with the libraries that it loads; what follows this script is a tar file, compressed by gzip.
# @LINES@ lines of it are this script.
set -eu
version=@VERSION@
usage() {
  cat <<END
Installs Rubble $version, which simulates collapsed structures, from this file.
usage: sh $0 [FOLDER]
  FOLDER    where to; default: ${HOME:-\$HOME}/rubble-$version. It is made; in a folder that is there
            already, rubble-$version is made.
  --list    names the files in this archive and installs nothing
  --help    prints this

Then: FOLDER/bin/rubble --help. Nothing outside FOLDER is changed: to uninstall, remove it.
It needs the GNU C library @GLIBC@ or newer, tar and gzip.
END
}
payload() { tail -n +"$((@LINES@ + 1))" "$0"; }
fail() {
  echo "$*" >&2
  exit 1
}

case "${1:-}" in
  --help | -h) usage; exit 0 ;;
  --list) payload | tar -tzf -; exit 0 ;;
  --) shift ;;
  -*) echo "expected FOLDER, --list or --help, found: $1" >&2; usage >&2; exit 2 ;;
esac
[ $# -le 1 ] || { echo "expected one FOLDER, found: $*" >&2; exit 2; }
target=${1:-${HOME:?names no folder: give one}/rubble-$version}
is_installation() { [ -e "$1/libexec/rubble" ]; }
if [ -d "$target" ] && ! is_installation "$target"; then target=$target/rubble-$version; fi
if is_installation "$target"; then
  fail "Rubble is in $target already: remove that, or give another folder: sh $0 FOLDER"
elif [ -e "$target" ]; then
  fail "$target is there already: remove that, or give another folder: sh $0 FOLDER"
fi

# Beside its place first: what was interrupted is not taken for an installation.
mkdir -p "$(dirname "$target")"
part=$target.part
[ ! -e "$part" ] || fail "$part is there, of an installation that runs or was interrupted: remove it first"
trap 'rm -rf "$part"' EXIT
trap 'exit 1' HUP INT TERM
mkdir "$part"
payload | tar -xzf - -C "$part" ||
  fail "cannot unpack $0 to $part: the archive is damaged or cut off, or the disk is full"
said=$("$part/bin/rubble" --version 2>&1) ||
  fail "$said
the program does not start here: it needs the GNU C library @GLIBC@ or newer"
mv "$part" "$target"
echo "$said is in $target"
echo "try: $target/bin/rubble run $target/share/rubble/scripts/first_pile.lua --out first_pile"
exit 0
