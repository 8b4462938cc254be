// `rubble drive` in a real window: a screen of its own (Xvfb), keys from xdotool.
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/app/driven_leg.h"
#include "tests/app/program.h"
#include "tests/base/slowdown.h"

namespace rubble::testing {
namespace drive_window_test {

// What the screen shows, as Xvfb keeps it: X's window dump format, big-endian header.
struct Screen {
  std::string bytes;
  unsigned word(std::size_t i) const {
    unsigned value = 0;
    for (std::size_t k = 0; k < 4; ++k)
      value = value << 8 | static_cast<unsigned char>(bytes.at(4 * i + k));
    return value;
  }
  unsigned long at(unsigned x, unsigned y) const {  // a pixel's bytes
    const std::size_t start = word(0) + 12ul * word(19) + std::size_t(word(12)) * y + 4ul * x;
    return static_cast<unsigned char>(bytes.at(start)) |
           static_cast<unsigned char>(bytes.at(start + 1)) << 8 |
           static_cast<unsigned char>(bytes.at(start + 2)) << 16;
  }
};

// Pixels of a square at x0 that differ between two screens, or from black.
int count_changes(const Screen& a, const Screen* b, unsigned x0, unsigned y0, unsigned side) {
  int count = 0;
  for (unsigned y = y0; y < y0 + side; ++y)
    for (unsigned x = x0; x < x0 + side; ++x) count += a.at(x, y) != (b ? b->at(x, y) : 0);
  return count;
}

// Before each script: a screen; pause SECONDS, longer under a sanitizer; find_window, of the drive when it is ready.
const char* const kPrologue = R"(
d=$1; program=$2; slowdown=$3
pause() { for i in $(seq $slowdown); do sleep $1; done; }
Xvfb -displayfd 3 -screen 0 448x168x24 -fbdir $d -nolisten tcp 3>$d/display >/dev/null 2>&1 & xvfb=$!
trap 'kill $xvfb' EXIT
for i in $(seq 100); do [ -s $d/display ] && break; sleep 0.1; done
export DISPLAY=:$(cat $d/display)
unset SDL_VIDEODRIVER
find_window() {
  until grep -q "${1:-drive}: ready" $d/stderr; do kill -0 $drive || exit 1; sleep 0.1; done
  w=$(xdotool search --sync --onlyvisible --name "rubble ${1:-drive}" | head -1)
}
)";

// The exit code of the script, which drives and leaves what it wrote in the folder.
int drive(const ScratchFolder& scratch, const std::string& script) {
  write_file(scratch / "drive.sh", kPrologue + script);
  const std::string command = "cd '" RUBBLE_SOURCE_DIR "' && timeout " + std::to_string(120 * kSlowdown) + " bash " +
                              (scratch / "drive.sh") + " " + scratch.path().string() + " " RUBBLE_PROGRAM " " +
                              std::to_string(kSlowdown);
  return std::system(command.c_str());
}

// Sends keys, keeps what the screen showed before and after.
const char* const kScript = R"(
$program drive scripts/small.lua --size 160x120 --record --set outputs.rawlog=false --quiet \
  --set outputs.stl=false --out $d/out >$d/stdout 2>$d/stderr & drive=$!
find_window
xdotool windowfocus $w; xdotool mousemove --window $w 80 60
for i in $(seq 100); do [ $(tr -d '\000' <$d/Xvfb_screen0 | wc -c) -gt 40000 ] && break; sleep 0.2; done  # drawn
pause 0.4; cp $d/Xvfb_screen0 $d/before
xdotool keydown w keydown d; pause 0.6; xdotool keyup w keyup d
xdotool key l; pause 0.6; xdotool key f; pause 0.6
cp $d/Xvfb_screen0 $d/after
xdotool key Escape
wait $drive
)";

TEST(DriveWindow, WhatIsDrivenByKeysRunsAgainByteForByte) {
  const ScratchFolder scratch;
  ASSERT_EQ(drive(scratch, kScript), 0) << read_file(scratch / "stderr");

  const Screen before{read_file(scratch / "before")}, after{read_file(scratch / "after")};
  for (const unsigned pane : {0u, 160u, 320u}) {
    EXPECT_GT(count_changes(before, nullptr, pane + 10, 20, 90), 4000) << pane;  // not black
    EXPECT_GT(count_changes(before, &after, pane + 10, 20, 90), 20) << pane;     // it moved
  }
  for (const std::string leg : {"leg_001", "leg_002", "leg_003"}) {
    expect_same_frames(scratch, leg, 1);
    EXPECT_EQ(read_file(scratch / ("out/" + leg + "/mission.bag")),
              read_file(scratch / (leg + "/mission.bag")));
  }
}

