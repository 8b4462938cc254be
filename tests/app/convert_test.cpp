// `rubble convert`: the same bytes as recording at once, from a dataset that is there already.
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "tests/app/program.h"
#include "tests/app/tiny_run.h"

namespace rubble::testing {
namespace convert_test {

namespace fs = std::filesystem;

constexpr char kMission[] = R"(return rubble.mission {
  seed = 3,
  pile = { layers = 1, pieces_per_layer = 8, mix = { { asset = "brick" } },
           spawn_position = { 0, 0, 1.5 }, spawn_bounds = { 1, 1, 1 } },
  camera = { width = 48, height = 32, channels = { "instance", "flow" }, stereo_baseline = 0.1 },
  imu = { on = true, rate_hz = 100 },
  lidars = { top = { model = "os0", channels = 32, columns = 512 } },
  barometers = { height = {} },
  trajectory = { rate_hz = 10, waypoints = {
    { t = 0, position = { -1.5, 0, 0.8 }, look_at = { 0, 0, 0.1 } },
    { t = 0.3, position = { -1.4, 0.1, 0.8 }, look_at = { 0, 0, 0.1 } },
  } },
  outputs = { mcap = true, tum = true, euroc = true, colmap = true, frames = true, pcd = true, kitti = true,
              kitti_odometry = true, nerfstudio = true, coco = true, webdataset = true, lerobot = true, depth = "32FC1" },
})";

// Recorded once for all tests here.
const std::string& dataset() {
  static const ScratchFolder scratch;
  static const std::string folder = [] {
    write_file(scratch / "all.lua", kMission);
    const Outcome run = run_rubble("run " + (scratch / "all.lua") + " --out " + (scratch / "all") + " --quiet");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return scratch / "all";
  }();
  return folder;
}

// Whether both are the same files with the same bytes; otherwise says which is not.
void expect_same(const std::string& was, const std::string& is) {
  if (!fs::is_directory(was)) {
    EXPECT_TRUE(read_file(was) == read_file(is)) << is;
    return;
  }
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(was)) {
    if (!entry.is_regular_file()) continue;
    ++files;
    const std::string name = entry.path().string().substr(was.size());
    EXPECT_TRUE(read_file(was + name) == read_file(is + name)) << is + name;
  }
  EXPECT_GT(files, 0u);
  for (const auto& entry : fs::recursive_directory_iterator(is))
    EXPECT_TRUE(fs::exists(was + entry.path().string().substr(is.size()))) << entry.path();
}

TEST(Convert, GivesTheBytesOfTheRecordingFromItsFrames) {
  const ScratchFolder scratch;
  const Outcome done = run_rubble("convert " + dataset() + " --quiet --out " + (scratch / "new") +
                                  " --to rawlog,simplemap,bag,mcap,groundtruth,tum,euroc,colmap,frames,pcd,kitti,kitti_odometry,"
                                  "nerfstudio,coco,webdataset,lerobot,sensors,preview");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  // The scans of kitti_odometry are moved, and those of the preview drawn, by the motion in pcd/, which is rounded to nine digits.
  for (const char* name : {"mission.rawlog", "mission.simplemap", "mission.bag", "mission.mcap", "metadata.yaml", "groundtruth.txt", "tum",
                           "euroc", "colmap", "frames", "kitti_odometry/poses", "kitti_odometry/sequences/00/image_3", "nerfstudio", "coco", "webdataset", "lerobot", "sensors",
                           "pcd/top/000001.pcd", "kitti/top/velodyne/000001.bin"})
    expect_same(dataset() + "/" + name, scratch / ("new/" + std::string(name)));
}

