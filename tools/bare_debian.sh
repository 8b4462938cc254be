#!/bin/sh
# Builds and tests this tree in a bare Debian, as a newcomer does there: make demo, then make test. Needs root,
# debootstrap and an archive of Debian.
# usage: tools/bare_debian.sh SUITE FOLDER [COMMAND]
#   SUITE:   bookworm (Debian 12), trixie (Debian 13); others that debootstrap knows
#   FOLDER:  for the root of that system and for what is built there; both are used again by the next call
#   COMMAND: what to run instead, in the root of the tree
# The tree is /src there, its build/ and out/ are FOLDER/build and FOLDER/out. Mounts go with the last process.
# Environment: SSL_CERT_FILE, where the network's proxy has a certificate of its own: pip and npm are told of it there.
set -eu
suite=${1:?usage: tools/bare_debian.sh SUITE FOLDER [COMMAND]}
folder=${2:?usage: tools/bare_debian.sh SUITE FOLDER [COMMAND]}
command=${3:-make demo && make test}
if [ "$(id -u)" != 0 ]; then
  echo "tools/bare_debian.sh: needs root, for debootstrap, mount and chroot" >&2
  exit 2
fi
tree=$(cd "$(dirname "$0")/.." && pwd)
mkdir -p "$folder/build" "$folder/out" "$tree/build" "$tree/out"
folder=$(cd "$folder" && pwd)
root=$folder/root
"$tree/tools/package/make_root.sh" "$root" "" "$suite"
mkdir -p "$root/src"
certificates=""
if [ -n "${SSL_CERT_FILE:-}" ]; then
  cp "$SSL_CERT_FILE" "$root/etc/certificates-of-the-host.crt"
  for name in SSL_CERT_FILE PIP_CERT REQUESTS_CA_BUNDLE NODE_EXTRA_CA_CERTS; do
    certificates="$certificates $name=/etc/certificates-of-the-host.crt"
  done
fi

# shellcheck disable=SC2016  # expanded by the inner shells
exec unshare --mount --pid --fork /bin/sh -euc '
  root=$1 tree=$2 folder=$3 command=$4 certificates=$5
  mount -t proc proc "$root/proc"
  mount --rbind /dev "$root/dev"
  mount --bind "$tree" "$root/src"
  mount --bind "$folder/build" "$root/src/build"
  mount --bind "$folder/out" "$root/src/out"
  in_root() {
    env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root DEBIAN_FRONTEND=noninteractive $certificates chroot "$root" /bin/sh -euc "$1"
  }
  # What a newcomer has, who has cloned this tree.
  in_root "dpkg-query -W make git ca-certificates >/dev/null 2>&1 ||
    { apt-get -q update && apt-get -q -y --no-install-recommends install make git ca-certificates; }"
  in_root "cd /src && $command"' sh "$root" "$tree" "$folder" "$command" "$certificates"
