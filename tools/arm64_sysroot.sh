#!/bin/sh
# Unpacks what the kernel links on arm64, from Debian's archive, into a folder: no root, no chroot,
# no foreign architecture for this machine's own dpkg.
# usage: tools/arm64_sysroot.sh FOLDER
set -eu

folder=$1
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
root=$folder/root
apt=$folder/apt
[ ! -e "$root/complete" ] || exit 0

# An apt of its own that believes in an empty arm64 machine with this machine's sources.
mkdir -p "$apt/state/lists/partial" "$apt/cache/archives/partial" "$apt/dpkg"
: >"$apt/dpkg/status"
cat >"$apt/apt.conf" <<END
APT::Architecture "arm64";
APT::Architectures { "arm64"; };
APT::Install-Recommends "false";
APT::Sandbox::User "";
Dir::State "$apt/state";
Dir::State::status "$apt/dpkg/status";
Dir::Cache "$apt/cache";
Dir::Log "$apt";
END
export APT_CONFIG="$apt/apt.conf"
# Sources that have no arm64 index are of no interest here.
apt-get update -q || echo "arm64_sysroot: some sources could not be read; going on" >&2
apt-get install -q -y --download-only libsimbody-dev libxxhash-dev libssl-dev

rm -rf "$root"
mkdir -p "$root/usr/lib" "$root/usr/bin" "$root/usr/sbin"
for name in lib bin sbin; do ln -s "usr/$name" "$root/$name"; done
for package in "$apt"/cache/archives/*.deb; do dpkg-deb -x "$package" "$root"; done

# What the packages' scripts would have linked: reference BLAS and LAPACK.
libraries=$root/usr/lib/aarch64-linux-gnu
for name in blas lapack; do
  for file in "$libraries/$name"/*; do ln -sf "$name/$(basename "$file")" "$libraries"; done
done
# Links that point to the root of the machine point into this folder instead.
find "$root" -type l -lname '/*' | while read -r link; do
  ln -sfn "$root$(readlink "$link")" "$link"
done
# Simbody's CMake files name libraries by absolute paths.
grep -rl '"\?/usr/lib/aarch64' "$libraries/cmake/simbody" |
  xargs -r sed -i "s#/usr/lib/aarch64-linux-gnu/#$libraries/#g"
touch "$root/complete"
