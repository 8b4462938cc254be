#!/bin/sh
# Starts the Rubble of the folder above with the libraries that came with it.
here=$(cd "$(dirname "$(readlink -f "$0")")/.." && pwd)
export LD_LIBRARY_PATH="$here/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
export LIBGL_DRIVERS_PATH="$here/lib/dri"
# Mesa of this folder, and NVIDIA's driver where the machine has it.
vendors=$here/share/glvnd/50_mesa.json
for file in /usr/share/glvnd/egl_vendor.d/10_nvidia.json /etc/glvnd/egl_vendor.d/10_nvidia.json; do
  [ ! -e "$file" ] || vendors=$file:$vendors
done
export __EGL_VENDOR_LIBRARY_FILENAMES="${__EGL_VENDOR_LIBRARY_FILENAMES:-$vendors}"
exec "$here/libexec/rubble" "$@"
