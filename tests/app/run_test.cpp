// The main job as a user sees it: a mission in, a dataset out.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <filesystem>

#include "kernel/base/hash.h"
#include "tests/app/program.h"

namespace rubble::testing {
namespace run_test {

namespace fs = std::filesystem;

const char* const kFiles[] = {"mission.rawlog", "mission.bag",     "pile.stl",
                              "pile.bin",       "groundtruth.txt", "preview.png"};

// Two runs of one mission, by one thread and by two.
class TwoRuns : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new ScratchFolder;
    for (const char* threads : {"1", "2"}) {
      const Outcome run = run_rubble("run scripts/small.lua --threads " + std::string(threads) +
                                     " --out " + folder(threads));
      ASSERT_EQ(run.exit_code, 0) << run.err;
    }
  }
  static void TearDownTestSuite() { delete scratch_; }
  static std::string folder(const char* threads) { return *scratch_ / threads; }

  static inline ScratchFolder* scratch_ = nullptr;
};

TEST_F(TwoRuns, LeaveEveryFileWithTheHashThatTheManifestNames) {
  const auto outputs = read_outputs(folder("1"));
  for (const char* name : kFiles) {
    ASSERT_TRUE(outputs.count(name)) << name;
    EXPECT_EQ(outputs.at(name), sha256_of_file(folder("1") + "/" + name)) << name;
  }
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(folder("1"))) {
    ++files;
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
  }
  EXPECT_EQ(files, outputs.size() + 1) << "something lies there that the manifest does not name";
}

TEST_F(TwoRuns, GiveTheSameBytesForAnyNumberOfThreads) {
  EXPECT_EQ(read_state_hash(folder("1")), read_state_hash(folder("2")));
  EXPECT_EQ(read_outputs(folder("1")), read_outputs(folder("2")));
}

TEST_F(TwoRuns, GiveAnotherPileForAnotherSeed) {
  const std::string other = *scratch_ / "other";
  ASSERT_EQ(run_rubble("settle scripts/small.lua --seed 2 --out " + other).exit_code, 0);
  EXPECT_NE(read_state_hash(folder("1")), read_state_hash(other));
}

