#!/bin/bash
# Inspects a mission by keys on a screen of its own, for the picture of docs/how_to/inspect.md: pieces in the
# air with their hulls, contact forces at rest, the views of cameras, the map of voids. Needs xvfb, xdotool and
# python3-opencv. When each moment comes depends on how fast the machine draws, so let it be idle.
# usage: tools/inspect_sheet.sh [PROGRAM] [FOLDER]
set -eu
cd "$(dirname "$0")/.."
program=${1:-build/release/rubble} folder=${2:-docs/pictures}
d=$(mktemp -d)
Xvfb -displayfd 3 -screen 0 1400x900x24 -nolisten tcp 3> "$d/display" > /dev/null 2>&1 & xvfb=$!
trap 'kill $xvfb; rm -rf "$d"' EXIT
until [ -s "$d/display" ]; do sleep 0.1; done
export DISPLAY=:$(cat "$d/display")
unset SDL_VIDEODRIVER

touch "$d/log"
"$program" inspect scripts/first_pile.lua --set pile.layers=1 --size 640x400 --quiet --out "$d/out" > /dev/null 2> "$d/log" & inspect=$!
until grep -q 'inspect: ready' "$d/log"; do
  kill -0 $inspect || { cat "$d/log"; exit 1; }
  sleep 0.1
done
xdotool windowfocus "$(xdotool search --sync --onlyvisible --name 'rubble inspect' | head -1)"
shots=0
shot() {
  shots=$((shots + 1))
  xdotool key p
  until [ -s "$d/out/picture_00$shots.png" ]; do kill -0 $inspect; sleep 0.1; done
  sleep 3.5  # the name of the picture is shown
}
xdotool keydown s; sleep 1; xdotool keyup s; sleep 2; xdotool key space v; sleep 1; shot  # hulls of what falls
xdotool key v space; sleep 60; xdotool key c; sleep 3; shot   # contact forces at rest
xdotool key c o; sleep 3; shot                          # views of cameras
xdotool key o m; sleep 45; shot                         # voids
xdotool key Escape
wait $inspect

/usr/bin/python3 - "$d/out" "$folder/inspect.jpg" << 'END'
import sys, cv2
rows = [cv2.imread("%s/picture_%03d.png" % (sys.argv[1], i)) for i in range(1, 5)]
sheet = cv2.vconcat([cv2.hconcat(rows[i:i + 2]) for i in (0, 2)])
cv2.imwrite(sys.argv[2], sheet, [cv2.IMWRITE_JPEG_QUALITY, 80])
END
