// verify, remake and render: what a manifest and a saved pile are good for.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "io/image/image_file.h"
#include "kernel/base/hash.h"
#include "tests/app/tiny_run.h"

namespace rubble::testing {
namespace verify_test {

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

// The second mission flies over the pile of the first, which is settled once.
TEST(Run, RecordsSeveralFlightsOverOnePile) {
  const ScratchFolder scratch;
  write_file(scratch / "outside.lua", kTinyMission);
  std::string inside = kTinyMission;
  write_file(scratch / "inside.lua", inside.insert(inside.find("trajectory"), "lamp = { on = false }, "));
  const std::string run = "run " + (scratch / "outside.lua") + " --set camera.width=32 --set camera.height=24 --out " + (scratch / "out");
  const Outcome both = run_rubble(run + " --also " + (scratch / "inside.lua"));
  ASSERT_EQ(both.exit_code, 0) << both.err;
  const auto first = read_manifest(scratch / "out/outside"), second = read_manifest(scratch / "out/inside");
  EXPECT_EQ(first.at("kind"), "run");
  EXPECT_EQ(second.at("kind"), "render");
  EXPECT_EQ(read_state_hash(scratch / "out/outside"), read_state_hash(scratch / "out/inside"));
  EXPECT_NE(read_outputs(scratch / "out/outside").at("mission.bag"), read_outputs(scratch / "out/inside").at("mission.bag"));
  EXPECT_EQ(run_rubble("verify " + (scratch / "out/inside")).exit_code, 0);
  // Told before anything is settled.
  write_file(scratch / "other.lua", "return rubble.mission { seed = 99 }\n");
  const std::string more = "run " + (scratch / "outside.lua") + " --out " + (scratch / "none") + " --also ";
  const Outcome seed = run_rubble(more + (scratch / "other.lua"));
  EXPECT_EQ(seed.exit_code, 1);
  EXPECT_IN("other.lua: seed: has another seed", seed.err);
  const Outcome pile = run_rubble(more + (scratch / "other.lua") + " --seed 5");
  EXPECT_EQ(pile.exit_code, 1);
  EXPECT_IN("other.lua: pile.spawn_position[3]: states another pile than", pile.err);
  EXPECT_EQ(run_rubble(more + (scratch / "outside.lua")).exit_code, 1);
  EXPECT_FALSE(fs::exists(scratch / "none"));
}

// A pile that is kept is not what the mission may ask for.
TEST(Render, SaysWhatOfItsMissionThePileHasNot) {
  const ScratchFolder scratch;
  write_file(scratch / "tiny.lua", kTinyMission);
  ASSERT_EQ(run_rubble("settle " + (scratch / "tiny.lua") + " --set fines.amount=20 --set outputs.stl=false --out " + (scratch / "pile"))
                .exit_code,
            0);
  const std::string small = " --set camera.width=32 --set camera.height=24 --quiet --out ";
  const auto render = [&](const std::string& mission, const std::string& out) {
    return run_rubble("render " + (scratch / "pile") + " --mission " + (scratch / mission) + small + (scratch / out));
  };
  const Outcome silent = render("tiny.lua --set fines.amount=20", "as_it_is");
  EXPECT_EQ(silent.exit_code, 0) << silent.err;
  EXPECT_EQ(silent.err.find("pile of the run"), std::string::npos) << silent.err;
  // Its defaults are not asked for.
  write_file(scratch / "none.lua", "return rubble.mission { trajectory = rubble.trajectory.orbit { radius_m = 8, speed = 70, rate_hz = 5 } }\n");
  const Outcome none = render("none.lua", "none");
  EXPECT_EQ(none.exit_code, 0) << none.err;
  EXPECT_EQ(none.err.find("pile of the run"), std::string::npos) << none.err;
  std::string other = kTinyMission;
  write_file(scratch / "other.lua", other.insert(other.find("trajectory"), "fines = { amount = 7 }, "));
  const Outcome warned = render("other.lua", "other");
  EXPECT_EQ(warned.exit_code, 0) << warned.err;
  EXPECT_IN("the pile of the run is kept, not the one that the mission states: fines.amount is 20 instead of 7", warned.err);
  const Outcome refused = render("tiny.lua --set fines.amount=0", "refused");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_IN("--set fines.amount=0: changes nothing, because the pile of", refused.err);
  EXPECT_IN("rubble settle MISSION --set fines.amount=0", refused.err);
  EXPECT_EQ(render("tiny.lua --set numlayers=4", "refused").exit_code, 1) << "an alias, and the default";
  EXPECT_FALSE(fs::exists(scratch / "refused"));
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

}  // namespace verify_test
}  // namespace rubble::testing
