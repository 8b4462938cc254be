#!/bin/sh
# Builds Debian's Simbody without fused multiply-adds, which g++ makes by default on arm64: piles
# with joints then have the same bits there as on x86-64. See docs/explanation/determinism.md.
# usage: tools/build_simbody.sh FOLDER [--arm64 SYSROOT]
#   FOLDER/prefix gets the libraries and headers: configure Rubble with -DCMAKE_PREFIX_PATH=FOLDER/prefix
#   --arm64: cross-compiles against what tools/arm64_sysroot.sh put into SYSROOT/root, and puts the
#   libraries there, in the place of Debian's
# Needs dpkg-dev, cmake, ninja-build, liblapack-dev. It takes half an hour on two cores.
set -eu
cd "$(dirname "$0")/.."
here=$PWD

usage() {
  echo "usage: tools/build_simbody.sh FOLDER [--arm64 SYSROOT]" >&2
  exit 2
}
[ $# -eq 1 ] || [ $# -eq 3 ] || usage
folder=$1
sysroot=""
if [ $# -eq 3 ]; then
  [ "$2" = --arm64 ] || usage
  sysroot=$(cd "$3" && pwd)
fi
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)

# Debian's source package, by an apt of its own that knows source lists; no root.
fetch_source() {
  apt=$folder/apt
  mkdir -p "$apt/state/lists/partial" "$apt/cache/archives/partial" "$apt/sources"
  for file in /etc/apt/sources.list.d/*.sources; do
    [ -e "$file" ] || continue
    sed 's/^Types:.*/Types: deb-src/' "$file" >"$apt/sources/$(basename "$file")"
  done
  if [ -s /etc/apt/sources.list ]; then
    sed -n 's/^deb \(.*\)/deb-src \1/p' /etc/apt/sources.list >"$apt/sources/main.list"
  fi
  cat >"$apt/apt.conf" <<END
APT::Sandbox::User "";
Dir::Etc::sourcelist "/dev/null";
Dir::Etc::sourceparts "$apt/sources";
Dir::State "$apt/state";
Dir::State::status "/var/lib/dpkg/status";
Dir::Cache "$apt/cache";
Dir::Log "$apt";
END
  (
    cd "$folder"
    export APT_CONFIG="$apt/apt.conf"
    apt-get update -q || echo "build_simbody: some sources could not be read; going on" >&2
    apt-get source -q simbody
  )
}

if ! ls -d "$folder"/simbody-*/ >/dev/null 2>&1; then fetch_source; fi
source=$(ls -d "$folder"/simbody-*/ | head -1)

# As Debian builds it, without a type: with one, Simbody's CMake file takes flags of its own in the place of these, and
# NDEBUG, with which classes of its headers have other members than in Debian's package.
set -- -DCMAKE_BUILD_TYPE=None "-DCMAKE_CXX_FLAGS=-O2 -ffp-contract=off" \
  "-DCMAKE_C_FLAGS=-O2 -ffp-contract=off" -DBUILD_TESTING=OFF -DBUILD_EXAMPLES=OFF \
  -DBUILD_VISUALIZER=OFF "-DSIMBODY_VISUALIZER_INSTALL_DIR=$folder/prefix/bin" -DINSTALL_DOCS=OFF -DCMAKE_INSTALL_LIBDIR=lib \
  "-DBUILD_USING_OTHER_LAPACK=lapack;blas" "-DCMAKE_INSTALL_PREFIX=$folder/prefix"
if [ -n "$sysroot" ]; then
  set -- "$@" "-DCMAKE_TOOLCHAIN_FILE=$here/cmake/Arm64Toolchain.cmake" \
    "-DRUBBLE_ARM64_ROOT=$sysroot/root"
fi
cmake -S "$source" -B "$folder/build" -G Ninja "$@"
if grep '^  FLAGS = ' "$folder/build/build.ninja" | grep -q -e '-DNDEBUG' ||
  grep '^  FLAGS = ' "$folder/build/build.ninja" | grep -q -v -e '-ffp-contract=off'; then
  echo "build_simbody: Simbody's CMake file changed the flags of the compiler; see FLAGS in $folder/build/build.ninja" >&2
  exit 1
fi
cmake --build "$folder/build"
cmake --install "$folder/build"

if [ -n "$sysroot" ]; then
  libraries=$sysroot/root/usr/lib/aarch64-linux-gnu
  for name in common math simbody; do
    made=$(ls "$folder"/prefix/lib/libSimTK$name.so.3.7 "$folder"/prefix/lib/libSimTK$name.so 2>/dev/null |
      head -1)
    [ -n "$made" ] || { echo "build_simbody: no libSimTK$name was built" >&2; exit 1; }
    cp -L "$made" "$libraries/libSimTK$name.so.3.7"
  done
  touch "$sysroot/root/simbody-without-fma"
fi
echo "build_simbody: done; \`rubble info\` says \`Simbody bits  reference\` with it"