// A hillside with a few bricks, and a camera that is driven into it: the ground holds it up, and what
// was driven is a mission over the same hill.
const char* const kHillside = R"(return rubble.mission {
  seed = 2,
  pile = { layers = 1, pieces_per_layer = 3, mix = { { asset = "brick" } },
           spawn_position = { 0, 0, 3 }, spawn_bounds = { 1, 1, 1 },
           terrain = rubble.terrain.from(function(x, y) return 1 + 0.2 * x end,
                                         { length = 8, width = 8, spacing = 1 }) },
  trajectory = { plan = "refuse", radius = 0.2, speed = 3, waypoints = {
    { t = 0, position = { -2, 0, 1.2 }, look_at = { 0, 0, 0.9 } } } },
}
)";

const char* const kDownhill = R"(
$program drive $d/hillside.lua --size 160x120 --quiet --steps 45 --set outputs.rawlog=false \
  --set outputs.bag=false --out $d/out >$d/stdout 2>$d/stderr & drive=$!
find_window
xdotool windowfocus $w; xdotool keydown w
wait $drive
)";

TEST(DriveWindow, AHillsideHoldsTheCameraUp) {
  const ScratchFolder scratch;
  write_file(scratch / "hillside.lua", kHillside);
  ASSERT_EQ(drive(scratch, kDownhill), 0) << read_file(scratch / "stderr");
  // With the plan "refuse" the run would complain of a touch.
  const Outcome again =
      run_rubble("run " + (scratch / "out/leg_001.lua") + " --quiet --out " + (scratch / "leg"));
  ASSERT_EQ(again.exit_code, 0) << again.err;
  const auto flight = nlohmann::json::parse(read_file(scratch / "leg/flight.json"));
  EXPECT_GE(flight["least_clearance_m"].get<double>(), 0.2);
  EXPECT_LT(flight["least_clearance_m"].get<double>(), 0.35) << "it came down to the hill";
  const auto json = nlohmann::json::parse(read_file(scratch / "leg/manifest.json"));
  std::istringstream seen(read_file(scratch / "out/leg_001.hashes"));
  std::string row;
  std::getline(seen, row);
  for (std::size_t i = 0; std::getline(seen, row); ++i)
    ASSERT_EQ(row, json["frame_hashes"]["xxh64"].at(i)) << "frame " << i;
}

const char* const kByKeys = R"(
$program drive scripts/robots/crawler.lua --size 160x120 --quiet --set trajectory.rate_hz=1 \
  --set pile.pieces_per_layer=10 --out $d/out >$d/stdout 2>$d/stderr & drive=$!
find_window
for i in $(seq 100); do [ $(tr -d '\000' <$d/Xvfb_screen0 | wc -c) -gt 40000 ] && break; sleep 0.2; done  # drawn
pause 0.5; xdotool windowfocus $w; xdotool keydown w; pause 2; xdotool keydown a; pause 1; xdotool keyup w keyup a
xdotool keydown Down; pause 0.5; xdotool keyup Down; pause 0.3
xdotool key Escape
wait $drive
)";

TEST(DriveWindow, ARobotDrivenByKeysRunsAgainWithTheSameBits) {
  const ScratchFolder scratch;
  ASSERT_EQ(drive(scratch, kByKeys), 0) << read_file(scratch / "stderr");
  const std::string leg = read_file(scratch / "out/leg_001.lua");
  EXPECT_NE(leg.find("linear = 0.5"), std::string::npos) << leg;
  EXPECT_LT(leg.find("linear = 0.5"), leg.find(" t = 0.0,")) << "time began before the first key: " << leg;
  EXPECT_NE(leg.find("live_light = true"), std::string::npos) << "lit otherwise than it was seen: " << leg;
  const std::size_t path = leg.find("trajectory = {");
  EXPECT_EQ(leg.find("rate_hz", path), leg.find("rate_hz = 1.0", path)) << "frames at another rate: " << leg;
  EXPECT_NE(leg.find("angular = 1"), std::string::npos) << leg;
  EXPECT_NE(leg.find("flippers_deg"), std::string::npos) << leg;
  const Outcome again = run_rubble("run " + (scratch / "out/leg_001.lua") + " --quiet --out " + (scratch / "leg") +
                                   " --set camera.width=32 --set camera.height=24");
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_GT(read_file(scratch / "out/leg_001.track").size(), 1000U);
  EXPECT_TRUE(read_file(scratch / "out/leg_001.track") == read_file(scratch / "leg/robots/track.bin"));
}

