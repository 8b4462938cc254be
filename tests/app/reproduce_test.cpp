// verify, render and resume: what a manifest and a saved pile are good for.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "io/image/image_file.h"
#include "kernel/base/hash.h"
#include "kernel/base/random.h"
#include "tests/app/program.h"

namespace rubble::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

const char* const kCube = R"(v 0 0 0
v 0.3 0 0
v 0.3 0.2 0
v 0 0.2 0
v 0 0 0.1
v 0.3 0 0.1
v 0.3 0.2 0.1
v 0 0.2 0.1
f 1 4 3 2
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
)";

Json read_manifest(const std::string& folder) {
  return Json::parse(read_file(folder + "/manifest.json"));
}

// All of a manifest that must be the same for the same run.
Json reproducible(const std::string& folder) {
  Json manifest = read_manifest(folder);
  manifest.erase("not_reproducible");
  return manifest;
}

void run_tiny(const ScratchFolder& scratch, const std::string& name, const std::string& more = "") {
  write_file(scratch / "tiny.lua", kTinyMission);
  const Outcome run =
      run_rubble("run " + (scratch / "tiny.lua") + " --out " + (scratch / name) + " " + more);
  ASSERT_EQ(run.exit_code, 0) << run.err;
}

void alter(const std::string& file, const std::string& from, const std::string& to) {
  std::string text = read_file(file);
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from << " in " << file;
  write_file(file, text.replace(at, from.size(), to));
}

#define EXPECT_IN(part, text) EXPECT_NE((text).find(part), std::string::npos) << (text)

// The script, a file that it includes and its pack are gone or elsewhere.
TEST(Verify, NeedsOnlyTheManifestAndThePacksContent) {
  const ScratchFolder scratch;
  fs::create_directories(scratch / "here/blocks");
  write_file(scratch / "here/blocks/block.obj", kCube);
  write_file(scratch / "here/blocks/pack.lua",
             "return pack { name = 'mine', assets = {\n"
             "  { name = 'block', mesh = 'block.obj', density = 1800 } } }\n");
  write_file(scratch / "here/many.lua", "return 6\n");
  write_file(scratch / "here/m.lua",
             "return rubble.mission { packs = { 'blocks' },\n"
             "  pile = { layers = 1, pieces_per_layer = rubble.include('many.lua'),\n"
             "           spawn_bounds = { 1, 1, 1 } } }\n");
  const Outcome settle = run_rubble("settle " + (scratch / "here/m.lua") +
                                    " --set pile.layers=2 --seed 5 --out " + (scratch / "a"));
  ASSERT_EQ(settle.exit_code, 0) << settle.err;
  fs::rename(scratch / "here/blocks", scratch / "elsewhere");
  fs::remove_all(scratch / "here");

  const Outcome lost = run_rubble("verify " + (scratch / "a"));
  EXPECT_EQ(lost.exit_code, 1);
  EXPECT_IN("the asset `block` of pack `mine` is missing", lost.err);
  EXPECT_IN("--assets", lost.err);
  const Outcome found =
      run_rubble("verify " + (scratch / "a") + " --assets " + (scratch / "elsewhere"));
  EXPECT_EQ(found.exit_code, 0) << found.out << found.err;

  alter(scratch / "elsewhere/block.obj", "v 0.3 0 0", "v 0.4 0 0");
  const Outcome other =
      run_rubble("verify " + (scratch / "a") + " --assets " + (scratch / "elsewhere"));
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_IN("it has the content", other.err);
}

