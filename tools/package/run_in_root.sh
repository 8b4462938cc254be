#!/bin/sh
# Runs a command in the root of another system as nobody, with the network off. Needs root.
# usage: [ROOT_USER=UID:GID] tools/package/run_in_root.sh ROOT COMMAND
set -eu
exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/tmp unshare --net --mount --pid --fork /bin/sh -c \
  'mount -t proc proc "$1/proc" && exec chroot --userspec="$3" "$1" /bin/sh -c "$2"' sh "$1" "$2" \
  "${ROOT_USER:-65534:65534}"
