#!/bin/sh
# Makes a self-extracting archive for distributions other than Debian 12: the program with every library
# that it loads, Mesa's llvmpipe among them, but for the C library. It runs where that is as new as the
# one of this machine, or newer. Needs makeself and a built program (make build).
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
cp -L "$libraries/libEGL.so.1" "$libraries/libEGL_mesa.so.0" "$stage/lib"
cp -L "$libraries/dri/swrast_dri.so" "$stage/lib/dri"
cp /usr/share/glvnd/egl_vendor.d/50_mesa.json "$stage/share/glvnd"

# ldd lists what these want, and what that wants in turn.
ldd "$stage/libexec/rubble" "$stage"/lib/*.so* "$stage"/lib/dri/*.so | sed -n 's/.* => \(\/[^ ]*\) .*/\1/p' | sort -u |
  grep -v -E '/(ld-linux.*|lib(c|m|pthread|dl|rt|resolv|util)\.so\.[0-9]+)$' |
  while read -r library; do cp -L -n "$library" "$stage/lib"; done
chmod 644 "$stage"/lib/*.so* "$stage"/lib/dri/*.so
# Their licences: each library's package has them.
mkdir -p "$stage/share/doc/licences"
for library in "$stage"/lib/*.so*; do
  package=$(dpkg -S "*/$(basename "$library")" 2>/dev/null | sed -n '1s/:.*//p')
  [ -z "$package" ] || cp -L -n "/usr/share/doc/$package/copyright" "$stage/share/doc/licences/$package" 2>/dev/null || true
done

cp "$here/archive_start.sh" "$stage/bin/rubble"
cp "$here/archive_install.sh" "$stage/install.sh"
chmod 755 "$stage/bin/rubble" "$stage/install.sh"
makeself --quiet --nox11 --tar-quietly "$stage" "$output/$name.run" "Rubble $version" ./install.sh
rm -rf "$stage"
echo "$output/$name.run: $(du -m "$output/$name.run" | cut -f1) MB"
