#!/bin/sh
# Builds the kernel with several compilers, levels and processors, runs the standard scenes, and
# compares their hashes with tests/golden/kernel.txt. Runs whole missions under several conditions, and
# compares their outputs with tests/determinism/missions/suite.golden.json. Contract:
# docs/explanation/determinism.md.
# usage: tools/determinism_matrix.sh [--without-arm64] [--simbody] [--missions | --kernel] [--programs]
#                                    [--build FOLDER]  (from the root)
# --missions, --kernel: one half alone. Missions are of build/release/rubble.
# --programs: builds the program by other flags and compilers, too; hours on two processors.
# --simbody: builds Simbody for arm64 without fused multiply-adds first, half an hour. Without it the
# scene with joints and the mission of a robot are left out of the arm64 rows.
# Exit status: 0 all equal; 1 something differs, does not build or does not run; 2 bad usage.
set -eu
cd "$(dirname "$0")/.."

golden=$PWD/tests/golden/kernel.txt
folder=build/determinism
arm64=yes
simbody=no
kernel=yes
missions=yes
programs=no
while [ $# -gt 0 ]; do
  case $1 in
    --without-arm64) arm64=no ;;
    --simbody) simbody=yes ;;
    --missions) kernel=no ;;
    --kernel) missions=no ;;
    --programs) programs=yes ;;
    --build) folder=${2:?--build wants a folder}; shift ;;
    *) echo "usage: $0 [--without-arm64] [--simbody] [--missions | --kernel] [--programs] [--build FOLDER]" >&2; exit 2 ;;
  esac
  shift
done
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
table=$folder/table.txt
: >"$table"
failures=0
left_out=""   # a scene that is not compared
reference=""  # the first probe that runs here: it compares traces

row() { printf '%-9s %-10s %-5s %-10s %-22s %s\n' "$@" >>"$table"; }

fail() {
  failures=$((failures + 1))
  row "$@"
}

# compare ARCHITECTURE COMPILER LEVEL TARGET CONDITION COMMAND...: runs and files one line.
compare() {
  label_a=$1 label_b=$2 label_c=$3 label_d=$4 label_e=$5
  shift 5
  out=$folder/hashes.txt
  if ! "$@" >"$out"; then
    fail "$label_a" "$label_b" "$label_c" "$label_d" "$label_e" "DOES NOT RUN"
    return 0
  fi
  [ -z "$left_out" ] || sed -i "/^$left_out /d" "$out"
  if cmp -s "$golden" "$out"; then
    row "$label_a" "$label_b" "$label_c" "$label_d" "$label_e" same
  else
    fail "$label_a" "$label_b" "$label_c" "$label_d" "$label_e" DIFFERENT
    diff "$golden" "$out" | sed 's/^/    /' >>"$table" || true
    name_first_difference "$@"
  fi
}

name_first_difference() {
  [ -n "$reference" ] || return 0
  "$reference" --trace "$folder/reference.trace" >/dev/null
  "$@" --trace "$folder/other.trace" >/dev/null
  "$reference" --compare "$folder/reference.trace" "$folder/other.trace" | sed 's/^/    /' \
    >>"$table" || true
}

# build NAME CMAKE_ARGUMENTS...: makes $folder/NAME/hash_probe.
build() {
  name=$1
  shift
  echo "building $name" >&2
  if cmake -S . -B "$folder/$name" -G Ninja -DRUBBLE_KERNEL_ONLY=ON -DCMAKE_BUILD_TYPE=Release \
    "$@" >"$folder/$name.log" 2>&1; then
    cmake --build "$folder/$name" --target hash_probe >>"$folder/$name.log" 2>&1 && return 0
  fi
  tail -20 "$folder/$name.log" >&2
  return 1
}

can_run_v3() { [ "$(grep -c -w -E 'avx2' /proc/cpuinfo)" -gt 0 ] && grep -q -w fma /proc/cpuinfo; }