// Without `frames` the bag has it all but velocities and biases.
TEST(Convert, ReadsTheBagWhereThereAreNoFrames) {
  const ScratchFolder scratch;
  fs::copy(dataset(), scratch / "old", fs::copy_options::recursive);
  for (const char* name : {"frames", "mission.mcap", "colmap", "nerfstudio", "coco", "pcd"}) fs::remove_all(scratch / ("old/" + std::string(name)));
  const Outcome done = run_rubble("convert " + (scratch / "old") + " --to colmap,nerfstudio,coco,tum,mcap --quiet");
  EXPECT_EQ(done.exit_code, 1);  // an MCAP file holds scans
  EXPECT_IN("/pcd/top: the dataset has no scans that can be read back", done.err);
  EXPECT_IN("outputs.pcd = true", done.err);
  const Outcome again = run_rubble("convert " + (scratch / "old") + " --to colmap,nerfstudio,coco,tum --quiet");
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_IN("pictures and poses are those of mission.bag", again.err);
  for (const char* name : {"colmap", "nerfstudio", "coco", "tum"})
    expect_same(dataset() + "/" + name, scratch / ("old/convert/" + std::string(name)));
  // The same folder again: only by force.
  EXPECT_EQ(run_rubble("convert " + (scratch / "old") + " --to tum --quiet").exit_code, 1);
  EXPECT_EQ(run_rubble("convert " + (scratch / "old") + " --to tum --quiet --force").exit_code, 0);
  EXPECT_TRUE(fs::exists(scratch / "old/convert/coco/annotations.json")) << "another format stays";
  // Somebody's own file among ours.
  write_file(scratch / "old/convert/tum/mine.txt", "notes");
  const Outcome foreign = run_rubble("convert " + (scratch / "old") + " --to tum --quiet --force");
  EXPECT_EQ(foreign.exit_code, 1);
  EXPECT_IN("tum/mine.txt: is where the conversion writes", foreign.err);
  EXPECT_EQ(read_file(scratch / "old/convert/tum/mine.txt"), "notes");
  fs::remove(scratch / "old/convert/tum/mine.txt");
  // A bit in the bag.
  std::string bag = read_file(scratch / "old/mission.bag");
  bag[bag.size() / 2] = char(bag[bag.size() / 2] ^ 4);
  write_file(scratch / "old/mission.bag", bag);
  const Outcome damaged = run_rubble("convert " + (scratch / "old") + " --to tum --quiet --force");
  EXPECT_EQ(damaged.exit_code, 1);
  EXPECT_IN("mission.bag: is damaged at byte", damaged.err);
}

TEST(Convert, RefusesWhatCannotBe) {
  const ScratchFolder scratch;
  run_tiny(scratch, "tiny");
  const Outcome unknown = run_rubble("convert " + (scratch / "tiny") + " --to nerf");
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_IN("unknown recording format: expected one of rawlog, simplemap, bag", unknown.err);
  const Outcome masks = run_rubble("convert " + (scratch / "tiny") + " --to coco");
  EXPECT_EQ(masks.exit_code, 1);
  EXPECT_IN("camera.channels: outputs.coco needs the numbers of the pieces", masks.err);
  const Outcome scans = run_rubble("convert " + (scratch / "tiny") + " --to pcd");
  EXPECT_EQ(scans.exit_code, 1);
  EXPECT_IN("outputs.pcd: there is nothing to write", scans.err);
  EXPECT_EQ(run_rubble("convert " + (scratch / "nothing") + " --to tum").exit_code, 1);
  const Outcome itself = run_rubble("convert " + (scratch / "tiny") + " --to tum --force --out " + (scratch / "tiny/../tiny/"));
  EXPECT_EQ(itself.exit_code, 1);
  EXPECT_IN("would replace the dataset that is converted", itself.err);
  EXPECT_TRUE(fs::exists(scratch / "tiny/mission.bag"));
  // Nor does it replace files of another run, of a part of one, or of one below.
  run_tiny(scratch, "other");
  run_tiny(scratch, "above/tum");
  fs::copy(dataset(), scratch / "many", fs::copy_options::recursive);
  const auto count_files = [&](const char* out) { return std::distance(fs::recursive_directory_iterator(scratch / out), {}); };
  for (const char* out : {"other", "many/frames", "above"}) {
    const auto files = count_files(out);
    const Outcome taken = run_rubble("convert " + (scratch / "tiny") + " --to tum --force --quiet --out " + (scratch / out));
    EXPECT_EQ(taken.exit_code, 1) << out;
    EXPECT_IN("--out: would replace files of the run in", taken.err);
    EXPECT_EQ(count_files(out), files) << out;
  }
  EXPECT_EQ(run_rubble("convert " + (scratch / "tiny") + " --to tum --quiet --out " + (scratch / "other/tum_too")).exit_code, 0);
  EXPECT_EQ(run_rubble("convert " + (scratch / "tiny") + " --to tum --force --quiet --out " + (scratch / "other/tum_too")).exit_code, 0);
  // Depth of the usual bag is in millimetres, which is said.
  const Outcome rounded = run_rubble("convert " + (scratch / "tiny") + " --to webdataset --quiet");
  EXPECT_EQ(rounded.exit_code, 0) << rounded.err;
  EXPECT_IN("whole millimetres", rounded.err);
  EXPECT_IN("velocities are the differences", rounded.err);
}

