#!/bin/bash
# Drives through two missions by keys on a screen of its own, for the pictures of docs/how_to/drive.md: the
# window in the first mission, and six moments over a terrain on one sheet. Needs xvfb, xdotool and
# python3-opencv. How far each key leads depends on how fast the machine draws, so let it be idle.
# usage: tools/drive_sheet.sh [PROGRAM] [FOLDER]
set -eu
cd "$(dirname "$0")/.."
program=${1:-build/release/rubble} folder=${2:-docs/pictures}
d=$(mktemp -d)
Xvfb -displayfd 3 -screen 0 1400x450x24 -nolisten tcp 3> "$d/display" > /dev/null 2>&1 & xvfb=$!
trap 'kill $xvfb; rm -rf "$d"' EXIT
until [ -s "$d/display" ]; do sleep 0.1; done
export DISPLAY=:$(cat "$d/display")
unset SDL_VIDEODRIVER

enter() {  # MISSION NAME
  "$program" drive "scripts/$1.lua" --quiet --out "$d/$2" > /dev/null 2> "$d/$2.log" & drive=$!
  until grep -q 'drive: ready' "$d/$2.log"; do
    kill -0 $drive || { cat "$d/$2.log"; exit 1; }
    sleep 0.1
  done
  xdotool windowfocus "$(xdotool search --sync --onlyvisible --name 'rubble drive' | head -1)"
}
leave() { xdotool key Escape; wait $drive; }
hold() {  # SECONDS KEY...
  local seconds=$1 key; shift
  for key in "$@"; do xdotool keydown "$key"; done
  sleep "$seconds"
  for key in "$@"; do xdotool keyup "$key"; done
}
shot() { sleep 3.5; xdotool key p; sleep 0.5; }  # the name of the picture before has gone by then

enter first_pile window
for i in 1 2 3; do xdotool key x; done
hold 1.2 w; hold 0.4 d; shot
leave

enter terrain sheet
shot
for i in 1 2 3 4 5; do xdotool key x; done
hold 2.5 w; shot
hold 0.7 w q; shot
hold 0.7 e; hold 0.6 Up; hold 2.5 w; hold 1 Down; shot
hold 0.8 a; xdotool key f; shot
xdotool key h; shot
leave

cp "$d/window/picture_001.png" "$folder/drive.png"
/usr/bin/python3 - "$d/sheet" "$folder/drive_sheet.jpg" << 'END'
import sys, cv2
rows = [cv2.imread("%s/picture_%03d.png" % (sys.argv[1], i)) for i in range(1, 7)]
rows = [cv2.resize(r, None, fx=0.6, fy=0.6, interpolation=cv2.INTER_AREA) for r in rows]
sheet = cv2.vconcat([cv2.hconcat(rows[i:i + 2]) for i in (0, 2, 4)])
cv2.imwrite(sys.argv[2], sheet, [cv2.IMWRITE_JPEG_QUALITY, 80])
END
