#!/bin/sh
# Packs a folder as a self-extracting archive: archive_head.sh, and the folder as a compressed tar file. The same
# files give the same bytes.
# usage: tools/package/self_extracting.sh FOLDER VERSION ARCHIVE
set -eu
here=$(cd "$(dirname "$0")" && pwd)
lines=$(wc -l <"$here/archive_head.sh")
glibc=$(getconf GNU_LIBC_VERSION | cut -d ' ' -f 2)
sed "s/@VERSION@/$2/; s/@LINES@/$lines/; s/@GLIBC@/$glibc/" "$here/archive_head.sh" >"$3"
tar -C "$1" --sort=name --owner=0 --group=0 --numeric-owner --mtime=@0 -cf - . | gzip -n -6 >>"$3"
chmod 755 "$3"