TEST(Run, MeasuresTheVolumeOfBoxes) {
  const ScratchFolder scratch;
  write_file(scratch / "boxes.lua",
             "return rubble.mission { pile = { layers = 0, placed = {\n"
             "  { box = { 1, 2, 0.5 }, position = { 0, 0, 0.25 } },\n"
             "  { box = { 1, 1, 1 }, position = { 5, 0, 0.5 } } } } }\n");
  const Outcome run = run_rubble("settle " + (scratch / "boxes.lua") + " --out " + (scratch / "a"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto manifest = nlohmann::json::parse(read_file(scratch / "a/manifest.json"));
  EXPECT_NEAR(double(manifest.at("metrics").at("piece_volume_m3")), 2, 1e-9);
}

TEST(Run, SaysWhenThePileDidNotSettle) {
  const ScratchFolder scratch;
  const Outcome run = run_rubble(
      "settle scripts/small.lua --set settle.layer_time_limit=0.2 --set "
      "settle.final_time_limit=0.2 --out " +
      (scratch / "a"));
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_NE(run.err.find("did not settle"), std::string::npos) << run.err;
  EXPECT_TRUE(fs::exists(scratch / "a/pile.bin")) << "what was computed is kept";
}

TEST(Run, SaysWhatLeftTheWorldAndWhatOverlapsFromTheStart) {
  const ScratchFolder scratch;
  write_file(scratch / "boxes.lua",
             "return rubble.mission { settle = { lost_beyond = 10 }, pile = { layers = 0, placed = {\n"
             "  { box = { 1, 1, 1 }, position = { 0, 0, 0.5 } },\n"
             "  { box = { 1, 1, 1 }, position = { 0.96, 0, 0.5 } },\n"
             "  { box = { 1, 1, 1 }, position = { 20, 0, 0.5 }, fixed = false } } } }\n");
  const Outcome run = run_rubble("settle " + (scratch / "boxes.lua") + " --out " + (scratch / "a"));
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_NE(run.err.find("1 of 3 pieces left the world"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("piece 2, last seen with its origin at {20.00, "), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("reach 40 mm into each other from the start"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("pile.placed[1] ("), std::string::npos) << run.err;
  EXPECT_EQ(run.err.find("layer 0 of 0"), std::string::npos) << run.err;
  EXPECT_TRUE(fs::exists(scratch / "a/pile.bin")) << "what was computed is kept";
}

// Whoever places a mode did not place its pieces.
TEST(Run, ModesOfCollapseWarnOfNothing) {
  const ScratchFolder scratch;
  for (const char* mode : {"lean_to", "cantilever", "v_shape", "a_frame", "pancake", "inclined", "lean_over", "curtain", "culvert"}) {
    write_file(scratch / "mode.lua", std::string("return rubble.mission { seed = 4, pile = rubble.collapse.") + mode + " {} }\n");
    const Outcome run = run_rubble("settle " + (scratch / "mode.lua") + " --quiet --set outputs.stl=false --out " + (scratch / mode));
    EXPECT_EQ(run.exit_code, 0) << mode << run.err;
    EXPECT_EQ(run.err.find("warning"), std::string::npos) << mode << run.err;
  }
  const Outcome first = run_rubble("settle scripts/first_pile.lua --quiet --set pile.layers=0 --set outputs.stl=false --out " + (scratch / "first"));
  EXPECT_EQ(first.exit_code, 0) << first.err;
  EXPECT_EQ(first.err.find("warning"), std::string::npos) << first.err;
}

// A bundled script, made small: what users copy from must work.
void run_script(const fs::path& path) {
  const ScratchFolder scratch;
  const bool several = read_file(path.string()).find("cameras = ") != std::string::npos;  // each has a size of its own
  const Outcome run = run_rubble(
      "run '" + path.string() + "' --out " + (scratch / "a") + " --set pile.layers=1 --set pile.pieces_per_layer=12" +
      (several ? "" : " --set camera.width=64 --set camera.height=48") +
      " --set trajectory.rate_hz=1 --set settle.final_time_limit=30");
  EXPECT_EQ(run.exit_code, 0) << path << "\n" << run.err;
}

void run_scripts_of(const std::string& folder) {
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(RUBBLE_SOURCE_DIR "/" + folder)) {
    const fs::path path = entry.path();
    if (path.extension() != ".lua" || read_file(path.string()).find("rubble.mission") == std::string::npos) continue;
    if (path.stem() == "demo") continue;  // its robot stands where the ruin of the whole mission leaves room: test Demo
    run_script(path);
    EXPECT_EQ(run_rubble("check '" + path.string() + "'").exit_code, 0) << path;
    ++count;
  }
  EXPECT_GE(count, 3u);
}

TEST(NightlyRun, RunsEveryBundledScript) { run_scripts_of("scripts"); }
TEST(NightlyRun, RunsEveryRobotScript) { run_scripts_of("scripts/robots"); }
TEST(NightlyRun, RunsEveryCollapseMode) { run_scripts_of("scripts/collapse"); }
TEST(NightlyRun, SettlesThePublishedDemonstrationOfOtherSeeds) {
  for (const char* seed : {"2", "3", "4", "5"}) {
    const ScratchFolder scratch;
    const Outcome run = run_rubble("settle scripts/paper/exterior.lua --seed " + std::string(seed) +
                                   " --out " + (scratch / "pile"));
    EXPECT_EQ(run.exit_code, 0) << seed << ": " << run.err;
  }
}
TEST(NightlyRun, RunsThePublishedDemonstration) { run_scripts_of("scripts/paper"); }

// Three of them in every run of the tests: all outputs; a collapse, its voids and a planned path;
// terrain. `make test-nightly` runs all.
TEST(Run, RunsBundledScripts) {
  for (const char* name : {"outputs", "deepest_void", "terrain"})
    run_script(std::string(RUBBLE_SOURCE_DIR "/scripts/") + name + ".lua");
}

TEST(Run, RefusesAFolderThatIsNotEmpty) {
  const ScratchFolder scratch;
  write_file(scratch / "mine.txt", "precious");
  const std::string out = " --out " + scratch.path().string();
  const Outcome refused = run_rubble("settle scripts/small.lua" + out);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("--force"), std::string::npos) << refused.err;
  EXPECT_EQ(run_rubble("settle scripts/small.lua --force" + out).exit_code, 0);
  EXPECT_EQ(read_file(scratch / "mine.txt"), "precious");
}

// Lists of an unfinished run and of a manifest, made by somebody who means harm.
TEST(Run, ForceRemovesNothingOutsideNorThroughLinks) {
  const ScratchFolder scratch;
  const auto at = [&](const std::string& name) { return scratch / name; };
  fs::create_directories(at("run/unfinished"));
  fs::create_directories(at("run/sub"));
  fs::create_directories(at("elsewhere"));
  for (const char* name : {"x", "run/mine.txt", "elsewhere/y", "run/frames_of_mine.png"})
    write_file(at(name), "precious");
  fs::create_directory_symlink(at("elsewhere"), at("run/frames"));
  fs::create_directory_symlink(at("elsewhere"), at("run/link"));
  write_file(at("run/unfinished/run.json"), "{}");
  write_file(at("run/unfinished/files.txt"),
             "sub/../../x\n../x\nmine.txt\nlink/y\nframes/y\nframes\n" + at("x") + "\n\n");
  write_file(at("run/manifest.json"),
             "{\"outputs\": {\"sub/../../x\": \"0\", \"link/y\": \"0\", \"frames/y\": \"0\", "
             "\"mine.txt\": \"0\", \"\": \"0\"}}");
  const Outcome run = run_rubble("settle scripts/small.lua --force --out " + at("run"));
  EXPECT_EQ(run.exit_code, 1) << "`frames` is not ours: " << run.err;
  EXPECT_NE(run.err.find("frames"), std::string::npos) << run.err;
  for (const char* name : {"x", "run/mine.txt", "elsewhere/y", "run/frames_of_mine.png"})
    EXPECT_EQ(read_file(at(name)), "precious") << name;
  EXPECT_TRUE(fs::is_symlink(at("run/frames")));
  fs::remove(at("run/frames"));
  EXPECT_EQ(run_rubble("settle scripts/small.lua --force --out " + at("run")).exit_code, 0);
  EXPECT_EQ(read_file(at("run/mine.txt")), "precious");
}

// A folder that happens to have the name of ours.
TEST(Run, LeavesAFolderCalledUnfinishedThatIsNotOurs) {
  const ScratchFolder scratch;
  fs::create_directories(scratch / "run/unfinished");
  write_file(scratch / "run/unfinished/novel.txt", "precious");
  for (const char* force : {"", " --force"}) {
    run_rubble("settle scripts/small.lua --out " + (scratch / "run") + force);
    EXPECT_EQ(read_file(scratch / "run/unfinished/novel.txt"), "precious") << force;
  }
}

TEST(Run, ForceKeepsForeignFilesAmongTheRecordings) {
  const ScratchFolder scratch;
  write_file(scratch / "tiny.lua", kTinyMission);
  const std::string command = "run " + (scratch / "tiny.lua") + " --quiet --set camera.quality=draft --set outputs.tum=true --out " +
                              (scratch / "run");
  ASSERT_EQ(run_rubble(command).exit_code, 0);
  ASSERT_TRUE(fs::exists(scratch / "run/tum/rgb.txt"));
  write_file(scratch / "run/tum/notes.txt", "precious");
  const Outcome again = run_rubble(command + " --force");
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_NE(again.err.find("notes.txt"), std::string::npos) << again.err;
  EXPECT_EQ(read_file(scratch / "run/tum/notes.txt"), "precious");
}

// A terminal that closes.
TEST(Run, HangingUpStopsAsPolitelyAsCtrlC) {
  const ScratchFolder scratch;
  const Outcome stopped = run_rubble_and_signal(
      "run scripts/first_pile.lua --quiet --out " + (scratch / "run"),
      [&] { return fs::exists(scratch / "run/unfinished/run.json"); }, SIGHUP);
  EXPECT_EQ(stopped.exit_code, 4) << stopped.err;
  EXPECT_NE(stopped.err.find("`rubble resume"), std::string::npos) << stopped.err;
}

// A file-size limit is a disk that is full: writes past it fail.
TEST(Run, LeavesNothingHalfWrittenWhenTheDiskIsFull) {
  const ScratchFolder scratch;
  const Outcome run =
      run_rubble("run scripts/small.lua --out " + (scratch / "a"), "ulimit -f 64 &&");
  EXPECT_EQ(run.exit_code, 2) << run.err;
  EXPECT_NE(run.err.find(scratch / "a/"), std::string::npos) << run.err;
  EXPECT_FALSE(fs::exists(scratch / "a/mission.bag"));
  EXPECT_FALSE(fs::exists(scratch / "a/manifest.json"));
  for (const auto& entry : fs::directory_iterator(scratch / "a"))
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
}

}  // namespace run_test
}  // namespace rubble::testing