// Two cameras of different rates, two inertial units, scans of three patterns, and the pile while it settles.
TEST(Convert, KeepsManySensorsInTheirOrder) {
  const ScratchFolder scratch;
  write_file(scratch / "many.lua", R"(return rubble.mission {
    seed = 3,
    pile = { layers = 1, pieces_per_layer = 4, mix = { { asset = "brick" } }, spawn_position = { 0, 0, 1 }, spawn_bounds = { 1, 1, 0.5 } },
    cameras = { a = { width = 48, height = 32, stereo_baseline = 0.1, channels = { "normals", "instance" } },
                b = { width = 40, height = 30, position = { 0.1, 0.1, 0 }, rate_hz = 5, event_camera = { on = true } } },
    imus = { one = {}, two = { rate_hz = 50 } },
    lidars = { top = { model = "os0", channels = 32, columns = 512 }, front = { model = "utm30lx" }, mid = { model = "mid360" } },
    barometers = { height = {} },
    record_settling = { on = true, to = 0.2, rate_hz = 10 },
    trajectory = { rate_hz = 10, waypoints = {
      { t = 0, position = { -1.5, 0, 0.8 }, look_at = { 0, 0, 0.1 } }, { t = 0.2, position = { -1.4, 0.1, 0.8 }, look_at = { 0, 0, 0.1 } } } },
    outputs = { mcap = true, tum = true, euroc = true, colmap = true, frames = true, pcd = true, nerfstudio = true, depth = "32FC1" },
  })");
  const Outcome run = run_rubble("run " + (scratch / "many.lua") + " --out " + (scratch / "many") + " --quiet");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Outcome done = run_rubble("convert " + (scratch / "many") + " --to rawlog,bag,mcap,tum,euroc,colmap,frames,pcd,nerfstudio,sensors --quiet");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  for (const char* name : {"mission.rawlog", "mission.bag", "mission.mcap", "euroc", "colmap", "nerfstudio", "sensors", "cameras/a/frames",
                           "cameras/b/frames", "cameras/b/tum", "pcd/mid/000000.pcd", "pcd/front/stamps.txt"})
    expect_same(scratch / ("many/" + std::string(name)), scratch / ("many/convert/" + std::string(name)));
}

// Links of robots and fines have numbers as pieces have.
TEST(Convert, KnowsWhatTheNumbersOfTheRecordingMean) {
  const ScratchFolder scratch;
  write_file(scratch / "robot.lua", R"(return rubble.mission {
    seed = 2, pile = { layers = 1, pieces_per_layer = 3, mix = { { asset = "brick" } }, spawn_position = { 1, 0, 0.5 } },
    fines = { amount = 20, drifts = 0, cables = 0 },
    camera = { width = 48, height = 32, channels = { "instance" } },
    robots = { { name = "crawler", model = "crawler", drive = { { t = 0, linear = 0.1 } } } }, robot_run = { duration = 0.3 },
    trajectory = { rate_hz = 5, waypoints = {
      { t = 0, position = { -1.5, 0, 0.8 }, look_at = { 0, 0, 0.1 } }, { t = 0.3, position = { -1.4, 0, 0.8 }, look_at = { 0, 0, 0.1 } } } },
    outputs = { coco = true, frames = true },
  })");
  const Outcome run = run_rubble("run " + (scratch / "robot.lua") + " --out " + (scratch / "robot") + " --quiet");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_IN("\"supercategory\":\"robot\"", read_file(scratch / "robot/coco/annotations.json"));
  const Outcome done = run_rubble("convert " + (scratch / "robot") + " --to coco,frames --quiet");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  for (const char* name : {"coco", "frames"}) expect_same(scratch / ("robot/" + std::string(name)), scratch / ("robot/convert/" + std::string(name)));
  const Outcome states = run_rubble("convert " + (scratch / "robot") + " --to mcap --quiet --force");
  EXPECT_EQ(states.exit_code, 1);
  EXPECT_IN("readings of robots cannot be read back", states.err);
}

