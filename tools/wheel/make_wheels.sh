#!/bin/sh
# Makes a wheel of the package for each of some Pythons, with the program and every library that it loads, and prints
# their names. Python 3.12 gives the wheel of all newer ones, too (the stable ABI). Needs the packages of packages.txt.
# usage: tools/wheel/make_wheels.sh BUILD_FOLDER OUTPUT_FOLDER PYTHON...
set -eu
[ $# -ge 3 ] || { sed -n "s/^# \\(usage\\)/\\1/p" "$0"; exit 1; }
mkdir -p "$1/wheel_work" "$2"
build=$(cd "$1" && pwd) output=$(cd "$2" && pwd)
shift 2
here=$(cd "$(dirname "$0")" && pwd)
work=$build/wheel_work
libraries=/usr/lib/$(gcc -print-multiarch)

# Libraries of libraries from which nothing is called here: of OpenCV's readers of pictures and its calibration, which
# MRPT links (gdal and 120 others come with them), of windows, of Unicode, of ODE, of memory that DDS would share.
# stub_library.py stands in for each.
unused="libopencv_imgcodecs libopencv_calib3d libGLX libOpenGL libEGL libGLESv2 libGLU libGL libicuuc libode libiceoryx_binding_c"
rm -rf "$work/stubs" && mkdir "$work/stubs"
# shellcheck disable=SC2086  # a word each
"$here/stub_library.py" "$build/rubble" "$work/stubs" $unused
# The reference BLAS, whatever the alternative of this machine is: its results do not depend on the processor.
export LD_LIBRARY_PATH="$work/stubs:$libraries/blas:$libraries/lapack${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"

# The licences of what is in the wheel, from the packages it is of; the list names /lib where dpkg may say /usr/lib.
rm -rf "$build/python/licences" && mkdir -p "$build/python/licences"
ldd "$build/rubble" | sed -n 's/.* => \(\/[^ ]*\) .*/\1/p' | grep -v "^$work" | sed 's#^/usr##; p; s#^#/usr#' | xargs dpkg -S 2>/dev/null | sed 's/[:,].*//' | sort -u |
  while read -r package; do
    [ ! -e "/usr/share/doc/$package/copyright" ] || cp -L "/usr/share/doc/$package/copyright" "$build/python/licences/$package"
  done

# At the end the build is configured as before.
tools=$work/tools
cp "$build/CMakeCache.txt" "$work/CMakeCache.txt"
trap 'cp "$work/CMakeCache.txt" "$build/CMakeCache.txt"; cmake "$build" > "$work/configured.txt" 2>&1' EXIT

for python in "$@"; do
  [ -d "$tools" ] || "$python" -m pip install --quiet --disable-pip-version-check --no-deps --require-hashes --target "$tools" \
    --requirement "$here/requirements.txt"
  rm -rf "$work/raw" && mkdir "$work/raw"
  # Else scikit-build-core forgets a build that it knows from another folder of tools, and compiles the program anew.
  rm -f "$build/.skbuild-info.json"
  (export PYTHONPATH="$tools" PATH="$tools/bin:$PATH"
   "$python" -m pip wheel --quiet --disable-pip-version-check --no-build-isolation --no-deps --wheel-dir "$work/raw" \
     --config-settings build-dir="$build" "$here/../.." >&2
   "$python" -m auditwheel repair --wheel-dir "$work/repaired" "$work"/raw/*.whl >&2)
  mv "$work"/repaired/*.whl "$output"
done
ls "$output"/*.whl