// Bricks, a block that can be pulled and, beside it, a table that a ball fits under. Stopped at once, shown with everything
// and stepped; then the block is pulled at rest. The program itself saves the pictures, between two others.
const char* const kBlock = R"(return rubble.mission {
  seed = 4,
  pile = { layers = 1, pieces_per_layer = 3, mix = { { asset = "brick" } }, spawn_position = { 0, 1, 1.5 },
           spawn_bounds = { 0.4, 0.4, 0.3 },
           placed = { { box = { 0.1, 0.6, 0.4 }, position = { 0.9, 0, 0.2 } }, { box = { 0.1, 0.6, 0.4 }, position = { 1.5, 0, 0.2 } },
                      { box = { 0.8, 0.6, 0.1 }, position = { 1.2, 0, 0.45 } },
                      { box = { 0.8, 0.8, 0.8 }, position = { 0, 0, 0.4005 }, fixed = false } } },
  voids = { voxel = 0.05, radius = 0.1 },
  camera = { width = 32, height = 24 },
  trajectory = { duration = 1, rate_hz = 2, waypoints = { { position = { -0.5, 0, 1.2 }, look_at = { 0, 0, 0.5 } } } },
  outputs = { bag = false, rawlog = false, simplemap = false, stl = false, preview = false },
})";

const char* const kInspect = R"(
$program inspect $d/m.lua --size 240x120 --quiet --out $d/out >$d/stdout 2>$d/stderr & drive=$!
find_window inspect
xdotool windowfocus $w
await() { until grep -q "$1" $d/stderr; do kill -0 $drive || exit 1; sleep 0.1; done; }
shot() { xdotool key p; n=$((${n:-0} + 1)); await picture_00$n; }
xdotool key space; shot
for key in v c o; do xdotool key $key; pause 0.3; shot; xdotool key $key; done
xdotool key m; await 'voids are mapped'; shot; xdotool key m
xdotool key period; pause 0.3; xdotool key k; await moment_001
xdotool key space; await 'the pile rests'
xdotool mousemove --window $w 120 62 mousedown 1 mousemove --window $w 150 20; pause 1; xdotool mouseup 1
xdotool key k; await moment_002
xdotool key Escape
wait $drive
)";

TEST(InspectWindow, StepsShowsAndPullsAndItsMomentsGoOnAsMissions) {
  const ScratchFolder scratch;
  write_file(scratch / "m.lua", kBlock);
  ASSERT_EQ(drive(scratch, kInspect), 0) << read_file(scratch / "stderr");
  std::vector<std::string> pictures;
  for (int i = 1; i <= 5; ++i) pictures.push_back(read_file(scratch / ("out/picture_00" + std::to_string(i) + ".png")));
  for (std::size_t i = 1; i < pictures.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) EXPECT_NE(pictures[i], pictures[k]) << "pictures " << i << " and " << k;
  // Untouched it comes to the rest of the mission itself, pulled to another one.
  EXPECT_NE(read_file(scratch / "out/moment_001.lua").find("Nothing was touched"), std::string::npos);
  EXPECT_NE(read_file(scratch / "out/moment_002.lua").find("pieces were pulled"), std::string::npos) << read_file(scratch / "stderr");
  for (const auto& [mission, out] : {std::pair<std::string, std::string>{"m.lua", "a"}, {"out/moment_001.lua", "b"}, {"out/moment_002.lua", "c"}}) {
    const Outcome run = run_rubble("settle " + (scratch / mission) + " --quiet --out " + (scratch / out));
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  EXPECT_TRUE(read_file(scratch / "a/pile.bin") == read_file(scratch / "b/pile.bin"));
  EXPECT_FALSE(read_file(scratch / "a/pile.bin") == read_file(scratch / "c/pile.bin"));
}

TEST(DriveWindow, SaysWhatToDoWithoutADisplay) {
  const ScratchFolder scratch;
  const Outcome outcome =
      run_rubble("drive scripts/small.lua --out " + (scratch / "a"),
                 "env -u DISPLAY -u WAYLAND_DISPLAY -u SDL_VIDEODRIVER timeout 60");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("DISPLAY is not set"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("xvfb-run"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("settle"), std::string::npos) << outcome.err;
}

}  // namespace drive_window_test
}  // namespace rubble::testing
