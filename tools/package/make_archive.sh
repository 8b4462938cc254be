#!/bin/sh
# Makes a self-extracting archive for other distributions than this one: the program with every library
# that it loads, Mesa's llvmpipe among them, but for the C library. It runs where that is as new as the
# one of this machine, or newer. Needs a built program (make build).
# usage: tools/package/make_archive.sh BUILD_FOLDER OUTPUT_FOLDER
set -eu
build=$1
output=$2
here=$(cd "$(dirname "$0")" && pwd)
version=$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' "$build/CMakeCache.txt")
name=rubble-$version-$(uname -m)
stage=$output/$name
rm -rf "$stage"
mkdir -p "$output"
cmake --install "$build" --component program --strip --prefix "$stage" >"$output/$name.log"
mkdir -p "$stage/lib/dri" "$stage/libexec" "$stage/share/glvnd"
mv "$stage/bin/rubble" "$stage/libexec/rubble"  # finds ../share/rubble as it did from bin

# What is opened at run time and no linker knows of.
libraries=/usr/lib/$(uname -m)-linux-gnu
list=$output/$name.libraries
printf '%s\n' "$libraries/libEGL.so.1" "$libraries/libEGL_mesa.so.0" "$libraries/libSDL2-2.0.so.0" "$libraries/dri/swrast_dri.so" >"$list.opened"
cp /usr/share/glvnd/egl_vendor.d/50_mesa.json "$stage/share/glvnd"

# ldd lists what these want, and what that wants in turn.
# shellcheck disable=SC2046  # a word each
ldd "$stage/libexec/rubble" $(cat "$list.opened") | sed -n 's/.* => \(\/[^ ]*\) .*/\1/p' |
  grep -v -E '/(ld-linux.*|lib(c|m|pthread|dl|rt|resolv|util)\.so\.[0-9]+)$' | sort -u - "$list.opened" >"$list"
while read -r library; do
  case $library in */dri/*) cp -L "$library" "$stage/lib/dri" ;; *) cp -L -n "$library" "$stage/lib" ;; esac
done <"$list"
chmod 644 "$stage"/lib/*.so* "$stage"/lib/dri/*.so
# Their licences, from the packages that they are of; the list names /lib where dpkg may say /usr/lib.
mkdir -p "$stage/share/doc/licences"
sed 's#^/usr##; p; s#^#/usr#' "$list" | xargs dpkg -S 2>/dev/null | sed 's/[:,].*//' | sort -u |
  while read -r package; do
    [ ! -e "/usr/share/doc/$package/copyright" ] || cp -L "/usr/share/doc/$package/copyright" "$stage/share/doc/licences/$package"
  done
rm "$list" "$list.opened"

cp "$here/archive_start.sh" "$stage/bin/rubble"
chmod 755 "$stage/bin/rubble"
"$here/self_extracting.sh" "$stage" "$version" "$output/$name.run"
rm -rf "$stage"
echo "$output/$name.run: $(du -m "$output/$name.run" | cut -f1) MB"