native() {
  for compiler in g++ clang++; do
    for level in O1 O2 O3; do
      for target in x86-64 x86-64-v3; do
        name=$compiler-$level-$target
        if ! build "$name" "-DCMAKE_CXX_COMPILER=$compiler" \
          "-DCMAKE_CXX_FLAGS_RELEASE=-$level -march=$target"; then
          fail x86_64 "$compiler" "-$level" "$target" "" "DOES NOT BUILD"
          continue
        fi
        probe=$folder/$name/hash_probe
        if [ "$target" = x86-64-v3 ] && ! can_run_v3; then
          fail x86_64 "$compiler" "-$level" "$target" "" "NOT RUN: this processor is older"
          continue
        fi
        [ -n "$reference" ] || reference=$probe
        for threads in 1 3; do
          compare x86_64 "$compiler" "-$level" "$target" "$threads thread(s)" \
            "$probe" --threads "$threads"
        done
      done
    done
  done
}

# The same binary under another libm and another layout of memory.
conditions() {
  [ -n "$reference" ] || return 0
  compare x86_64 g++ -O1 x86-64 "libm without FMA" \
    env GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA "$reference"
  compare x86_64 g++ -O1 x86-64 "no ASLR" setarch -R "$reference"
}

# The bundled packs, which piles are made of, from both compilers; tests/assets pin their hashes.
pack() {
  packs=""
  for name in g++-O2-x86-64 clang++-O3-x86-64-v3; do
    cmake --build "$folder/$name" --target rubble_assets >>"$folder/$name.log" 2>&1 || true
    packs="$packs $folder/$name/assets"
  done
  # shellcheck disable=SC2086  # two folders on purpose
  if diff -rq --exclude=CMakeFiles --exclude='*.a' --exclude='*.cmake' --exclude='*.lua.d' \
    $packs >"$folder/pack.txt" 2>&1; then
    row x86_64 both -O2/3 "" "bytes of the pack" same
  else
    fail x86_64 both -O2/3 "" "bytes of the pack" "DIFFERENT: see $folder/pack.txt"
  fi
}

# arm64_root CONDITION: Debian's packages for arm64 in $folder/arm64/root, and with --simbody a Simbody that does not fuse.
arm64_root() {
  condition=$1
  packages="libsimbody-dev libxxhash-dev libssl-dev"
  [ "$programs" = no ] || packages="$packages libegl-dev libgl-dev libembree-dev libassimp-dev libdraco-dev libexpat1-dev
    libopencv-core-dev libopencv-imgproc-dev libmrpt-obs-dev libmrpt-maps-dev libmrpt-nav-dev libpng-dev libjpeg62-turbo-dev libtiff-dev
    libwebp-dev libopenexr-dev liblz4-dev libzstd-dev zlib1g-dev nlohmann-json3-dev libopenvdb-dev libboost-dev liboctomap-dev
    libompl-dev libeigen3-dev liblua5.4-dev libyaml-cpp-dev libcli11-dev libsdl2-dev libccd-dev coinor-libclp-dev"
  if ! command -v aarch64-linux-gnu-g++ >/dev/null || ! command -v qemu-aarch64 >/dev/null; then
    fail aarch64 g++ "" "" "$condition" "NOT POSSIBLE: install tools/packages-determinism.txt"
    return 1
  fi
  # shellcheck disable=SC2086  # names
  if ! tools/arm64_sysroot.sh "$folder/arm64" $packages >"$folder/arm64.log" 2>&1; then
    tail -20 "$folder/arm64.log" >&2
    fail aarch64 g++ "" "" "$condition" "NOT POSSIBLE: no arm64 packages; see $folder/arm64.log"
    return 1
  fi
  if [ "$simbody" = no ] || [ -e "$folder/arm64/root/simbody-without-fma" ]; then return 0; fi
  echo "building Simbody for arm64" >&2
  tools/build_simbody.sh "$folder/simbody" --arm64 "$folder/arm64" >"$folder/simbody.log" 2>&1 && return 0
  tail -20 "$folder/simbody.log" >&2
  fail aarch64 g++ "" "" "$condition" "NOT POSSIBLE: Simbody; see $folder/simbody.log"
  return 1
}