TEST(Verify, NamesWhatIsEqualAndWhatDiffersFirst) {
  const ScratchFolder scratch;
  run_tiny(scratch, "a");
  const Outcome same = run_rubble("verify --json " + (scratch / "a"));
  ASSERT_EQ(same.exit_code, 0) << same.out << same.err;
  const Json result = Json::parse(same.out);
  EXPECT_EQ(result.at("equal"), true);
  EXPECT_EQ(result.at("findings").size(), 8u);

  // One bit of a recording, one digit of a frame's hash, and another version of a library.
  std::string bag = read_file(scratch / "a/mission.bag");
  bag[5000] = char(bag[5000] ^ 1);
  write_file(scratch / "a/mission.bag", bag);
  Json manifest = read_manifest(scratch / "a");
  std::string row = manifest["frame_hashes"]["xxh64"][1];
  row[17] = row[17] == '0' ? '1' : '0';  // the first digit of the second channel: rgb
  manifest["frame_hashes"]["xxh64"][1] = row;
  manifest["libraries"]["zlib"] = "0.1";
  write_file(scratch / "a/manifest.json", manifest.dump(2));
  const Outcome differs = run_rubble("verify " + (scratch / "a"));
  EXPECT_EQ(differs.exit_code, 5) << differs.err;
  EXPECT_IN("part frames (`frames`, `frame_hashes`) was altered", differs.out);
  EXPECT_IN("mission.bag was altered", differs.out);
  EXPECT_IN("frame 1 is the first that differs, in its rgb", differs.out);
  EXPECT_IN("; yet mission.rawlog holds the same pixels: the manifest was altered", differs.out);
  EXPECT_IN("in the recorded mission.bag, byte 5000 is the first that differs", differs.out);
  EXPECT_IN("instead of 0.1", differs.out);
  EXPECT_IN("pile            equal", differs.out);
}

// Makes frame 1 of a run one that had another hash of a channel (0: pose, 1: rgb, 2: depth), and
// the file one that the run had left so.
void disguise(const std::string& folder, int channel, const std::string& file) {
  Json manifest = read_manifest(folder);
  std::string row = manifest["frame_hashes"]["xxh64"][1];
  char& digit = row[std::size_t(17 * channel)];
  digit = digit == '0' ? '1' : '0';
  manifest["frame_hashes"]["xxh64"][1] = row;
  if (!file.empty()) manifest["outputs"][file] = sha256_of_file(folder + "/" + file);
  write_file(folder + "/manifest.json", manifest.dump(2));
}

TEST(Verify, NamesThePixelThatDiffers) {
  const ScratchFolder scratch;
  run_tiny(scratch, "a", "--set outputs.frames=true --set outputs.bag=false");
  const std::string picture = scratch / "a/frames/rgb/000001.png";
  RgbImage image = read_rgb_png(picture);
  image.rgb[3 * (20 * 64 + 33) + 2] ^= 1;
  write_png(picture, image);
  disguise(scratch / "a", 1, "frames/rgb/000001.png");
  const Outcome differs = run_rubble("verify " + (scratch / "a"));
  EXPECT_EQ(differs.exit_code, 5) << differs.err;
  EXPECT_IN("frame 1 is the first that differs, in its rgb: ", differs.out);
  EXPECT_IN("; pixel (33, 20) is the first that differs: ", differs.out);
  EXPECT_IN(" (1 of 3072 differ), by frames/rgb/000001.png", differs.out);
}

// The same in a bag, altered by ROS's own library; and what a bag cannot tell.
TEST(Verify, NamesThePixelByABag) {
  const ScratchFolder scratch;
  run_tiny(scratch, "a", "--set outputs.rawlog=false");
  write_file(scratch / "alter.py", R"(import rosbag, sys
seen = 0
with rosbag.Bag(sys.argv[2], 'w', compression='lz4') as out:
    for topic, message, time in rosbag.Bag(sys.argv[1]).read_messages():
        if topic == '/camera/rgb/image_raw':
            if seen == 1:
                data = bytearray(message.data)
                data[3 * (7 * 64 + 12)] ^= 255
                message.data = bytes(data)
            seen += 1
        out.write(topic, message, time)
)");
  const std::string bag = scratch / "a/mission.bag";
  ASSERT_EQ(std::system(("/usr/bin/python3 " + (scratch / "alter.py") + " " + bag + " " +
                         (scratch / "altered.bag"))
                            .c_str()),
            0);
  fs::rename(scratch / "altered.bag", bag);
  fs::copy(scratch / "a", scratch / "b", fs::copy_options::recursive);
  disguise(scratch / "a", 1, "mission.bag");
  const Outcome colour = run_rubble("verify " + (scratch / "a"));
  EXPECT_EQ(colour.exit_code, 5) << colour.err;
  EXPECT_IN("; pixel (12, 7) is the first that differs: ", colour.out);
  EXPECT_IN(", by mission.bag", colour.out);
  disguise(scratch / "b", 2, "mission.bag");
  const Outcome depth = run_rubble("verify " + (scratch / "b"));
  EXPECT_IN("in its depth: ", depth.out);
  EXPECT_IN("; mission.bag rounds depth to 0.001 m and shows no difference", depth.out);
}

