// A mission that watches its pile settle, as a user sees it: frames, truth, files, and going on after
// a kill.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/app/program.h"

namespace rubble::testing {
namespace moving_test {

namespace fs = std::filesystem;

// Bricks fall past a camera that stands; then it flies.
const char* const kFalling = R"(return rubble.mission {
  seed = 4,
  pile = { layers = 2, pieces_per_layer = 6, spawn_position = { 0, 0, 2.5 },
           spawn_bounds = { 1.5, 1.5, 2 }, mix = { { asset = "brick", scale = { 2, 3 } } } },
  camera = { width = 64, height = 48, channels = { "instance", "flow" } },
  record_settling = { rate_hz = 4, position = { -3, -1, 1.2 }, look_at = { 0, 0, 1 } },
  trajectory = { rate_hz = 10, waypoints = {
    { t = 0, position = { -3, 0, 1.2 }, look_at = { 0, 0, 0.3 } },
    { t = 0.3, position = { -3, 0.5, 1.2 }, look_at = { 0, 0, 0.3 } } } },
  outputs = { frames = true, mcap = true, track = true },
}
)";

struct Row {
  double stamp = 0, x = 0, y = 0, z = 0;
};

std::vector<Row> read_poses(const fs::path& file) {
  std::vector<Row> rows;
  std::istringstream lines(read_file(file));
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    Row row;
    std::istringstream(line) >> row.stamp >> row.x >> row.y >> row.z;
    rows.push_back(row);
  }
  return rows;
}

nlohmann::json read_manifest(const fs::path& folder) {
  return nlohmann::json::parse(read_file(folder / "manifest.json"));
}

// Of one channel, in order.
std::vector<std::string> frame_files(const fs::path& folder, const char* channel) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder / "frames" / channel))
    names.push_back(entry.path().string());
  std::sort(names.begin(), names.end());
  return names;
}

class Falling : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new ScratchFolder;
    write_file(*scratch_ / "falling.lua", kFalling);
    const Outcome run =
        run_rubble("run " + (*scratch_ / "falling.lua") + " --threads 1 --out " + folder());
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  static void TearDownTestSuite() { delete scratch_; }
  static std::string folder() { return *scratch_ / "a"; }
  static std::string script() { return *scratch_ / "falling.lua"; }

  static inline ScratchFolder* scratch_ = nullptr;
};

TEST_F(Falling, IsOneRecordingWhoseStampsGoOn) {
  const std::vector<Row> rows = read_poses(folder() + "/groundtruth.txt");
  const double settled = read_manifest(folder()).at("pile").at("simulated_s");
  const auto watched = std::size_t(std::floor(settled * 4 + 1e-6)) + 1;
  ASSERT_EQ(rows.size(), watched + 4);
  for (std::size_t i = 0; i < watched; ++i) {
    EXPECT_NEAR(rows[i].stamp, 1 + 0.25 * double(i), 1e-6);
    EXPECT_NEAR(rows[i].y, -1, 1e-9);
  }
  EXPECT_GE(rows[watched].stamp, 1 + settled - 1e-6);
  EXPECT_NEAR(rows[watched].y, 0, 1e-9);
  EXPECT_NEAR(rows.back().stamp - rows[watched].stamp, 0.3, 1e-6);
  EXPECT_EQ(frame_files(folder(), "rgb").size(), rows.size());
}