# Whether the Simbody of the arm64 rows fuses, as Debian's does: the promise holds for free pieces.
fuses() { [ ! -e "$folder/arm64/root/simbody-without-fma" ]; }

arm64_rows() {
  arm64_root "" || return 0
  if fuses; then
    left_out=articulated
    grep -v "^$left_out " "$golden" >"$folder/free.txt"
    golden=$folder/free.txt
    row aarch64 "" "" "" "scene with joints" "LEFT OUT (run with --simbody)"
  fi
  for level in O1 O2 O3; do
    if ! build "aarch64-$level" "-DCMAKE_CXX_FLAGS_RELEASE=-$level" \
      "-DCMAKE_TOOLCHAIN_FILE=$PWD/cmake/Arm64Toolchain.cmake" \
      "-DRUBBLE_ARM64_ROOT=$folder/arm64/root"; then
      fail aarch64 g++ "-$level" armv8-a "" "DOES NOT BUILD"
      continue
    fi
    for threads in 1 3; do
      compare aarch64 g++ "-$level" armv8-a "$threads thread(s), qemu" \
        qemu-aarch64 -L "$folder/arm64/root" "$folder/aarch64-$level/hash_probe" \
        --threads "$threads"
    done
  done
}

# run_missions COMPILER LEVEL TARGET CONDITION PROGRAM OPTIONS COMMAND...: the suite of missions as a child of COMMAND, with
# light baked anew. Files one line.
run_missions() {
  label_b=$1 label_c=$2 label_d=$3 label_e=$4 program=$5 options=$6
  shift 6
  echo "missions: $label_b $label_c $label_d, $label_e" >&2
  rm -rf "$folder/missions"
  # shellcheck disable=SC2086  # options: several words
  if "$@" env RUBBLE_CACHE="$folder/missions/cache" "$program" suite tests/determinism/missions/suite.lua \
    --out "$folder/missions/out" $options >"$folder/missions.txt" 2>&1; then
    row x86_64 "$label_b" "$label_c" "$label_d" "$label_e" same
  else
    fail x86_64 "$label_b" "$label_c" "$label_d" "$label_e" DIFFERENT
    grep -v '^ok ' "$folder/missions.txt" | sed 's/^/    /' >>"$table" || true
  fi
}

# preload FILE: makes $folder/FILE.so of tests/determinism/FILE.cpp.
preload() {
  c++ -std=c++17 -O1 -fPIC -shared "tests/determinism/$1.cpp" -o "$folder/$1.so" -ldl
}

# emulate ARCHITECTURE TARGET CONDITION NAMES COMMAND...: an emulator starts no jobs of its own, so single missions are made again by
# the program that COMMAND runs, against those that this machine has just run.
emulate() {
  label_a=$1 label_d=$2 label_e=$3 names=$4
  shift 4
  rm -rf "$folder/older"
  for name in $names; do
    echo "missions: $label_e, $name" >&2
    if ! RUBBLE_CACHE="$folder/older/cache" "$@" remake "$folder/missions/out/$name/manifest.json" --out "$folder/older/$name" \
      >"$folder/missions.txt" 2>&1; then
      fail "$label_a" g++ -O2 "$label_d" "$label_e" "DIFFERENT: $name"
      sed 's/^/    /' "$folder/missions.txt" | tail -5 >>"$table"
    fi
  done
  grep -q "$label_e .*DIFFERENT" "$table" || row "$label_a" g++ -O2 "$label_d" "$label_e" same
}

