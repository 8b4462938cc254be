// A program of ROS 1 that searches, by examples/search/ros1_agent.py.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/live/ros1_master.h"

namespace rubble::testing {
namespace ros1_search_test {

class LiveRos1Search : public WithRos1Master {
 protected:
  Outcome search(const std::string& agent, const std::string& out) const {
    return run_rubble("bench search scripts/search.lua --seeds 3 --json --agent \"" + agent + "\" --out " + (scratch_ / out),
                      settings_);
  }
  static nlohmann::json row_of(const Outcome& outcome) {
    const auto table = nlohmann::json::parse(outcome.out, nullptr, false);
    if (table.is_discarded()) return {{"not JSON", outcome.out + outcome.err}};
    return table.at("datasets").at(0);  // of one agent, by its name in the table
  }
};

TEST_F(LiveRos1Search, ObservationsAnswersAndReportsLoseNothingOnTheirWay) {
  const std::string agent = RUBBLE_PYTHON " " RUBBLE_SOURCE_DIR "/tests/live/short_search.py 12";
  nlohmann::json direct = row_of(search(agent, "direct"));
  const auto master = start_master();
  const auto searcher = start(RUBBLE_PYTHON " " RUBBLE_SOURCE_DIR "/tests/live/search_by_topics.py '" + agent + "'",
                              "searcher.txt");
  ASSERT_TRUE(eventually(30, [&] { return searcher->output().find("ready") != std::string::npos; }))
      << searcher->output();
  nlohmann::json by_topics = row_of(search(RUBBLE_SOURCE_DIR "/examples/search/ros1_agent.py", "topics"));
  ASSERT_TRUE(direct.contains("time_s")) << direct;
  EXPECT_EQ(direct["failed_share"], 0);
  EXPECT_EQ(direct["false_reports"], 2);
  EXPECT_NEAR(direct["time_s"].get<double>(), 12, 0.3) << "it said that it was done";
  EXPECT_GT(direct["path_m"], 3);
  EXPECT_EQ(direct, by_topics) << searcher->output();
  EXPECT_TRUE(eventually(10, [&] { return searcher->output().find("end {") != std::string::npos; })) << searcher->output();
}

// Nobody answers: it says so, and the search ends with what was found.
TEST_F(LiveRos1Search, WithoutACommandItGivesUp) {
  const auto master = start_master();
  const Outcome alone = search(RUBBLE_SOURCE_DIR "/examples/search/ros1_agent.py 1", "alone");
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_EQ(row_of(alone)["failed_share"], 1);
  EXPECT_NE(read_file(scratch_ / "alone/agent_3.log").find("nobody answered by /cmd_vel within 3 s"), std::string::npos);
}

}  // namespace ros1_search_test
}  // namespace rubble::testing
