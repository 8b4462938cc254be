#!/bin/bash
# Draws docs/pictures/collapse/MODE.png from each scripts/collapse/MODE.lua.
# usage: tools/collapse_pictures.sh [BUILD_FOLDER]     (needs python3-rosbag, python3-numpy)
set -eu
cd "$(dirname "$0")/.."
build=${1:-build/release}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p docs/pictures/collapse
for script in scripts/collapse/*.lua; do
  mode=$(basename "$script" .lua)
  "$build/rubble" run "$script" --quiet --out "$scratch/$mode" > "$scratch/log"
  tools/frames_of_bag.py "$scratch/$mode/mission.bag" "docs/pictures/collapse/$mode.png" 400 0
done
