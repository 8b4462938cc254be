// The shards of a batch, spread by engines that we did not write: the index is that of one process.
// Nightly: it starts a Slurm of one node, which takes root and a quarter of a minute.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "tests/app/program.h"

namespace rubble::testing {
namespace cluster_test {

class Cluster : public ::testing::Test {
 protected:
  void SetUp() override {
    write_file(scratch / "tiny.lua", kTinyMission);
    const Outcome one = run_rubble("batch " + arguments("one"));
    ASSERT_EQ(one.exit_code, 0) << one.err;
  }

  std::string arguments(const std::string& out) {
    return (scratch / "tiny.lua") + " --seeds 1..7 --pile-only --out " + (scratch / out);
  }
  std::string index(const std::string& out) { return read_file(scratch / (out + "/index.csv")); }

  // What the command printed, for the message when it fails.
  std::string expect_to_work(const std::string& command) {
    const std::string log = scratch / "log";
    EXPECT_EQ(std::system((command + " > '" + log + "' 2>&1").c_str()), 0) << read_file(log);
    return read_file(log);
  }

  ScratchFolder scratch;
};

TEST_F(Cluster, SlurmSpreadsTheShardsOfAnArray) {
  if (geteuid() != 0) GTEST_SKIP() << "slurmd asks for root";
  expect_to_work(
      "RUBBLE='" RUBBLE_PROGRAM "' bash '" RUBBLE_SOURCE_DIR "/tests/app/one_node_slurm.sh' '" +
      (scratch / "slurm") + "' 3 '" RUBBLE_SOURCE_DIR "/examples/cluster/slurm_array.sh' " +
      arguments("spread"));
  EXPECT_EQ(index("spread"), index("one"));
  EXPECT_NE(index("spread").find("\n7,done,"), std::string::npos);
}

// The line of docs/how_to/batch.md.
TEST_F(Cluster, GnuParallelSpreadsTheShards) {
  expect_to_work("bash -c \"parallel '" RUBBLE_PROGRAM "' batch " + arguments("spread") +
                 " --jobs 1 --quiet --shard {}/4 ::: {1..4}\"");
  EXPECT_EQ(index("spread"), index("one"));
  EXPECT_NE(index("spread").find("\n7,done,"), std::string::npos);
}

}  // namespace cluster_test
}  // namespace rubble::testing
