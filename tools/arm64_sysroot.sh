#!/bin/sh
# Unpacks arm64 packages and all that they depend on, from Debian's archive, into FOLDER/root: no root, no
# chroot, no foreign architecture for this machine's own dpkg.
# usage: tools/arm64_sysroot.sh FOLDER [PACKAGE...]
#   PACKAGE: names, or FILE.deb with a path; without any, what the kernel links
set -eu

folder=$1
shift
[ $# -gt 0 ] || set -- libsimbody-dev libxxhash-dev libssl-dev
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
root=$folder/root
apt=$folder/apt
wanted="$*"
[ ! -e "$root/complete" ] || [ "$(cat "$root/complete")" != "$wanted" ] || exit 0

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
apt-get install -q -y --download-only "$@"

rm -rf "$root"
mkdir -p "$root/usr/lib" "$root/usr/bin" "$root/usr/sbin"
for name in lib bin sbin; do ln -s "usr/$name" "$root/$name"; done
for package in "$apt"/cache/archives/*.deb; do dpkg-deb -x "$package" "$root"; done
for package in "$@"; do
  case $package in *.deb) dpkg-deb -x "$package" "$root" ;; esac
done

# What the packages' scripts would have linked: reference BLAS and LAPACK.
libraries=$root/usr/lib/aarch64-linux-gnu
for name in blas lapack; do
  [ ! -d "$libraries/$name" ] || for file in "$libraries/$name"/*; do ln -sf "$name/$(basename "$file")" "$libraries"; done
done
# Links that point to the root of the machine point into this folder instead.
find "$root" -type l -lname '/*' | while read -r link; do
  ln -sfn "$root$(readlink "$link")" "$link"
done
# CMake files that name folders of the machine mean those of this folder.
find "$root/usr/lib" "$root/usr/share" -name '*.cmake' -exec \
  sed -i -e "s#/usr/lib/aarch64-linux-gnu/#$libraries/#g" -e "s#\([\" ;(]\)/usr/include#\1$root/usr/include#g" {} +
echo "$wanted" >"$root/complete"
