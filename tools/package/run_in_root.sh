#!/bin/sh
# Runs a command in the root of another system as nobody, with the network off. Needs root.
# usage: tools/package/run_in_root.sh ROOT COMMAND
set -eu
exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/tmp unshare --net --mount --pid --fork /bin/sh -c \
  'mount -t proc proc "$1/proc" && exec chroot --userspec=65534:65534 "$1" /bin/sh -c "$2"' sh "$1" "$2"
