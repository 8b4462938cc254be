#!/bin/bash
# Draws docs/pictures/collapse/MODE.png from each scripts/collapse/MODE.lua: the settled pile, cut open.
# usage: tools/collapse_pictures.sh [BUILD_FOLDER] [MODE...]
set -eu
cd "$(dirname "$0")/.."
build=${1:-build/release}
shift || true
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p docs/pictures/collapse

for script in scripts/collapse/*.lua; do
  mode=$(basename "$script" .lua)
  [ $# -eq 0 ] || [[ " $* " == *" $mode "* ]] || continue
  title=$(head -1 "$script" | sed 's/^-- //; s/[.]$//')
  "$build/rubble" settle "$script" --quiet --out "$scratch/$mode" > "$scratch/log"
  "$build/rubble" cutaway "$scratch/$mode" --title "$title" \
    --out "docs/pictures/collapse/$mode.png"
done
