// Buildings that collapse, through the whole program: verified, made again, interrupted, recorded as they fall.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/app/tiny_run.h"

namespace rubble::testing {
namespace building_run_test {

namespace fs = std::filesystem;

// A shed whose front wall goes away under a floor of timber and a slab.
constexpr const char* kPlan = R"(storey 2.4
storey 2.2
wall 0 0 5 0 0.24 brick name=front
wall 5 0 5 4 0.24 brick
wall 5 4 0 4 0.24 brick
wall 0 4 0 0 0.24 brick
door 1 0 2 0 2.0
storeys 0 0
joists 0 0 5 4 0.2
storeys 1 1
slab -0.12 -0.12 5.12 4.12 0.18 concrete
)";

constexpr const char* kMission = R"(return rubble.mission {
  seed = 5,
  pile = rubble.building {
    plan = rubble.read_plan("shed.txt"), piece = 1.2,
    cause = { removed = { { storey = 0, part = "front" } } },
  },
  settle = { final_time_limit = 60 },
  camera = { width = 48, height = 36, quality = "draft" },
  trajectory = { rate_hz = 2, waypoints = { { position = { 2, -9, 3 }, look_at = { 2, 2, 1.5 } },
                                            { t = 0.5, position = { 3, -9, 3 }, look_at = { 2, 2, 1.5 } } } },
  outputs = { frames = true },
})";

constexpr const char* kCause = R"(cause = { removed = { { storey = 0, part = "front" } } },)";

class BuildingRun : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directory(folder_ / "source");
    write_file(folder_ / "source/shed.txt", kPlan);
    write_file(folder_ / "source/m.lua", kMission);
  }
  std::string run(const std::string& name, const std::string& more = "") const {
    return "run " + (folder_ / "source/m.lua") + " --quiet --out " + (folder_ / name) + " " + more;
  }
  ScratchFolder folder_;
};

TEST_F(BuildingRun, IsTheSameWhenItIsVerifiedAndMadeAgainWithoutItsPlan) {
  const Outcome first = run_rubble(run("a", "--threads 1"));
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const nlohmann::ordered_json pile = read_manifest(folder_ / "a")["pile"];
  EXPECT_TRUE(pile["settled"].get<bool>());
  EXPECT_GT(pile["pieces"].get<int>(), 50);
  // It fell: without the cause it does not, and the manifest tells them apart.
  alter(folder_ / "source/m.lua", kCause, "");
  const Outcome standing =
      run_rubble("settle " + (folder_ / "source/m.lua") + " --quiet --out " + (folder_ / "standing"));
  ASSERT_EQ(standing.exit_code, 0) << standing.err;
  EXPECT_NE(read_state_hash(folder_ / "standing"), read_state_hash(folder_ / "a"));

  fs::remove(folder_ / "source/shed.txt");
  const Outcome verify = run_rubble("verify --quiet --threads 2 " + (folder_ / "a"));
  EXPECT_EQ(verify.exit_code, 0) << verify.out << verify.err;
  const Outcome remake = run_rubble("remake --quiet " + (folder_ / "a/manifest.json") + " --out " + (folder_ / "b"));
  ASSERT_EQ(remake.exit_code, 0) << remake.out << remake.err;
  EXPECT_EQ(reproducible(folder_ / "b"), reproducible(folder_ / "a"));
  for (const auto& [name, hash] : read_outputs(folder_ / "a"))
    EXPECT_EQ(read_file(folder_ / ("a/" + name)), read_file(folder_ / ("b/" + name))) << name;
}

// A collapse that is interrupted begins anew, and nobody can tell.
TEST_F(BuildingRun, GoesOnAfterItWasStoppedWhileItFell) {
  ASSERT_EQ(run_rubble(run("whole", "--set record_settling=true")).exit_code, 0);
  // On a busy machine it may have come to rest before the signal is sent: then another is stopped.
  std::string part;
  Outcome stopped;
  for (int attempt = 0; attempt < 10; ++attempt) {
    part = folder_ / ("part" + std::to_string(attempt));
    stopped = run_rubble_and_signal(run("part" + std::to_string(attempt), "--set record_settling=true"),
                                    [&] { return fs::exists(part + "/unfinished/run.json"); }, SIGTERM);
    if (stopped.exit_code == 4 && !fs::exists(part + "/pile.bin")) break;
  }
  ASSERT_EQ(stopped.exit_code, 4) << stopped.err;
  EXPECT_FALSE(fs::exists(part + "/pile.bin")) << "it had come to rest before it was stopped";
  fs::remove(folder_ / "source/shed.txt");
  const Outcome resumed = run_rubble("resume " + part);
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_EQ(reproducible(part), reproducible(folder_ / "whole"));
  for (const auto& [name, hash] : read_outputs(folder_ / "whole"))
    EXPECT_EQ(read_file(part + "/" + name), read_file(folder_ / ("whole/" + name))) << name;
  EXPECT_FALSE(fs::exists(part + "/unfinished"));
}

TEST_F(BuildingRun, SaysWhichPartOfThePlanDoesNotStand) {
  write_file(folder_ / "source/shed.txt", "storey 2.4\nwall 0 0 5 0 0.24 brick\nslab 0 0 5 4 0.18 concrete\n");
  alter(folder_ / "source/m.lua", kCause, "");
  const Outcome refused = run_rubble(run("a"));
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_IN("shed.txt:2", refused.err);  // the wall, which nothing holds upright
  EXPECT_FALSE(fs::exists(folder_ / "a/pile.bin"));
}

}  // namespace building_run_test
}  // namespace rubble::testing
