// `rubble voids` on a settled pile.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "kernel/base/hash.h"
#include "tests/app/program.h"

namespace rubble::testing {
namespace voids_test {

namespace fs = std::filesystem;

class Voids : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new ScratchFolder;
    ASSERT_EQ(run_rubble("settle scripts/small.lua --out " + (*scratch_ / "a")).exit_code, 0);
  }
  static void TearDownTestSuite() { delete scratch_; }

  static inline ScratchFolder* scratch_ = nullptr;  // in it, `a`: a settled pile
};

TEST_F(Voids, MapsThePileOfARunTheSameEachTime) {
  const ScratchFolder& scratch = *scratch_;
  const std::string map = "voids " + (scratch / "a") + " --voxel 0.05 --radius 0.1 --out ";
  const Outcome first = run_rubble(map + (scratch / "b") + " --threads 1");
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_NE(first.out.find("0.100 m"), std::string::npos) << first.out;
  ASSERT_EQ(run_rubble(map + (scratch / "c") + " --threads 2").exit_code, 0);
  int files = 0;
  for (const auto& entry : fs::directory_iterator(scratch / "b")) {
    ++files;
    EXPECT_EQ(sha256_of_file(entry.path().string()),
              sha256_of_file(scratch / "c/" + entry.path().filename().string()))
        << entry.path().filename();
  }
  EXPECT_GE(files, 4);
  const auto json = nlohmann::json::parse(read_file(fs::path(scratch / "b") / "voids.json"));
  EXPECT_GT(json["solid_volume"].get<double>(), 0.1);
  EXPECT_EQ(json["robots"][0]["radius"], 0.1);
}

// Surfaces of two maps together would belong to neither.
TEST_F(Voids, ReplacesAnEarlierMapWhole) {
  const ScratchFolder& scratch = *scratch_;
  const std::string map = "voids " + (scratch / "a") + " --voxel 0.05 --radius 0.1 --out " + (scratch / "twice");
  const auto surfaces = [&] {
    int count = 0;
    for (const auto& entry : fs::directory_iterator(scratch / "twice")) count += entry.path().extension() == ".ply";
    return count;
  };
  ASSERT_EQ(run_rubble(map).exit_code, 0);
  ASSERT_GT(surfaces(), 1);
  write_file(scratch / "twice/void_of_mine.ply", "ply");
  write_file(scratch / "twice/notes.txt", "mine");
  ASSERT_EQ(run_rubble(map + " --surfaces 1 --force").exit_code, 0);
  EXPECT_EQ(surfaces(), 2) << "one of the map, and a file of another name";
  EXPECT_TRUE(fs::exists(scratch / "twice/notes.txt"));
}

TEST_F(Voids, RefusesWhatMemoryWouldNotHoldAndFoldersWithoutARun) {
  const ScratchFolder& scratch = *scratch_;
  const Outcome large = run_rubble("voids " + (scratch / "a") + " --voxel 0.002 --memory 0.1");
  EXPECT_EQ(large.exit_code, 1);
  EXPECT_NE(large.err.find("use voxels of"), std::string::npos) << large.err;
  EXPECT_FALSE(fs::exists(scratch / "a/voids"));
  const Outcome none = run_rubble("voids " + (scratch / "nowhere"));
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_NE(none.err.find("no such folder"), std::string::npos) << none.err;
}

TEST_F(Voids, ASignalStopsItCleanly) {
  const ScratchFolder& scratch = *scratch_;
  const Outcome stopped =
      run_rubble_and_signal("voids " + (scratch / "a") + " --voxel 0.01 --out " + (scratch / "stopped"),
                            [](const std::string& said) { return said.find("voids ...") != std::string::npos; }, SIGTERM);
  EXPECT_EQ(stopped.exit_code, 4) << stopped.err;
  EXPECT_NE(stopped.err.find("stopped by a signal"), std::string::npos) << stopped.err;
}

TEST(Cutaway, DrawsARunsPile) {
  const ScratchFolder scratch;
  write_file(scratch / "m.lua",
             "return rubble.mission { pile = { layers = 0, placed = { { box = { 2, 2, 1 }, position = "
             "{ 0, 0, 0.5 } } } } }\n");
  ASSERT_EQ(run_rubble("settle " + (scratch / "m.lua") + " --quiet --out " + (scratch / "run")).exit_code, 0);
  const Outcome drawn = run_rubble("cutaway " + (scratch / "run") + " --width 300 --out " + (scratch / "c.png"));
  EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_EQ(read_file(scratch / "c.png").substr(1, 3), "PNG");
  for (const char* name : {"c.gif", "c.bmp", "c"}) {
    const Outcome other = run_rubble("cutaway " + (scratch / "run") + " --out " + (scratch / name));
    EXPECT_EQ(other.exit_code, 1) << name;
    EXPECT_NE(other.err.find("expected a file that ends with .png, .jpg or .jpeg"), std::string::npos) << other.err;
    EXPECT_FALSE(fs::exists(scratch / name));
  }
  const Outcome beside = run_rubble("cutaway " + (scratch / "run") + " --y 3");
  EXPECT_EQ(beside.exit_code, 1);
  EXPECT_NE(beside.err.find("--y: the plane cuts no piece"), std::string::npos) << beside.err;
}

}  // namespace voids_test
}  // namespace rubble::testing
