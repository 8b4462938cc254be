#!/bin/sh
# Tries other platforms. Table: docs/development/platforms.md.
#   debian12, debian13        make demo and make test in a bare root of that release (tools/bare_debian.sh)
#   windows, riscv64, arm64   the kernel and rubble-core, run under emulators: their hashes are compared with
#                             tests/golden/kernel.txt, and their files with those of this machine
# usage: tools/platforms.sh [--build FOLDER] [PLATFORM]...   (all but debian12 unless told)
#   FOLDER: build/platforms unless told; what it holds is used again, the roots, too
# Packages: tools/packages-platforms.txt. Exit status: 0 all equal; 1 something differs, does not build or
# does not run; 2 bad usage.
set -eu
cd "$(dirname "$0")/.."
folder=build/platforms
if [ "${1:-}" = --build ]; then
  folder=${2:?--build wants a folder}
  shift 2
fi
[ $# -gt 0 ] || set -- debian13 windows riscv64 arm64
emulated=""
for platform in "$@"; do
  case $platform in
    windows | riscv64 | arm64) emulated="$emulated $platform" ;;
    debian12 | debian13) ;;
    *) echo "platforms: expected windows, riscv64, arm64, debian12 or debian13, found $platform" >&2; exit 2 ;;
  esac
done
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)

# Without Simbody and OpenSSL, which not every platform has, and linked statically: nothing of that
# platform is needed but its compiler. xxHash is a header.
build() {
  mkdir -p "$folder/include"
  cp /usr/include/xxhash.h "$folder/include"
  name=$1
  shift
  cmake -S . -B "$folder/$name" -G Ninja -DRUBBLE_KERNEL_ONLY=ON -DCMAKE_BUILD_TYPE=Release \
    -DRUBBLE_SIMBODY=OFF -DRUBBLE_OPENSSL=OFF "-DXXHASH_INCLUDE_DIR=$folder/include" "$@" >"$folder/$name.log" 2>&1 &&
    cmake --build "$folder/$name" --target hash_probe rubble-core >>"$folder/$name.log" 2>&1 && return 0
  tail -20 "$folder/$name.log" >&2
  return 1
}

# Jointed debris needs Simbody.
grep -v '^articulated ' tests/golden/kernel.txt >"$folder/golden.txt"
scenes=$(sed -n 's/^\([a-z_]*\) .*/\1/p' "$folder/golden.txt")
failures=0
table=$folder/table.txt
: >"$table"

# try NAME EMULATOR SUFFIX: the scenes, then settle, verify and export; files against those of this machine.
try() {
  name=$1 emulator=$2 suffix=$3
  out=$folder/$name/run
  rm -rf "$out"
  mkdir -p "$out"
  { echo '# scene step state_hash'
    for scene in $scenes; do
      $emulator "$folder/$name/hash_probe$suffix" --scene "$scene" | tr -d '\r' | grep -v '^#'
    done; } >"$out/hashes.txt"
  row "$name" "hashes of $(echo "$scenes" | wc -w) scenes" "cmp $folder/golden.txt $out/hashes.txt"
  core="$emulator $folder/$name/rubble-core$suffix"
  (cd "$out" && $core settle 7 . && $core verify 7 . && $core export .) >"$out/core.txt" 2>&1 || true
  row "$name" "verify" "grep -q ^the.same $out/core.txt"
  for file in pile.bin pile.stl; do
    [ "$name" = here ] || row "$name" "$file" "cmp $folder/here/run/$file $out/$file"
  done
}

row() {
  if $3 >"$folder/cmp.txt" 2>&1; then result=same; else result=DIFFERENT failures=$((failures + 1)); fi
  printf '%-8s %-22s %s\n' "$1" "$2" "$result" | tee -a "$table"
}

missing() {
  printf '%-8s %-22s %s\n' "$1" "" "NOT POSSIBLE: $2" | tee -a "$table"
  failures=$((failures + 1))
}

# try_debian NAME SUITE: what a newcomer types. What was printed is in FOLDER/NAME.
try_debian() {
  mkdir -p "$folder/$1"
  for target in demo test; do
    log=$folder/$1/make_$target.log
    if tools/bare_debian.sh "$2" "$folder/$1" "make $target" >"$log" 2>&1; then
      printf '%-8s %-22s %s\n' "$1" "make $target" works | tee -a "$table"
    else
      tail -40 "$log" >&2
      missing "$1" "make $target fails: see $log"
      return
    fi
  done
}

if [ -n "$emulated" ]; then
  if build here; then try here "" ""; else missing here "does not build"; fi
fi
for platform in "$@"; do
  case $platform in
    debian12) try_debian debian12 bookworm; continue ;;
    debian13) try_debian debian13 trixie; continue ;;
    windows) compiler=x86_64-w64-mingw32-g++-posix system=Windows processor=AMD64 suffix=.exe
      emulator=$(command -v wine64 || command -v wine || echo /usr/lib/wine/wine64) ;;
    riscv64) compiler=riscv64-linux-gnu-g++ system=Linux processor=riscv64 suffix='' emulator=qemu-riscv64 ;;
    arm64) compiler=aarch64-linux-gnu-g++ system=Linux processor=aarch64 suffix='' emulator=qemu-aarch64 ;;
  esac
  if ! command -v "$compiler" >/dev/null || ! command -v "$emulator" >/dev/null; then
    missing "$platform" "install tools/packages-platforms.txt"
  elif build "$platform" "-DCMAKE_SYSTEM_NAME=$system" "-DCMAKE_SYSTEM_PROCESSOR=$processor" "-DCMAKE_CXX_COMPILER=$compiler" \
    "-DCMAKE_C_COMPILER=$(echo "$compiler" | sed 's/g++/gcc/')" -DCMAKE_EXE_LINKER_FLAGS=-static; then
    WINEDEBUG=-all WINEPREFIX="$folder/wine" try "$platform" "$emulator" "$suffix"
  else
    missing "$platform" "does not build"
  fi
done
[ "$failures" -eq 0 ] || { echo "platforms: $failures rows differ or fail" >&2; exit 1; }
echo "platforms: all $(wc -l <"$table") rows are the same or work"
