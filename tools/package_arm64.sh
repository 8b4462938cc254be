#!/bin/sh
# Cross-compiles the program for arm64 against Debian's arm64 packages and packs it; then unpacks the package with what
# it depends on, and nothing else, and runs it there under QEMU: a mission to its end, verified.
# usage: tools/package_arm64.sh [--build FOLDER] [MISSION]     (from the root, after `make build`)
#   FOLDER: default build/arm64, of which FOLDER/try/out is the dataset
#   MISSION: that is tried; default examples/arm64.lua
# Leaves build/package/rubble_VERSION_arm64.deb. Packages: tools/packages-arm64.txt. Exit status: 0 packed and tried;
# 1 it does not build, or gives another pile than this machine; 2 bad usage.
set -eu
cd "$(dirname "$0")/.."
folder=build/arm64
if [ "${1:-}" = --build ]; then
  folder=${2:?--build wants a folder}
  shift 2
fi
[ $# -le 1 ] || { sed -n '4p' "$0" >&2; exit 2; }
mission=${1:-examples/arm64.lua}
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
here=$PWD/build/release

# What the program links, without the tools that build it, which are of this machine.
libraries=$(sed '/^# Only/,$d' packages.txt | awk '/^[a-z]/ && $1 !~ /^(g[+][+]|cmake|ninja-build|pkg-config)$/ { print $1 }')
# shellcheck disable=SC2086  # the names are words on purpose
tools/arm64_sysroot.sh "$folder/sysroot" $libraries
root=$folder/sysroot/root

configure() {
  PKG_CONFIG_LIBDIR=$root/usr/lib/aarch64-linux-gnu/pkgconfig:$root/usr/share/pkgconfig PKG_CONFIG_SYSROOT_DIR=$root \
    cmake -S . -B "$folder/program" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE=-O2 \
    -DCMAKE_TOOLCHAIN_FILE="$PWD/cmake/Arm64Toolchain.cmake" -DRUBBLE_ARM64_ROOT="$root" -DBUILD_TESTING=OFF \
    -DRUBBLE_ASSET_MAKER="$here/rubble_make_assets" "-DCMAKE_CROSSCOMPILING_EMULATOR=qemu-aarch64;-L;$root" "$@"
}
configure
cmake --build "$folder/program" --target program
configure -DRUBBLE_PACKAGE_DEPENDS="$(tools/package/library_depends.py "$folder/program/rubble" \
  "$folder"/sysroot/apt/cache/archives/*.deb)"
cmake --build "$folder/program" --target program
cpack --config "$folder/program/CPackConfig.cmake" -B build/package
version=$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' "$folder/program/CMakeCache.txt")
package=$PWD/build/package/rubble_${version}_arm64.deb

tools/arm64_sysroot.sh "$folder/try" "$package"
try=$folder/try/root
there="qemu-aarch64 -L $try $try/usr/bin/rubble"
rm -rf "$folder/try/out" "$folder/try/here"
RUBBLE_CACHE=off $there run "$mission" --out "$folder/try/out" --quiet
RUBBLE_CACHE=off $there verify "$folder/try/out"
RUBBLE_CACHE=off "$here/rubble" settle "$mission" --out "$folder/try/here" --quiet
hash_of() { sed -n 's/.*"state_hash": "\([0-9a-f]*\)".*/\1/p' "$1/manifest.json" | head -1; }
if [ "$(hash_of "$folder/try/out")" != "$(hash_of "$folder/try/here")" ]; then
  echo "package_arm64: the pile is not that of this machine" >&2
  exit 1
fi
echo "$package: tried; the pile's hash is $(hash_of "$folder/try/out"), as on this machine"