TEST(Verify, SaysWhenNoRecordingHoldsThePixels) {
  const ScratchFolder scratch;
  run_tiny(scratch, "a", "--set outputs.rawlog=false --set outputs.pictures=jpeg");
  disguise(scratch / "a", 1, "");
  const Outcome differs = run_rubble("verify " + (scratch / "a"));
  EXPECT_EQ(differs.exit_code, 5) << differs.err;
  EXPECT_IN("no recording holds its pixels without losses", differs.out);
}

TEST(Verify, NamesThePieceAndTheKeyWhenTheScenarioWasAltered) {
  const ScratchFolder scratch;
  write_file(scratch / "tiny.lua", kTinyMission);
  ASSERT_EQ(run_rubble("settle " + (scratch / "tiny.lua") + " --out " + (scratch / "a")).exit_code,
            0);
  alter(scratch / "a/manifest.json", "\"gravity\": 9.81", "\"gravity\": 9.80");
  const Outcome differs = run_rubble("verify " + (scratch / "a"));
  EXPECT_EQ(differs.exit_code, 5);
  EXPECT_IN("settle.gravity is 9.81 instead of 9.8", differs.out);
  EXPECT_IN("(brick) is the first that differs, in its ", differs.out);
  // Nothing is rendered over a pile whose manifest was altered.
  const Outcome render = run_rubble("render " + (scratch / "a") + " --mission " +
                                    (scratch / "tiny.lua") + " --out " + (scratch / "b"));
  EXPECT_EQ(render.exit_code, 1);
  EXPECT_IN("part scenario", render.err);
}

TEST(Verify, SaysWhatIsWrongWithAManifestThatCannotBeRead) {
  const ScratchFolder scratch;
  fs::create_directories(scratch / "a");
  EXPECT_EQ(run_rubble("verify " + (scratch / "a")).exit_code, 1);
  write_file(scratch / "a/manifest.json", "{\n  \"format\": \"rubble mani");
  const Outcome torn = run_rubble("verify " + (scratch / "a"));
  EXPECT_EQ(torn.exit_code, 1);
  EXPECT_IN("manifest.json:2: not valid JSON", torn.err);
  write_file(scratch / "a/manifest.json", "{\"format\": \"rubble manifest 1\"}");
  EXPECT_IN("expected rubble manifest 2", run_rubble("verify " + (scratch / "a")).err);
  write_file(scratch / "a/manifest.json", "{\"format\": \"rubble manifest 2\"}");
  EXPECT_IN("program: missing", run_rubble("verify " + (scratch / "a")).err);
}

TEST(Verify, SaysMissingWhereFilesAreMissing) {
  const ScratchFolder scratch;
  run_tiny(scratch, "a");
  fs::create_directories(scratch / "alone");
  fs::copy_file(scratch / "a/manifest.json", scratch / "alone/manifest.json");
  const Outcome alone = run_rubble("verify " + (scratch / "alone") + " --keep " + (scratch / "kept"));
  EXPECT_EQ(alone.exit_code, 5);
  EXPECT_IN("recorded files  missing  all ", alone.out);
  EXPECT_IN("files are missing; `rubble remake` makes them again, the same", alone.out);
  EXPECT_EQ(alone.out.find("not the same"), std::string::npos) << alone.out;
  EXPECT_EQ(reproducible(scratch / "kept"), reproducible(scratch / "a"));
  EXPECT_EQ(run_rubble("info " + (scratch / "kept")).exit_code, 0);
  // One that is missing and one that was altered: not the same.
  fs::remove(scratch / "a/pile.stl");
  const Outcome one = run_rubble("verify " + (scratch / "a"));
  EXPECT_EQ(one.exit_code, 5);
  EXPECT_IN("recorded files  missing  pile.stl is missing", one.out);
  write_file(scratch / "a/groundtruth.txt", "0");
  EXPECT_IN("\nnot the same", run_rubble("verify " + (scratch / "a")).out);
  const Outcome both = run_rubble("verify " + (scratch / "a") + " --pile-only --keep " + (scratch / "k"));
  EXPECT_EQ(both.exit_code, 1);
}

