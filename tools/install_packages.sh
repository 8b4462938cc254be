#!/bin/sh
# Installs the Debian or Ubuntu packages of the given lists that are missing; does nothing when none is.
# usage: tools/install_packages.sh [--program] packages.txt ...
#   --program: no package below a line "# Only for tests and benches"
# A line of a list:
#   NAME                      this package
#   NAME|OTHER|...            the first of these that the release has
#   ... if-missing COMMAND    only where COMMAND is not on the PATH already
#   ... if-available          only where the release has it
set -eu

program=""
if [ "${1:-}" = --program ]; then
  program=yes
  shift
fi

is_installed() {
  [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null || true)" = installed ]
}
# Virtual packages have no candidate: a list names what provides them.
is_available() {
  apt-cache policy "$1" | grep -q '^  Candidate: [^(]'
}

wanted=""    # what must be there, alternatives joined by |
optional=""  # what is taken where the release has it
for list in "$@"; do
  while read -r names condition command _; do
    if [ -n "$program" ] && [ "$names $condition" = "# Only" ]; then break; fi
    case "$names" in "" | "#"*) continue ;; esac
    case "$condition" in
      "" | if-available) ;;
      if-missing) if command -v "$command" >/dev/null 2>&1; then continue; fi ;;
      *) echo "$list: expected NAME, if-missing COMMAND or if-available, found: $names $condition" >&2; exit 2 ;;
    esac
    for name in $(echo "$names" | tr '|' ' '); do
      if is_installed "$name"; then continue 2; fi
    done
    if [ "$condition" = if-available ]; then optional="$optional $names"; else wanted="$wanted $names"; fi
  done <"$list"
done

# choose NAMES...: puts what the release has of them into `chosen`, the rest into `lacking`.
choose() {
  chosen="" lacking=""
  for names in "$@"; do
    for name in $(echo "$names" | tr '|' ' '); do
      if is_available "$name"; then chosen="$chosen $name"; continue 2; fi
    done
    lacking="$lacking $names"
  done
}
# shellcheck disable=SC2086  # the names are words on purpose, here and below
choose $optional
[ -n "$wanted$chosen" ] || exit 0

if [ "$(id -u)" = 0 ]; then
  as_root=""
elif command -v sudo >/dev/null 2>&1; then
  as_root="sudo"
else
  choose $wanted $optional
  echo "These packages are missing, and installing them takes root or sudo:" >&2
  echo " $chosen$lacking" >&2
  echo "As root: apt-get update && apt-get install --no-install-recommends$chosen" >&2
  exit 2
fi

$as_root env DEBIAN_FRONTEND=noninteractive apt-get update -q
choose $wanted
if [ -n "$lacking" ]; then
  echo "This release has no package of these names:$lacking" >&2
  echo "Rubble is built on Debian 12 and 13 (docs/development/platforms.md); the archives of this machine are in /etc/apt." >&2
  exit 2
fi
missing=$chosen
choose $optional
missing="$missing$chosen"
[ -n "$missing" ] || exit 0
echo "Installing with apt:$missing"
# An installation that was cut off leaves packages half configured, and apt refuses to go on.
if [ -n "$(dpkg --audit)" ]; then
  echo "An earlier installation was interrupted: finishing it first (dpkg --configure -a)"
  $as_root env DEBIAN_FRONTEND=noninteractive dpkg --configure -a ||
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -f -q -y --no-install-recommends
fi
$as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $missing
