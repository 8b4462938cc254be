#!/bin/sh
# Installs the Debian packages of the given lists that are missing; does nothing when none is.
# usage: tools/install_packages.sh [--program] packages.txt ...
#   --program: no package below a line "# Only for tests and benches"
set -eu

program=""
if [ "${1:-}" = --program ]; then
  program=yes
  shift
fi

missing=""
for list in "$@"; do
  while read -r name condition command _; do
    if [ -n "$program" ] && [ "$name $condition" = "# Only" ]; then break; fi
    case "$name" in "" | "#"*) continue ;; esac
    if [ "${condition:-}" = if-missing ] && command -v "$command" >/dev/null 2>&1; then continue; fi
    status=$(dpkg-query -W -f '${db:Status-Status}' "$name" 2>/dev/null || true)
    [ "$status" = installed ] || missing="$missing $name"
  done <"$list"
done
[ -n "$missing" ] || exit 0

if [ "$(id -u)" = 0 ]; then
  as_root=""
elif command -v sudo >/dev/null 2>&1; then
  as_root="sudo"
else
  echo "These Debian packages are missing, and installing them takes root or sudo:" >&2
  echo " $missing" >&2
  echo "As root: apt-get update && apt-get install --no-install-recommends$missing" >&2
  exit 2
fi

echo "Installing with apt:$missing"
$as_root env DEBIAN_FRONTEND=noninteractive apt-get update -q
# An installation that was cut off leaves packages half configured, and apt refuses to go on.
if [ -n "$(dpkg --audit)" ]; then
  echo "An earlier installation was interrupted: finishing it first (dpkg --configure -a)"
  $as_root env DEBIAN_FRONTEND=noninteractive dpkg --configure -a ||
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -f -q -y --no-install-recommends
fi
# shellcheck disable=SC2086  # the names are words on purpose
$as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $missing
