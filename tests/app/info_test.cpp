// `rubble info PATH`: which file of a dataset is not whole any more, and at which byte.
#include <gtest/gtest.h>

#include <algorithm>

#include <filesystem>

#include "tests/app/program.h"

namespace rubble::testing {
namespace info_test {

namespace fs = std::filesystem;

#define EXPECT_IN(part, text) EXPECT_NE((text).find(part), std::string::npos) << (text)

class InfoOfData : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new ScratchFolder;
    write_file(*scratch_ / "tiny.lua", kTinyMission);
    const Outcome run = run_rubble("run " + (*scratch_ / "tiny.lua") +
                                   " --set outputs.mcap=true --out " + folder());
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  static void TearDownTestSuite() { delete scratch_; }
  static std::string folder() { return *scratch_ / "data"; }

  // With the file as `content`, the rest as it was.
  static Outcome info_with(const std::string& name, const std::string& content) {
    const std::string kept = read_file(folder() + "/" + name);
    write_file(folder() + "/" + name, content);
    const Outcome info = run_rubble("info " + folder());
    write_file(folder() + "/" + name, kept);
    return info;
  }

  static inline ScratchFolder* scratch_ = nullptr;
};

TEST_F(InfoOfData, SaysWhatIsThereAndThatItIsWhole) {
  const Outcome whole = run_rubble("info " + folder());
  EXPECT_EQ(whole.exit_code, 0) << whole.out << whole.err;
  EXPECT_IN("tiny.lua, seed 3", whole.out);
  EXPECT_IN("ROS 1 bag, 22 messages of 8 topics", whole.out);
  EXPECT_IN("MCAP, 22 messages of 8 topics", whole.out);
  EXPECT_EQ(whole.out.find("altered"), std::string::npos) << whole.out;
  const Outcome file = run_rubble("info " + folder() + "/mission.bag");
  EXPECT_EQ(file.exit_code, 0) << file.out;
}

// Hundreds of pictures are one row, as long as each is whole.
TEST_F(InfoOfData, IsShort) {
  const ScratchFolder scratch;
  write_file(scratch / "tiny.lua", kTinyMission);
  ASSERT_EQ(run_rubble("run " + (scratch / "tiny.lua") + " --quiet --set outputs.tum=true --set " +
                       "outputs.frames=true --out " + (scratch / "a"))
                .exit_code,
            0);
  const Outcome whole = run_rubble("info " + (scratch / "a"));
  EXPECT_EQ(whole.exit_code, 0) << whole.out;
  EXPECT_IN("tum/                     sound        ", whole.out);
  EXPECT_EQ(whole.out.find("tum/rgb"), std::string::npos) << whole.out;
  EXPECT_LT(std::count(whole.out.begin(), whole.out.end(), '\n'), 20) << whole.out;
  write_file(scratch / "a/tum/rgb.txt", "altered");
  const Outcome altered = run_rubble("info " + (scratch / "a"));
  EXPECT_EQ(altered.exit_code, 5);
  EXPECT_IN("tum/rgb.txt              altered", altered.out);
}

TEST_F(InfoOfData, NamesTheFileAndTheByteOfDamage) {
  for (const char* name : {"mission.bag", "mission.mcap", "mission.rawlog", "mission.simplemap"}) {
    const std::string whole = read_file(folder() + "/" + name);
    const std::size_t half = whole.size() / 2;
    const Outcome cut = info_with(name, whole.substr(0, half));
    EXPECT_EQ(cut.exit_code, 5) << cut.out;
    EXPECT_IN(name, cut.out);
    EXPECT_IN("at byte " + std::to_string(half) + ": the file ends within", cut.out);
    std::string altered = whole;
    altered[half] = char(altered[half] ^ 4);
    const Outcome bad = info_with(name, altered);
    EXPECT_EQ(bad.exit_code, 5) << bad.out;
    EXPECT_IN("altered      at byte ", bad.out);
    // verify, too, before it runs anything again.
    write_file(folder() + "/" + name, altered);
    const Outcome verify = run_rubble("verify --pile-only " + folder());
    write_file(folder() + "/" + name, whole);
    EXPECT_EQ(verify.exit_code, 5);
    EXPECT_IN(std::string(name) + " was altered (at byte ", verify.out);
  }
}

TEST_F(InfoOfData, SeesWhatHasNoChecksumOfItsOwnByTheManifest) {
  const std::string poses = read_file(folder() + "/groundtruth.txt");
  const Outcome altered = info_with("groundtruth.txt", poses + " ");
  EXPECT_EQ(altered.exit_code, 5);
  EXPECT_IN("its SHA-256 is not the manifest's", altered.out);
  fs::rename(folder() + "/preview.png", *scratch_ / "aside.png");
  const Outcome missing = run_rubble("info " + folder());
  fs::rename(*scratch_ / "aside.png", folder() + "/preview.png");
  EXPECT_EQ(missing.exit_code, 5);
  EXPECT_IN("preview.png              missing", missing.out);
}

TEST_F(InfoOfData, LooksIntoASingleFileWithoutAManifest) {
  const std::string bag = read_file(folder() + "/mission.bag");
  write_file(*scratch_ / "alone.bag", bag.substr(0, bag.size() - 1));
  const Outcome cut = run_rubble("info " + (*scratch_ / "alone.bag"));
  EXPECT_EQ(cut.exit_code, 5);
  EXPECT_IN("at byte " + std::to_string(bag.size() - 1), cut.out);
  const Outcome gone = run_rubble("info " + (*scratch_ / "nowhere.bag"));
  EXPECT_EQ(gone.exit_code, 1);
  EXPECT_IN("no such file or folder", gone.err);
}

}  // namespace info_test
}  // namespace rubble::testing
