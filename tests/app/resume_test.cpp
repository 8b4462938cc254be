// resume: a run that was killed, stopped or ran out of disk goes on to the same bytes.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "kernel/base/hash.h"
#include "kernel/base/random.h"
#include "tests/app/tiny_run.h"

namespace rubble::testing {
namespace resume_test {

namespace fs = std::filesystem;

// SIGKILL at any moment, again and again, and in the end the very same bytes.
void kill_and_resume(std::uint64_t seed, int kills, const ScratchFolder& scratch,
                     const std::string& command, double seconds) {
  RandomStream random(seed, "moments of killing");
  const std::string folder = scratch / ("killed" + std::to_string(seed));
  const std::string run =
      command + " " + (scratch / "tiny.lua") + " --checkpoint-every 0.005 --out " + folder;
  const auto next = [&] {
    return fs::exists(folder + "/unfinished/run.json") ? "resume " + folder : run;
  };
  for (int i = 0; i < kills && !fs::exists(folder + "/manifest.json"); ++i)
    run_rubble_and_signal(next(), random.uniform(0, seconds), SIGKILL);
  if (!fs::exists(folder + "/manifest.json") || fs::exists(folder + "/unfinished/run.json")) {
    const Outcome last = run_rubble(next());
    ASSERT_EQ(last.exit_code, 0) << last.err;
  } else if (fs::exists(folder + "/unfinished")) {  // killed between the last two steps
    EXPECT_IN("is finished", run_rubble("resume " + folder).err);
  }
  EXPECT_EQ(reproducible(folder), reproducible(scratch / command));
  for (const auto& [name, hash] : read_outputs(scratch / command))
    EXPECT_EQ(read_file(folder + "/" + name), read_file(scratch / (command + "/" + name))) << name;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
  EXPECT_FALSE(fs::exists(folder + "/unfinished"));
}

// Without being killed, into the folder `command`; how long it took.
double run_whole(const ScratchFolder& scratch, const std::string& command) {
  const auto start = std::chrono::steady_clock::now();
  const Outcome whole =
      run_rubble(command + " " + (scratch / "tiny.lua") + " --out " + (scratch / command));
  EXPECT_EQ(whole.exit_code, 0) << whole.err;
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// times: how often each of `run` and `settle` is begun anew.
void kill_both(int times, int kills) {
  const ScratchFolder scratch;
  write_file(scratch / "tiny.lua", kTinyMission);
  for (const std::string command : {"run", "settle"}) {
    const double seconds = run_whole(scratch, command);
    for (int seed = 1; seed <= times; ++seed)
      kill_and_resume(std::uint64_t(seed + 10 * (command == "run")), kills, scratch, command,
                      seconds);
  }
}

TEST(Resume, GivesTheSameBytesAfterKills) { kill_both(1, 3); }
TEST(NightlyResume, GivesTheSameBytesAfterKillsAtTwentyMoments) { kill_both(2, 5); }

TEST(Resume, ContinuesWhatASignalStoppedAndSaysHow) {
  const ScratchFolder scratch;
  write_file(scratch / "long.lua", kTinyMission);
  const std::string folder = scratch / "a";
  // Large enough to be settling still when it is stopped.
  const std::string run =
      "run " + (scratch / "long.lua") + " --out " + folder +
      " --set pile.layers=300 --set pile.pieces_per_layer=60 --set pile.spawn_bounds=5,5,5";
  const std::string checkpoint = folder + "/unfinished/settle.checkpoint";
  for (const int signal : {SIGINT, SIGTERM}) {
    const std::string command = fs::exists(folder) ? "resume " + folder : run;
    std::error_code none;  // the first time there is no checkpoint yet
    const auto before = fs::last_write_time(checkpoint, none);
    const auto settles = [&] {
      std::error_code failed;
      const auto now = fs::last_write_time(checkpoint, failed);
      return !failed && now != before;
    };
    const Outcome stopped =
        run_rubble_and_signal(command + " --checkpoint-every 0.1", settles, signal);
    EXPECT_EQ(stopped.exit_code, 4) << stopped.err;
    EXPECT_IN("`rubble resume " + folder + "` continues", stopped.err);
    EXPECT_TRUE(fs::exists(checkpoint));
    EXPECT_FALSE(fs::exists(folder + "/pile.bin"));
  }
  const Outcome again = run_rubble(run);
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_IN("an unfinished run is in the output folder", again.err);
  EXPECT_IN("`rubble resume", run_rubble("verify " + folder).err);
  // Another program began it.
  alter(folder + "/unfinished/run.json", "\"commit\": \"", "\"commit\": \"x");
  const Outcome other = run_rubble("resume " + folder);
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_IN("another program began this run", other.err);
  // --force begins anew, and takes away what that run had left.
  write_file(folder + "/unfinished/files.txt", "mission.mcap\n../precious\n");
  write_file(folder + "/mission.mcap", "");
  write_file(scratch / "precious", "");
  const Outcome forced =
      run_rubble("settle " + (scratch / "long.lua") + " --force --out " + folder);
  EXPECT_EQ(forced.exit_code, 0) << forced.err;
  EXPECT_FALSE(fs::exists(folder + "/mission.mcap"));
  EXPECT_TRUE(fs::exists(scratch / "precious"));
  EXPECT_FALSE(fs::exists(folder + "/unfinished"));
  EXPECT_IN("is finished", run_rubble("resume " + folder).err);
}

// A run that was killed after it had written meshes into a folder of their own.
TEST(Resume, WritesFoldersOfMeshesAnew) {
  const ScratchFolder scratch;
  const std::string more = " --set outputs.meshes=sdf --set camera.width=400 --set camera.height=300";
  run_tiny(scratch, "whole", more);
  const std::string folder = scratch / "stopped";
  const auto has_meshes = [&] { return fs::exists(folder + "/sdf"); };
  const Outcome killed =
      run_rubble_and_signal("run " + (scratch / "tiny.lua") + more + " --out " + folder, has_meshes, SIGKILL);
  if (killed.exit_code == 0) GTEST_SKIP() << "it was quicker";
  ASSERT_TRUE(fs::exists(folder + "/sdf/pile.sdf"));
  const Outcome resumed = run_rubble("resume " + folder);
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_EQ(reproducible(folder), reproducible(scratch / "whole"));
  EXPECT_EQ(read_file(folder + "/sdf/pile.sdf"), read_file(scratch / "whole/sdf/pile.sdf"));
}

// A pile.bin that this run did not make: of another seed, with and without the note of that one, or
// altered. It is settled anew, and the files are those of a run that was left alone.
TEST(Resume, TakesNoPileOfAnotherSeed) {
  const ScratchFolder scratch;
  run_tiny(scratch, "one", "--seed 1"), run_tiny(scratch, "two", "--seed 2");
  ASSERT_NE(read_state_hash(scratch / "one"), read_state_hash(scratch / "two"));
  const std::string folder = scratch / "stopped";
  const auto has_pile = [&] { return fs::exists(folder + "/unfinished/settled.txt"); };
  for (const std::string of : {"pile", "pile and note", "altered note"}) {
    fs::remove_all(folder);
    const Outcome killed = run_rubble_and_signal(
        "run " + (scratch / "tiny.lua") + " --seed 2 --out " + folder,
        has_pile, SIGKILL);
    if (killed.exit_code == 0) continue;  // it was quicker
    ASSERT_TRUE(has_pile());
    const std::string note = read_file(folder + "/unfinished/settled.txt");
    EXPECT_EQ(note.substr(17, note.find('\n') - 16), sha256_of_file(folder + "/pile.bin") + "\n");
    fs::copy_file(scratch / "one/pile.bin", folder + "/pile.bin", fs::copy_options::overwrite_existing);
    if (of == "pile and note")  // of another seed: its file is whole, but not of this work
      write_file(folder + "/unfinished/settled.txt",
                 std::string(16, '1') + " " + sha256_of_file(folder + "/pile.bin") + "\n");
    if (of == "altered note") fs::remove(folder + "/unfinished/settled.txt");
    const Outcome resumed = run_rubble("resume " + folder);
    ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
    EXPECT_EQ(read_state_hash(folder), read_state_hash(scratch / "two")) << of;
    EXPECT_EQ(read_file(folder + "/pile.bin"), read_file(scratch / "two/pile.bin")) << of;
  }
}

// Runs at once in one folder: one has it from its creation to its end, the others say so.
TEST(Resume, OneProcessAtATimeInAFolder) {
  const ScratchFolder scratch;
  write_file(scratch / "tiny.lua", kTinyMission);
  const std::string folder = scratch / "shared";
  const std::string run = "run " + (scratch / "tiny.lua") + " --force --out " + folder + " --seed ";
  std::vector<Outcome> ends(3);
  std::vector<std::thread> together;
  for (std::size_t i = 0; i < ends.size(); ++i)
    together.emplace_back([&, i] { ends[i] = run_rubble(run + std::to_string(i + 1)); });
  for (std::thread& t : together) t.join();
  for (const Outcome& end : ends) {
    if (end.exit_code != 0) {
      EXPECT_IN("another process is at work", end.err);
    }
  }
  // Whoever was last made all of it.
  EXPECT_EQ(run_rubble("info " + folder).exit_code, 0);
  const Outcome verified = run_rubble("verify " + folder);
  EXPECT_EQ(verified.exit_code, 0) << verified.out << verified.err;
  EXPECT_FALSE(fs::exists(folder + "/unfinished"));
}

TEST(Resume, ARunThatIsAtWorkKeepsOthersOut) {
  const ScratchFolder scratch;
  write_file(scratch / "long.lua", kTinyMission);
  const std::string folder = scratch / "a";
  const std::string more = " --set pile.layers=300 --set pile.pieces_per_layer=60 --set pile.spawn_bounds=5,5,5 --out " + folder;
  Outcome second, third;
  const auto meanwhile = [&] {  // asked again and again while the first is at work, which goes on for longer than others wait
    if (!fs::exists(folder + "/unfinished/run.json")) return false;
    std::thread beside([&] { second = run_rubble("run " + (scratch / "long.lua") + " --force --out " + folder); });
    third = run_rubble("resume " + folder);
    beside.join();
    return true;
  };
  const Outcome first = run_rubble_and_signal("run " + (scratch / "long.lua") + more, meanwhile, SIGTERM);
  EXPECT_EQ(first.exit_code, 4) << first.err;
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_IN("another process is at work on this run", second.err);
  EXPECT_EQ(third.exit_code, 1);
  EXPECT_IN("another process is at work on this run", third.err);
  EXPECT_TRUE(fs::exists(folder + "/unfinished/run.json"));
}

// The disk is full at every step in turn (a file-size limit is one): exit code 2, nothing has a
// final name that is not whole, and resume goes on from there.
TEST(Resume, GoesOnAfterAFullDisk) {
  const ScratchFolder scratch;
  run_tiny(scratch, "whole");
  const std::string run = "run " + (scratch / "tiny.lua") + " --out ";
  int failures = 0;
  for (const int blocks : {1, 3, 8, 60, 100}) {  // of 512 or 1024 bytes, as the shell has it
    const std::string folder = scratch / std::to_string(blocks);
    const Outcome full = run_rubble(run + folder, "ulimit -f " + std::to_string(blocks) + " &&");
    if (full.exit_code == 0) continue;
    ++failures;
    EXPECT_EQ(full.exit_code, 2) << full.err;
    EXPECT_FALSE(fs::exists(folder + "/manifest.json"));
    const auto whole = read_outputs(scratch / "whole");
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (!entry.is_regular_file()) continue;
      const std::string name = entry.path().filename().string();
      EXPECT_TRUE(whole.count(name)) << name;
      EXPECT_EQ(read_file(entry.path()), read_file(scratch / ("whole/" + name))) << name;
    }
    const bool begun = fs::exists(folder + "/unfinished/run.json");
    EXPECT_EQ(begun, full.err.find("rubble resume") != std::string::npos) << full.err;
    const Outcome resumed = run_rubble(begun ? "resume " + folder : run + folder);
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
    EXPECT_EQ(reproducible(folder), reproducible(scratch / "whole"));
  }
  EXPECT_GE(failures, 4);
}

TEST(Run, NamesAnOutputPathThatIsTakenOrCannotBeWritten) {
  const ScratchFolder scratch;
  write_file(scratch / "tiny.lua", kTinyMission);
  write_file(scratch / "taken", "a file");
  const Outcome taken =
      run_rubble("settle " + (scratch / "tiny.lua") + " --out " + (scratch / "taken"));
  EXPECT_EQ(taken.exit_code, 1);
  EXPECT_IN("is not a folder", taken.err);
  EXPECT_EQ(read_file(scratch / "taken"), "a file");
  // /proc is a folder that nobody may write to, not even root.
  const Outcome read_only = run_rubble("settle " + (scratch / "tiny.lua") + " --out /proc/rubble");
  EXPECT_EQ(read_only.exit_code, 2);
  EXPECT_IN("/proc/rubble", read_only.err);
}

}  // namespace resume_test
}  // namespace rubble::testing
