// The bench as a person runs it.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "bench/equilibrium/work.h"
#include "tests/base/environment.h"

namespace rubble {
namespace equilibrium_bench_test {

namespace fs = std::filesystem;
using testing::Environment;

struct Outcome {
  int exit_code = -1;
  std::string out;
};

std::string read_file(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

Outcome run(const std::string& command) {
  const fs::path out = ::testing::TempDir() + "/equilibrium.out";
  const int status = std::system((command + " > " + out.string() + " 2> /dev/null").c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(out)};
}

Outcome run_bench(const std::string& arguments) {
  return run(std::string(RUBBLE_EQUILIBRIUM_BENCH) + " " + arguments);
}

fs::path beside_bench(const std::string& name) {
  return fs::path(RUBBLE_EQUILIBRIUM_BENCH).parent_path() / name;
}

// In this pile a sheet of plywood lay between the ground and what fell on it, and was shot through the ground at
// 54 m/s.
TEST(EquilibriumBench, NothingIsShotThroughTheGround) {
  const Outcome settled = run_bench("--one --work mixed --seeds 11 --pile-only");
  ASSERT_EQ(settled.exit_code, 0) << settled.out;
  EXPECT_EQ(nlohmann::json::parse(settled.out).at("lost"), 0);
}

// With as few substeps as other heaps these shook when nothing damped them, and drifted by 11 to 49 mm.
TEST(EquilibriumBench, HeapsOfSheetsStayInPlace) {
  for (const char* seed : {"438", "476", "485"}) {
    const Outcome settled = run_bench(std::string("--one --no-lp --work sheets --seeds ") + seed);
    ASSERT_EQ(settled.exit_code, 0) << settled.out;
    const auto record = nlohmann::json::parse(settled.out);
    EXPECT_TRUE(record.at("settled").get<bool>()) << seed;
    EXPECT_LT(record.at("drift_max_mm").get<double>(), 5) << seed;
  }
}

TEST(EquilibriumBench, JudgesAPileAndTheSamePileFromItsFile) {
  const std::string mission = RUBBLE_SOURCE_DIR "/scripts/small.lua";
  const Outcome settled = run_bench("--one --work " + mission + " --seeds 1");
  ASSERT_EQ(settled.exit_code, 0) << settled.out;
  const auto record = nlohmann::json::parse(settled.out);
  EXPECT_EQ(record.at("bodies"), 40);
  EXPECT_TRUE(record.at("optimal").get<bool>());
  EXPECT_LT(record.at("residual_percent").get<double>(), 5);
  const fs::path folder = ::testing::TempDir() + "/equilibrium_run";
  fs::remove_all(folder);
  ASSERT_EQ(run(beside_bench("rubble").string() + " settle " + mission + " --seed 1 --quiet --out " +
                folder.string()).exit_code, 0);
  const auto saved = nlohmann::json::parse(run_bench("--pile " + folder.string()).out);
  for (const char* key : {"state_hash", "overlap_max_mm", "contact_points", "residual_percent"})
    EXPECT_EQ(saved.at(key), record.at(key)) << key;
  fs::remove_all(folder);
}

TEST(EquilibriumBench, ContinuesAListFromItsRecords) {
  const fs::path records = ::testing::TempDir() + "/equilibrium.jsonl";
  fs::remove(records);
  const std::string mission = RUBBLE_SOURCE_DIR "/scripts/small.lua";
  const std::string list = "--work " + mission + " --pile-only --markdown --out " + records.string();
  const Outcome first = run_bench(list + " --seeds 1..2 --jobs 2");
  ASSERT_EQ(first.exit_code, 0) << first.out;
  const std::string before = read_file(records);
  EXPECT_EQ(std::count(before.begin(), before.end(), '\n'), 2);
  EXPECT_EQ(run_bench(list + " --seeds 1..2").out, first.out);  // nothing is run again
  EXPECT_EQ(read_file(records), before);
  run_bench(list + " --seeds 1..3");
  const std::string after = read_file(records);
  EXPECT_EQ(after.compare(0, before.size(), before), 0);
  EXPECT_EQ(std::count(after.begin(), after.end(), '\n'), 3);
}

TEST(EquilibriumBench, SaysWhatIsWrong) {
  EXPECT_EQ(run_bench("--work nonsense").exit_code, 1);
  EXPECT_EQ(run_bench("--work w1 --seeds x").exit_code, 1);
  EXPECT_EQ(run_bench("--pile /nonexistent").exit_code, 1);
}

// Each mission of the list is one that the program reads, with a pile that fits its box.
TEST(EquilibriumBench, EveryMissionOfTheListCanBeGenerated) {
  const Environment assets("RUBBLE_ASSETS", beside_bench("assets"));
  for (const std::string& name : expand_work_names({"packs", "large", "collapse", "demo"})) {
    const Work work = load_work(name, 1);
    EXPECT_GT(work.pile.placed.size() + work.pile.layers.size(), 0U) << name;
  }
}

}  // namespace equilibrium_bench_test
}  // namespace rubble
