// Many seeds: the same table whatever was killed, sharded or run at once; failures stay alone.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "tests/app/program.h"
#include "tests/base/slowdown.h"

namespace rubble::testing {
namespace batch_test {

namespace fs = std::filesystem;

#define EXPECT_IN(part, text) EXPECT_NE((text).find(part), std::string::npos) << (text)

// The process of which one argument is this.
pid_t find_process_with(const std::string& argument) {
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator("/proc", failed)) {
    const std::string line = read_file(entry.path() / "cmdline");
    if (line.find('\0' + argument + '\0') != std::string::npos)
      return std::atoi(entry.path().filename().c_str());
  }
  return -1;
}

class Batch : public ::testing::Test {
 protected:
  void SetUp() override { write_file(scratch / "tiny.lua", kTinyMission); }

  // Piles alone: that is where the seeds differ.
  std::string batch(const std::string& out, const std::string& seeds,
                    const std::string& more = "") {
    return "batch " + (scratch / "tiny.lua") + " --pile-only --set outputs.stl=false --seeds " +
           seeds + " --out " + (scratch / out) + " " + more;
  }
  std::string index(const std::string& out) { return read_file(scratch / (out + "/index.csv")); }

  ScratchFolder scratch;
};

TEST_F(Batch, GivesTheSameIndexWhateverTheJobsTheShardsAndTheKills) {
  const Outcome whole = run_rubble(batch("whole", "1..6", "--jobs 1"));
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_IN("6 runs to do, 0 done before; estimated ", whole.err);
  EXPECT_IN("\n6,done,", index("whole"));
  EXPECT_EQ(index("whole").rfind("seed,status,state_hash,bytes,", 0), 0u);

  run_rubble_and_signal(batch("parts", "1..6", "--shard 3/3"), 0.6, SIGKILL);
  const Outcome stopped =
      run_rubble_and_signal(batch("parts", "1..6", "--shard 1/3"), 0.6, SIGTERM);
  // 143: it had not come as far as to listen.
  EXPECT_TRUE(stopped.exit_code == 4 || stopped.exit_code == 0 || stopped.exit_code == 143)
      << stopped.exit_code << stopped.err;
  for (const char* shard : {"3/3", "1/3"})
    EXPECT_EQ(
        run_rubble(batch("parts", "1..6", std::string("--jobs 2 --shard ") + shard)).exit_code, 0);
  EXPECT_NE(index("parts"), index("whole"));
  EXPECT_EQ(run_rubble(batch("parts", "1..6", "--shard 2/3")).exit_code, 0);
  EXPECT_EQ(index("parts"), index("whole"));

  const Outcome again = run_rubble(batch("whole", "1..6"));
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_IN("0 runs to do, 6 done before", again.err);
}

// A job that the kernel kills cannot say so itself.
TEST_F(Batch, TheLogOfAKilledJobNamesTheSignal) {
  // SIGXCPU is for the job, which computes; the batch itself needs little CPU time.
  const std::string cpu_seconds = std::to_string(2 * kSlowdown);
  write_file(scratch / "long.lua",
             "return rubble.mission { seed = 1, pile = { layers = 20, pieces_per_layer = 300 } }");
  const Outcome run = run_rubble("batch " + (scratch / "long.lua") +
                                     " --pile-only --seeds 1 --jobs 1 --out " + (scratch / "a"),
                                 "ulimit -S -t " + cpu_seconds + " && ulimit -c 0 &&");
  EXPECT_EQ(run.exit_code, 2) << run.err;
  EXPECT_IN("killed by signal 24 (CPU time limit exceeded)", run.err);
  EXPECT_IN("killed by signal 24", read_file(scratch / "a/failed/seed_1.log"));
}

// Both end well, whoever makes a seed.
TEST_F(Batch, BegunTwiceFailsNoSeed) {
  Outcome first;
  std::thread other([&] { first = run_rubble(batch("a", "1..4", "--jobs 1")); });
  const Outcome second = run_rubble(batch("a", "1..4", "--jobs 1"));
  other.join();
  EXPECT_EQ(first.exit_code, 0) << first.err;
  EXPECT_EQ(second.exit_code, 0) << second.err;
  EXPECT_FALSE(fs::exists(scratch / "a/failed/seed_1.log"));
  ASSERT_EQ(run_rubble(batch("a", "1..4")).exit_code, 0);
  for (const char* seed : {"\n1,done,", "\n2,done,", "\n3,done,", "\n4,done,"})
    EXPECT_IN(seed, index("a"));
}

// Somebody suspends a job (kill -STOP): it is named, and Ctrl-C still ends the batch.
TEST_F(Batch, ASuspendedJobIsNamedAndStopped) {
  write_file(scratch / "long.lua",
             "return rubble.mission { seed = 1, pile = { layers = 20, pieces_per_layer = 300 } }");
  const auto begun = [&] { return fs::exists(scratch / "a/seed_1/unfinished/run.json"); };
  std::thread suspender([&] {
    for (int i = 0; i < 3000 && !begun(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const pid_t job = find_process_with(scratch / "a/seed_1");
    EXPECT_GT(job, 0);
    if (job > 0) kill(job, SIGSTOP);
  });
  const Outcome run = run_rubble_and_signal(
      "batch " + (scratch / "long.lua") + " --pile-only --seeds 1 --jobs 1 --out " + (scratch / "a"),
      [](const std::string& said) { return said.find("was suspended") != std::string::npos; },
      SIGTERM);
  if (suspender.joinable()) suspender.join();
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_IN("was suspended by signal 19", run.err);
}

TEST_F(Batch, KeepsAFailureToItself) {
  fs::create_directories(scratch / "a");
  write_file(scratch / "a/seed_2", "taken by something else");
  const Outcome batch_run = run_rubble(batch("a", "1..3"));
  EXPECT_EQ(batch_run.exit_code, 2) << batch_run.err;
  EXPECT_IN("seed 2 failed", batch_run.err);
  EXPECT_IN("is not a folder", batch_run.err);
  EXPECT_IN("is not a folder", read_file(scratch / "a/failed/seed_2.log"));
  EXPECT_IN("\n2,failed,,", index("a"));
  EXPECT_IN("\n3,done,", index("a"));
  fs::remove(scratch / "a/seed_2");
  EXPECT_EQ(run_rubble(batch("a", "1..3")).exit_code, 0);
  EXPECT_FALSE(fs::exists(scratch / "a/failed/seed_2.log"));
  EXPECT_IN("\n2,done,", index("a"));
}

// A figure changed by hand, another seed's dataset, another seed's pile, and a manifest that is none.
TEST_F(Batch, TakesNoFiguresFromWhatWasAltered) {
  ASSERT_EQ(run_rubble(batch("a", "1..5")).exit_code, 0);
  const std::string manifest = scratch / "a/seed_1/manifest.json";
  std::string text = read_file(manifest);
  const std::size_t at = text.find("\"pile_height_m\": ");
  ASSERT_NE(at, std::string::npos);
  write_file(manifest, text.insert(at + 17, "9"));
  fs::remove_all(scratch / "a/seed_2");
  fs::copy(scratch / "a/seed_5", scratch / "a/seed_2", fs::copy_options::recursive);
  fs::copy_file(scratch / "a/seed_5/pile.bin", scratch / "a/seed_3/pile.bin", fs::copy_options::overwrite_existing);
  write_file(scratch / "a/seed_4/manifest.json", "{}");
  const Outcome again = run_rubble(batch("a", "1..5"));
  EXPECT_EQ(again.exit_code, 2) << again.err;
  for (const char* seed : {"1", "2", "3", "4"}) {
    EXPECT_IN(std::string("\n") + seed + ",altered,,,", index("a"));
    EXPECT_IN(std::string("seed ") + seed + ": ", again.err);
  }
  EXPECT_IN("\n5,done,", index("a"));
  EXPECT_IN("was altered", again.err);
  EXPECT_IN("belongs to another seed", again.err);
  EXPECT_IN("is not the pile of the manifest", again.err);
}

TEST_F(Batch, InfoSaysHowFarItIs) {
  ASSERT_EQ(run_rubble(batch("a", "1..4", "--shard 1/2")).exit_code, 0);
  const Outcome half = run_rubble("info " + (scratch / "a"));
  EXPECT_EQ(half.exit_code, 0) << half.err;
  EXPECT_IN("tiny.lua, seeds 1..4", half.out);
  EXPECT_IN("done                     2\n", half.out);
  EXPECT_IN("not begun                2: seed ", half.out);
}

TEST_F(Batch, RefusesAnotherBatchInTheSameFolder) {
  ASSERT_EQ(run_rubble(batch("a", "1")).exit_code, 0);
  const Outcome other = run_rubble(batch("a", "1", "--set pile.layers=1"));
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_IN("another batch is in the output folder", other.err);
  EXPECT_EQ(run_rubble(batch("a", "1..2")).exit_code, 1);
}

TEST_F(Batch, AsksForRoomBeforeItBegins) {
  const std::string huge = "batch " + (scratch / "tiny.lua") + " --seeds 1..1000 --out " +
                           (scratch / "a") +
                           " --set camera.width=8192 --set camera.height=8192"
                           " --set trajectory.rate_hz=1000";
  const Outcome refused = run_rubble(huge);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_IN("the disk is too small for this batch", refused.err);
  EXPECT_IN("--force", refused.err);
  EXPECT_FALSE(fs::exists(scratch / "a/seed_1"));
}

// Each output alone is enough to be too large; a path into a void is known only later.
TEST_F(Batch, AsksForRoomForEveryOutputAndEveryPath) {
  const std::string none =
      " --seeds 1..100000 --set camera.width=8192 --set camera.height=8192"
      " --set trajectory.rate_hz=100 --set outputs.rawlog=false --set outputs.bag=false"
      " --set outputs.preview=false --set outputs.stl=false --set outputs.simplemap=false";
  for (const char* output : {"mcap", "tum", "frames"}) {
    const Outcome refused =
        run_rubble("batch " + (scratch / "tiny.lua") + none + " --set outputs." + output +
                   "=true --out " + (scratch / "b"));
    EXPECT_EQ(refused.exit_code, 2) << output << refused.err;
    EXPECT_IN("the disk is too small for this batch", refused.err);
    fs::remove_all(scratch / "b");
  }
  const Outcome into = run_rubble("batch scripts/deepest_void.lua" + none +
                                  " --set outputs.bag=true --out " + (scratch / "c"));
  EXPECT_EQ(into.exit_code, 2) << into.err;
  EXPECT_IN("the disk is too small for this batch", into.err);
}

TEST_F(Batch, SaysOnceThatWhatItVariesHasNoEffect) {
  const std::string varied = batch("varied", "1", "--preview --vary light.cone_deg=20,40 --set light.type=point");
  const Outcome preview = run_rubble(varied);
  EXPECT_EQ(preview.exit_code, 0) << preview.err;
  const std::string sentence = "warning: --set: light.cone_deg: has no effect";
  EXPECT_IN(sentence, preview.err);
  EXPECT_EQ(preview.err.find(sentence), preview.err.rfind(sentence)) << preview.err;
}

TEST_F(Batch, RefusesAKeyThatIsBothVariedAndSet) {
  const Outcome refused = run_rubble(batch("both", "1", "--vary pile.layers=1,2 --set pile.layers=3"));
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_IN("--set: --vary gives the values of pile.layers", refused.err);
  EXPECT_EQ(run_rubble(batch("both", "1", "--preview --vary pile.layers=1,2 --set pile.layers_more=3")).err.find("gives the values"),
            std::string::npos);
}

TEST_F(Batch, RefusesSeedsAndShardsThatAreNone) {
  for (const char* seeds : {"5..1", "1..", "a", "1,,2", "''", "-1", "99999999999999999999"})
    EXPECT_EQ(run_rubble(batch("a", seeds)).exit_code, 1) << seeds;
  for (const char* shard : {"0/2", "3/2", "1", "1/0", "x/y"}) {
    const Outcome refused = run_rubble(batch("a", "1", std::string("--shard ") + shard));
    EXPECT_EQ(refused.exit_code, 1) << shard;
    EXPECT_IN("I/N with 1 <= I <= N", refused.err);
  }
}

}  // namespace batch_test
}  // namespace rubble::testing