// The unit is in the body of the rig, which rides on the same link.
TEST(Convert, KnowsWhatTheRigRidesOn) {
  const ScratchFolder scratch;
  write_file(scratch / "rig.lua", R"(return rubble.mission {
    pile = { layers = 0, placed = { { box = { 1, 1, 1 }, position = { 3, 0, 0.5 } } } },
    robots = { rubble.robot.rover { name = "r", position = { 0, 0, 0.001 } } }, robot_run = { duration = 0.2 },
    camera = { width = 32, height = 32 }, imu = { on = true, ride = { robot = "r" } },
    trajectory = { rate_hz = 10, ride = { robot = "r", position = { 0.5, 0, 0.25 } } },
    outputs = { euroc = true, frames = true },
  })");
  const Outcome run = run_rubble("run " + (scratch / "rig.lua") + " --out " + (scratch / "rig") + " --quiet");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_IN("data: [1, 0, 0, -0.5, 0, 1, 0, 0, 0, 0, 1, -0.25, 0, 0, 0, 1]", read_file(scratch / "rig/euroc/mav0/imu0/sensor.yaml"));
  const Outcome done = run_rubble("convert " + (scratch / "rig") + " --to euroc --quiet");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  for (const char* name : {"euroc/mav0/imu0", "euroc/mav0/cam0/sensor.yaml"})
    expect_same(scratch / ("rig/" + std::string(name)), scratch / ("rig/convert/" + std::string(name)));
}

TEST(Pieces, AreATableWithTheirMasses) {
  const Outcome table = run_rubble("pieces " + dataset());
  ASSERT_EQ(table.exit_code, 0) << table.err;
  std::istringstream lines(table.out);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line.substr(0, 62), "number,name,asset,material,layer,status,scale,density_kg_m3,vo");
  int rows = 0;
  for (; std::getline(lines, line); ++rows) {
    std::vector<std::string> cells;
    std::istringstream words(line);
    for (std::string word; std::getline(words, word, ',');) cells.push_back(word);
    ASSERT_EQ(cells.size(), 20u) << line;
    EXPECT_EQ(cells[1], "brick_00000" + std::to_string(rows));
    const auto number = [&](std::size_t i) { return std::stod(cells[i]); };
    EXPECT_NEAR(number(9), number(7) * number(8), 1e-9);
    EXPECT_GT(number(9), 0.5);  // a brick
    EXPECT_LT(number(9), 6);
    EXPECT_NEAR(number(13) * number(13) + number(14) * number(14) + number(15) * number(15) + number(16) * number(16), 1, 1e-9);
    EXPECT_GT(number(19), 0);  // it lies on the ground
    EXPECT_LT(number(19), 1);
  }
  EXPECT_EQ(rows, 8);
  const std::string labels = read_file(dataset() + "/sensors/height.csv");
  const Outcome recorded = run_rubble("pieces " + dataset() + " --out " + dataset() + "/sensors/height.csv");
  EXPECT_EQ(recorded.exit_code, 1);
  EXPECT_IN("height.csv: --out: would replace a file that a run recorded", recorded.err);
  EXPECT_EQ(read_file(dataset() + "/sensors/height.csv"), labels);
  const ScratchFolder scratch;
  for (int i = 0; i < 2; ++i) EXPECT_EQ(run_rubble("pieces " + dataset() + " --out " + (scratch / "labels.csv")).exit_code, 0);
  EXPECT_EQ(read_file(scratch / "labels.csv"), table.out);
}

}  // namespace convert_test
}  // namespace rubble::testing