TEST(Remake, GivesTheSameBytesFromTheManifestAlone) {
  const ScratchFolder scratch;
  fs::create_directories(scratch / "packs/blocks");
  write_file(scratch / "packs/blocks/block.obj", kCube);
  write_file(scratch / "packs/blocks/pack.lua",
             "return pack { name = 'mine', assets = { { name = 'block', mesh = 'block.obj' } } }\n");
  std::string text = kTinyMission;
  text.replace(text.find("{ asset = \"brick\" }"), 19, "{ asset = \"block\" }");
  text.replace(text.find("seed = 3"), 8, "seed = 3, packs = { 'packs/blocks' }");
  write_file(scratch / "mission.lua", text);
  const Outcome run = run_rubble("run " + (scratch / "mission.lua") + " --seed 9 --out " + (scratch / "a"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  write_file(scratch / "manifest.json", read_file(scratch / "a/manifest.json"));
  fs::rename(scratch / "packs", scratch / "moved");
  fs::remove(scratch / "mission.lua");
  const std::string remake = "remake " + (scratch / "manifest.json") + " --out " + (scratch / "b");
  const Outcome lost = run_rubble(remake);
  EXPECT_EQ(lost.exit_code, 1);
  EXPECT_IN("the asset `block` of pack `mine` is missing", lost.err);
  const Outcome again = run_rubble(remake + " --assets " + (scratch / "moved"));
  EXPECT_EQ(again.exit_code, 0) << again.err << again.out;
  EXPECT_IN("the same: state hash ", again.out);
  EXPECT_EQ(reproducible(scratch / "b"), reproducible(scratch / "a"));
  for (const auto& [name, hash] : read_outputs(scratch / "a"))
    EXPECT_TRUE(read_file(scratch / ("a/" + name)) == read_file(scratch / ("b/" + name))) << name;
}

TEST(Remake, SaysWhatIsNotTheSameAndWhatCannotBeMade) {
  const ScratchFolder scratch;
  run_tiny(scratch, "a");
  const std::string a = scratch / "a";
  const Outcome inside = run_rubble("remake " + a + " --out " + a + " --force");
  EXPECT_EQ(inside.exit_code, 1);
  EXPECT_IN("would replace the dataset", inside.err);
  EXPECT_EQ(run_rubble("remake " + (scratch / "none.json") + " --out " + (scratch / "b")).exit_code, 1);
  EXPECT_EQ(run_rubble("remake " + a).exit_code, 1) << "--out is required";
  write_file(scratch / "cut.json", read_file(a + "/manifest.json").substr(0, 500));
  EXPECT_EQ(run_rubble("remake " + (scratch / "cut.json") + " --out " + (scratch / "b")).exit_code, 1);
  Json manifest = read_manifest(a);
  manifest["state_hash"] = "0123456789abcdef";
  write_file(scratch / "altered.json", manifest.dump(2));
  const Outcome altered = run_rubble("remake " + (scratch / "altered.json") + " --out " + (scratch / "b"));
  EXPECT_EQ(altered.exit_code, 1);
  EXPECT_IN("state_hash", altered.err);
  EXPECT_FALSE(fs::exists(scratch / "b"));
  // Sealed again: as from a program with another result.
  manifest["seals"]["pile"] =
      sha256(Json({{"state_hash", manifest["state_hash"]}, {"pile", manifest["pile"]}}).dump());
  write_file(scratch / "altered.json", manifest.dump(2));
  const Outcome other = run_rubble("remake " + (scratch / "altered.json") + " --out " + (scratch / "b"));
  EXPECT_EQ(other.exit_code, 5) << other.err;
  EXPECT_IN("differs: the pile: state hash " + read_state_hash(scratch / "a"), other.out);
  EXPECT_IN("not the same", other.out);
}

TEST(Render, FliesAnotherMissionOverTheSamePileAndCanBeVerified) {
  const ScratchFolder scratch;
  run_tiny(scratch, "a");
  std::string other = kTinyMission;
  other.replace(other.find("seed = 3"), 8, "seed = 9");
  other.replace(other.find("layers = 2"), 10, "layers = 7");
  other.replace(other.find("width = 64"), 10, "width = 32");
  write_file(scratch / "other.lua", other);
  const Outcome render = run_rubble("render " + (scratch / "a") + " --mission " +
                                    (scratch / "other.lua") + " --out " + (scratch / "b"));
  ASSERT_EQ(render.exit_code, 0) << render.err;
  EXPECT_EQ(read_outputs(scratch / "a").at("pile.bin"), read_outputs(scratch / "b").at("pile.bin"));
  EXPECT_NE(read_outputs(scratch / "a").at("mission.bag"),
            read_outputs(scratch / "b").at("mission.bag"));
  EXPECT_EQ(read_manifest(scratch / "b").at("scenario").at("pile").at("layers"), 2);
  fs::remove_all(scratch / "a");
  const Outcome verify = run_rubble("verify " + (scratch / "b"));
  EXPECT_EQ(verify.exit_code, 0) << verify.out << verify.err;
}

TEST(Render, RefusesADamagedOrForeignPile) {
  const ScratchFolder scratch;
  write_file(scratch / "tiny.lua", kTinyMission);
  const std::string settle = "settle " + (scratch / "tiny.lua") + " --set outputs.stl=false";
  ASSERT_EQ(run_rubble(settle + " --out " + (scratch / "a")).exit_code, 0);
  ASSERT_EQ(run_rubble(settle + " --seed 4 --out " + (scratch / "b")).exit_code, 0);
  const std::string render = "render " + (scratch / "a") + " --mission " + (scratch / "tiny.lua") +
                             " --out " + (scratch / "c");
  const std::string pile = read_file(scratch / "a/pile.bin");
  write_file(scratch / "a/pile.bin", pile.substr(0, pile.size() / 2));
  const Outcome truncated = run_rubble(render);
  EXPECT_EQ(truncated.exit_code, 1);
  EXPECT_IN("truncated", truncated.err);
  fs::copy_file(scratch / "b/pile.bin", scratch / "a/pile.bin",
                fs::copy_options::overwrite_existing);
  const Outcome foreign = run_rubble(render);
  EXPECT_EQ(foreign.exit_code, 1);
  EXPECT_IN("is not the pile of the manifest beside it", foreign.err);
  write_file(scratch / "a/pile.bin", pile);
  const Outcome itself = run_rubble("render " + (scratch / "a") + " --mission " +
                                    (scratch / "tiny.lua") + " --force --out " + (scratch / "a"));
  EXPECT_EQ(itself.exit_code, 1);
  EXPECT_IN("would replace", itself.err);
}

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
  if (!fs::exists(folder + "/manifest.json") || fs::exists(folder + "/unfinished")) {
    const Outcome last = run_rubble(next());
    ASSERT_EQ(last.exit_code, 0) << last.err;
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
      " --set pile.layers=100 --set pile.pieces_per_layer=200 --set pile.spawn_bounds=3,3,3";
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
        "run " + (scratch / "tiny.lua") + " --seed 2 --set camera.width=400 --set camera.height=300 --out " + folder,
        has_pile, SIGKILL);
    if (killed.exit_code == 0) continue;  // it was quicker
    ASSERT_TRUE(has_pile());
    const std::string note = read_file(folder + "/unfinished/settled.txt");
    EXPECT_EQ(note.substr(17), sha256_of_file(folder + "/pile.bin") + "\n");
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
  const std::string run = "run " + (scratch / "tiny.lua") + " --set camera.width=300 --force --out " + folder + " --seed ";
  std::vector<Outcome> ends(4);
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
  const std::string more = " --set pile.layers=100 --set pile.pieces_per_layer=200 --set pile.spawn_bounds=3,3,3 --out " + folder;
  Outcome second, third;
  const auto meanwhile = [&] {  // asked again and again while the first is at work
    if (!fs::exists(folder + "/unfinished/run.json")) return false;
    second = run_rubble("run " + (scratch / "long.lua") + " --force --out " + folder);
    third = run_rubble("resume " + folder);
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

}  // namespace
}  // namespace rubble::testing
