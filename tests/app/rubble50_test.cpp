// Rubble-50: the missions are those that the tool makes, sound, and settle to the expected piles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "tests/app/program.h"

namespace rubble::testing {
namespace {

namespace fs = std::filesystem;
const std::string kRoot = RUBBLE_SOURCE_DIR;

std::vector<std::string> missions() {
  std::vector<std::string> names;
  for (const auto& file : fs::directory_iterator(kRoot + "/scripts/rubble50"))
    if (const std::string name = file.path().filename().string(); name[0] <= '9') names.push_back(name);
  std::sort(names.begin(), names.end());
  return names;
}

TEST(Rubble50, EveryMissionIsSoundAndMadeByItsTool) {
  const ScratchFolder scratch;
  fs::create_directories(scratch / "docs");
  fs::create_directories(scratch / "scripts/rubble50");
  fs::copy(kRoot + "/docs/rubble50.md", scratch / "docs/rubble50.md");
  fs::copy(kRoot + "/scripts/rubble50/suite.golden.json", scratch / "scripts/rubble50/suite.golden.json");
  ASSERT_EQ(std::system(("'" + kRoot + "/tools/rubble50.py' '" + scratch.path().string() + "'").c_str()), 0);
  EXPECT_EQ(read_file(scratch / "docs/rubble50.md"), read_file(kRoot + "/docs/rubble50.md"));
  EXPECT_EQ(read_file(scratch / "scripts/rubble50/suite.lua"), read_file(kRoot + "/scripts/rubble50/suite.lua"));
  const std::vector<std::string> names = missions();
  ASSERT_EQ(names.size(), 50u);
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(read_file(kRoot + "/scripts/rubble50/" + names[i]), read_file(scratch / "scripts/rubble50" + ("/" + names[i])));
    if (i % 6 != 0) continue;  // every structure or its neighbour, every condition and carrier
    const Outcome checked = run_rubble("check scripts/rubble50/" + names[i]);
    EXPECT_EQ(checked.exit_code, 0) << names[i] << "\n" << checked.err;
    EXPECT_NE(checked.out.find("\"seed\": " + std::to_string(i + 1)), std::string::npos) << names[i];
  }
}

TEST(NightlyRubble50, PilesHaveTheExpectedHashes) {
  const ScratchFolder scratch;
  const Outcome suite = run_rubble("suite scripts/rubble50/suite.lua --quiet --out " + (scratch / "out"));
  EXPECT_EQ(suite.exit_code, 0) << suite.out << suite.err;
  EXPECT_NE(suite.out.find("50 of 50 passed"), std::string::npos) << suite.out;
}

}  // namespace
}  // namespace rubble::testing