# The whole program for arm64, by an emulator.
arm64_program() {
  condition="missions, qemu"
  arm64_root "$condition" || return 0
  echo "building program-aarch64" >&2
  cmake --preset release -B "$folder/program-aarch64" -DBUILD_TESTING=OFF "-DCMAKE_TOOLCHAIN_FILE=$PWD/cmake/Arm64Toolchain.cmake" \
    "-DRUBBLE_ARM64_ROOT=$folder/arm64/root" "-DRUBBLE_ASSET_MAKER=$PWD/build/release/rubble_make_assets" \
    >"$folder/program-aarch64.log" 2>&1 || true
  # rubble: the target, not `program`, whose manual is printed by the program.
  if ! cmake --build "$folder/program-aarch64" --target rubble >>"$folder/program-aarch64.log" 2>&1; then
    tail -20 "$folder/program-aarch64.log" >&2
    fail aarch64 g++ -O2 armv8-a "$condition" "DOES NOT BUILD"
    return 0
  fi
  cp -r build/release/assets build/release/share "$folder/program-aarch64/"
  names=$(cd "$folder/missions/out" && echo ./*/ | sed 's#\./##g; s#/##g')
  if fuses; then
    row aarch64 g++ -O2 armv8-a scanning_crawler "LEFT OUT (run with --simbody)"
    names=$(echo "$names" | sed 's/scanning_crawler//')
  fi
  emulate aarch64 armv8-a "$condition" "$names" qemu-aarch64 -L "$folder/arm64/root" "$folder/program-aarch64/rubble"
}

whole_missions() {
  program=$PWD/build/release/rubble
  if [ ! -x "$program" ]; then
    fail x86_64 g++ -O2 x86-64 "missions" "NOT POSSIBLE: no $program; make build"
    return 0
  fi
  preload embree_isa
  for isa in sse2 avx avx2 avx512; do
    case $isa in avx*) grep -q -w "${isa}f\{0,1\}" /proc/cpuinfo || continue ;; esac
    run_missions g++ -O2 x86-64 "Embree by $isa" "$program" "--threads 1" \
      env RUBBLE_EMBREE_ISA=$isa LD_PRELOAD="$folder/embree_isa.so"
  done
  run_missions g++ -O2 x86-64 "libm without FMA" "$program" "--threads 2" \
    env GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA
  run_missions g++ -O2 x86-64 "no Mesa, 3 threads" "$program" "--threads 3" \
    env RUBBLE_EGL_LIBRARY=/nonexistent/libEGL.so.1
  if command -v qemu-x86_64 >/dev/null; then
    emulate x86_64 x86-64 "Nehalem, qemu" "lidar stereo painted" qemu-x86_64 -cpu Nehalem "$program"
  else
    fail x86_64 g++ -O2 x86-64 "Nehalem, qemu" "NOT POSSIBLE: install tools/packages-determinism.txt"
  fi
  [ "$programs" = yes ] || return 0
  for variant in "g++ -O3 x86-64-v3" "clang++ -O2 x86-64"; do
    # shellcheck disable=SC2086  # three words
    set -- $variant
    name=program-$1$2-$3
    echo "building $name" >&2
    if ! cmake --preset release -B "$folder/$name" -DBUILD_TESTING=OFF "-DCMAKE_CXX_COMPILER=$1" \
      "-DCMAKE_CXX_FLAGS_RELEASE=$2 -march=$3" >"$folder/$name.log" 2>&1 ||
      ! cmake --build "$folder/$name" --target program >>"$folder/$name.log" 2>&1; then
      tail -20 "$folder/$name.log" >&2
      fail x86_64 "$1" "$2" "$3" "missions" "DOES NOT BUILD"
      continue
    fi
    run_missions "$1" "$2" "$3" missions "$folder/$name/rubble" "--threads 2" env
  done
  [ "$arm64" = no ] || arm64_program
}

if [ "$kernel" = yes ]; then
  native
  conditions
  pack
  if [ "$arm64" = yes ]; then
    arm64_rows
  else
    row aarch64 "" "" "" "" "LEFT OUT (--without-arm64)"
  fi
fi
[ "$missions" = no ] || whole_missions

echo
printf '%-9s %-10s %-5s %-10s %-22s %s\n' machine compiler opt target condition hashes
cat "$table"
echo
if [ "$failures" -gt 0 ]; then
  echo "determinism: $failures of $(grep -c '^[xa]' "$table") rows are not the same as the golden hashes" >&2
  exit 1
fi
echo "determinism: all $(grep -c ' same$' "$table") runs give the golden hashes"