// The flight over the pile is that of the same mission without what came before.
TEST_F(Falling, TheFlightIsTheSameWithoutIt) {
  const std::string plain = *scratch_ / "plain";
  const Outcome run = run_rubble("run " + script() + " --threads 1 --set record_settling=false --set "
                                 "outputs.track=false --out " + plain);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(read_state_hash(plain), read_state_hash(folder()));
  EXPECT_FALSE(fs::exists(plain + "/track.bin"));
  for (const char* channel : {"rgb", "depth", "instance", "flow"}) {
    const auto with = frame_files(folder(), channel), without = frame_files(plain, channel);
    ASSERT_EQ(without.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_EQ(read_file(with[with.size() - 4 + i]), read_file(without[i])) << channel << " " << i;
    EXPECT_NE(read_file(with[1]), read_file(with[2])) << channel;  // something falls
  }
  EXPECT_EQ(read_manifest(plain).at("metrics"), read_manifest(folder()).at("metrics"));
}

TEST_F(Falling, VerifiesAndIsTheSameForAnyNumberOfThreads) {
  const std::string other = *scratch_ / "two";
  ASSERT_EQ(run_rubble("run " + script() + " --threads 2 --out " + other).exit_code, 0);
  EXPECT_EQ(read_outputs(folder()), read_outputs(other));
  const Outcome verified = run_rubble("verify " + folder());
  EXPECT_EQ(verified.exit_code, 0) << verified.out << verified.err;
}

TEST_F(Falling, GoesOnAfterKillsToTheSameBytes) {
  const std::string cut = *scratch_ / "cut";
  const std::string options = " --threads 1 --checkpoint-every 0 ";
  run_rubble_and_signal("run " + script() + options + "--out " + cut,
                        [&] { return fs::exists(cut + "/unfinished/settle.checkpoint"); }, SIGKILL);
  ASSERT_TRUE(fs::exists(cut + "/unfinished/settle.track"));
  run_rubble_and_signal("resume " + cut + options,
                        [&] { return fs::exists(cut + "/unfinished/frames.txt"); }, SIGKILL);
  const Outcome resumed = run_rubble("resume " + cut + options);
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_EQ(read_outputs(folder()), read_outputs(cut));
}

TEST_F(Falling, AnotherMissionShowsItAgainAndAPileWithoutATrackDoesNot) {
  write_file(*scratch_ / "again.lua",
             "return rubble.mission { record_settling = { rate_hz = 5, to = 1 },\n"
             "  camera = { width = 32, height = 32 }, trajectory = { waypoints = {\n"
             "    { t = 0, position = { 3, 0, 1 }, look_at = { 0, 0, 1 } } } } }\n");
  const std::string again = *scratch_ / "again.lua", out = *scratch_ / "again";
  const Outcome run = run_rubble("render " + folder() + " --mission " + again + " --out " + out);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(read_outputs(out).at("track.bin"), read_outputs(folder()).at("track.bin"));
  EXPECT_EQ(read_poses(out + "/groundtruth.txt").size(), 6u + 1);
  const std::string still = *scratch_ / "still";
  ASSERT_EQ(run_rubble("settle " + script() + " --set record_settling=false --set outputs.track=false"
                       " --out " + still).exit_code, 0);
  const Outcome refused =
      run_rubble("render " + still + " --mission " + again + " --out " + (*scratch_ / "none"));
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("the run has no track of the settling pile"),
            std::string::npos) << refused.err;
}

TEST_F(Falling, SettleKeepsTheTrackWithAnOption) {
  const std::string pile = *scratch_ / "pile";
  const Outcome run = run_rubble("settle " + script() +
                                 " --set record_settling=false --set outputs.track=false --track --out " +
                                 pile);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* name : {"track.bin", "track.glb"})
    EXPECT_EQ(read_outputs(pile).at(name), read_outputs(folder()).at(name)) << name;
}

TEST(RecordSettling, TheBundledMissionRuns) {
  const ScratchFolder scratch;
  const Outcome run = run_rubble(
      "run scripts/record_settling.lua --set camera.width=64 --set camera.height=48 --set "
      "record_settling.rate_hz=2 --out " + (scratch / "a"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(read_poses(scratch / "a/groundtruth.txt").size(), 17u + 16u);
  for (const char* name : {"track.bin", "track.glb", "mission.mcap", "preview.png"})
    EXPECT_TRUE(read_outputs(scratch / "a").count(name)) << name;
}

TEST(RecordSettling, SaysWhatIsWrong) {
  const ScratchFolder scratch;
  const auto error_of = [&](const std::string& keys) {
    write_file(scratch / "m.lua", "return rubble.mission { pile = { layers = 1, pieces_per_layer = 2 },\n" +
                                      keys + "}\n");
    const Outcome run = run_rubble("run " + (scratch / "m.lua") + " --force --out " + (scratch / "a"));
    EXPECT_EQ(run.exit_code, 1) << keys;
    return run.err;
  };
  const auto expect = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  expect(error_of("record_settling = { from = 3, to = 2 }"),
         "m.lua:2: record_settling.to: nothing lies between: expected more than record_settling.from = 3");
  expect(error_of("record_settling = { position = { 1, 2, 3 } }"),
         "m.lua:2: record_settling.look_at: missing");
  expect(error_of("record_settling = 5"), "m.lua:2: record_settling: wrong type");
  expect(error_of("record_settling = { on = true, from = 5000 }"),
         "m.lua:2: record_settling.from: the pile rests by then: expected less than ");
}

TEST(RecordSettling, OfAPileThatRestsFromTheStartIsNothing) {
  const ScratchFolder scratch;
  write_file(scratch / "m.lua", R"(return rubble.mission { record_settling = { on = true, rate_hz = 5 },
  pile = { layers = 0, placed = { { box = { 1, 1, 0.5 }, position = { 0, 0, 0.25 }, fixed = true } } },
  camera = { width = 32, height = 24 }, outputs = { rawlog = false },
  trajectory = { rate_hz = 10, waypoints = { { position = { -3, 0, 1 }, look_at = { 0, 0, 0 } } } } })");
  const Outcome run = run_rubble("run " + (scratch / "m.lua") + " --out " + (scratch / "a"));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("warning: record_settling: the pile rests from the start"), std::string::npos) << run.err;
  EXPECT_EQ(read_poses(scratch / "a/groundtruth.txt").size(), 1u);
}

}  // namespace moving_test
}  // namespace rubble::testing
