#!/bin/sh
# Makes an image for containers with a Debian package in it: an OCI archive, which `podman load` and
# `skopeo copy oci-archive:FILE` read. Needs root, debootstrap and an archive; no container engine.
# usage: tools/package/make_image.sh PACKAGE.deb FOLDER IMAGE.tar
#   FOLDER: for the root of that Debian; made, and used again when it is there (removing it is yours)
set -eu
here=$(dirname "$0")
root=$2/root
"$here/make_root.sh" "$root" "$1"
# What nobody reads in a container: 10 MB of documents, 80 of lists, the packages themselves.
rm -rf "$root"/var/lib/apt/lists/* "$root"/var/cache/apt/* "$root"/var/cache/debconf/*-old "$root"/var/log/*.log \
  "$root"/usr/share/man/* "$root"/usr/share/locale/* "$root"/installed
find "$root/usr/share/doc" -type f ! -name copyright -delete
grep -q '^rubble:' "$root/etc/passwd" ||
  chroot "$root" useradd --uid 1000 --create-home --shell /bin/sh rubble
mkdir -p "$root/work"
chroot "$root" chown 1000:1000 /work
touch "$root/installed"
exec "$here/oci_archive.py" "$root" "$3" "$(dpkg-deb -f "$1" Version)" "$(dpkg-deb -f "$1" Architecture)"
