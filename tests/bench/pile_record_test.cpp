// Records of judged piles: their file and the tables made of them.
#include "bench/equilibrium/pile_record.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "bench/equilibrium/record_file.h"
#include "bench/equilibrium/work.h"
#include "kernel/base/error.h"

namespace rubble {
namespace pile_record_test {

Record make_settled(const std::string& work, int seed, bool settled, double overlap) {
  return {{"work", work},           {"seed", seed},        {"settled", settled},
          {"moving", 0},            {"simulated_s", 20.0}, {"cpu_s", 2.0 * seed},
          {"overlap_max_mm", overlap}, {"over_5mm", overlap > 5 ? 1 : 0},
          {"bodies", 400},          {"off_1_percent", 4},  {"off_10_percent", 2},
          {"off_50_percent", seed == 2 ? 1 : 0}, {"residual_percent", 0.5},
          {"deepest_pair", {"#3 stud", "#8 door"}}};
}

TEST(PileRecord, ATableOfWorksHasTheWorstAndTheSumsOfItsSeeds) {
  const std::string table = make_work_table(
      {make_settled("a", 1, true, 0.5), make_settled("a", 2, false, 54.3),
       make_settled("b", 1, true, 1)}, true);
  EXPECT_NE(table.find("| a | 1 of 2 | 20.0 | 3.00 | 54.3 |"), std::string::npos) << table;
  EXPECT_NE(table.find("| b | 1 of 1 |"), std::string::npos) << table;
  EXPECT_NE(table.find("1.00, 0.50, 0.12"), std::string::npos) << table;  // of 800 pieces
}

TEST(PileRecord, ATableOfPilesNamesTheDeepestPair) {
  const std::string table = make_pile_table({make_settled("a", 2, false, 54.3)}, true);
  EXPECT_NE(table.find("| NO |"), std::string::npos) << table;
  EXPECT_NE(table.find("#3 stud, #8 door"), std::string::npos) << table;
}

TEST(RecordFile, GoesOnAfterALineThatWasCutShort) {
  const std::string path = ::testing::TempDir() + "/records.jsonl";
  std::filesystem::remove(path);
  RecordFile(path).add(make_settled("a", 1, true, 0.5));
  std::ofstream(path, std::ios::app) << "{\"work\": \"a\", \"se";
  EXPECT_EQ(RecordFile(path).find("a", 2), nullptr);
  RecordFile(path).add(make_settled("a", 2, true, 0.7));
  const RecordFile file(path);
  ASSERT_NE(file.find("a", 1), nullptr);
  EXPECT_EQ(file.find("a", 1)->at("overlap_max_mm"), 0.5);
  ASSERT_NE(file.find("a", 2), nullptr);
  EXPECT_EQ(file.find("a", 2)->at("overlap_max_mm"), 0.7);
}

TEST(Work, GroupsExpandAndUnknownNamesAreMistakes) {
  EXPECT_EQ(expand_work_names({"bridge"}), std::vector<std::string>{"bridge"});
  EXPECT_EQ(expand_work_names({"collapse"}).size(), 11U);
  EXPECT_EQ(expand_work_names({"x/mine.lua"}), std::vector<std::string>{"x/mine.lua"});
  EXPECT_THROW(expand_work_names({"nonsense"}), InputError);
}

}  // namespace pile_record_test
}  // namespace rubble
