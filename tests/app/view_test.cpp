// The page that shows a dataset, and what is said before a run begins.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "io/image/image_file.h"
#include "tests/app/program.h"
#include "tests/app/tiny_run.h"

namespace rubble::testing {
namespace view_test {

namespace fs = std::filesystem;

class View : public ::testing::Test {
 protected:
  void SetUp() override {
    write_file(scratch / "tiny.lua", kTinyMission);
    const Outcome run = run_rubble("run " + (scratch / "tiny.lua") + " --quiet --out " + (scratch / "a"));
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  static nlohmann::json data_of(const std::string& page) {
    const std::string begin = "id=\"data\">";
    const std::size_t at = page.find(begin) + begin.size();
    return nlohmann::json::parse(page.substr(at, page.find("</script>", at) - at));
  }
  ScratchFolder scratch;
};
class NightlyView : public View {};

TEST_F(View, HoldsThePiecesTheWayAndPictures) {
  const Outcome made = run_rubble("view " + (scratch / "a") + " --frames 2 --width 48");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(made.out, (scratch / "a/view.html") + "\n");
  const std::string page = read_file(scratch / "a/view.html");
  const nlohmann::json data = data_of(page);
  EXPECT_EQ(data.at("pieces"), 16);
  ASSERT_EQ(data.at("types").size(), 1u);
  // 16 matrices of 16 floats, three characters of four for each byte.
  EXPECT_EQ(data.at("types")[0].at("instances").get<std::string>().size(), (16u * 64 + 2) / 3 * 4);
  ASSERT_EQ(data.at("tracks").size(), 1u);
  const nlohmann::json& way = data.at("tracks")[0];
  EXPECT_EQ(way.at("stamps").size(), 3u);
  ASSERT_EQ(way.at("frames").size(), 2u);
  EXPECT_EQ(way.at("frames")[1].at("frame"), 2);
  EXPECT_EQ(way.at("frames")[0].at("jpeg").get<std::string>().substr(0, 4), "/9j/");
  EXPECT_TRUE(data.at("robots").empty());
  EXPECT_TRUE(data.at("voids").empty());
  EXPECT_IN("InstancedMesh", page);
  for (const char* outside : {"src=\"http", "src=\"/", "href=\"http", "@import", "importScripts("})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside << " leads out of the page";
}

TEST_F(View, ReplacesNoFileOfTheRun) {
  const std::string manifest = read_file(scratch / "a/manifest.json");
  const Outcome refused = run_rubble("view " + (scratch / "a") + " --out " + (scratch / "a/../a/manifest.json"));
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_IN("--out: would replace a file that a run recorded", refused.err);
  EXPECT_EQ(read_file(scratch / "a/manifest.json"), manifest);
  for (int i = 0; i < 2; ++i) EXPECT_EQ(run_rubble("view " + (scratch / "a") + " --frames 0 --out " + (scratch / "a/v.html")).exit_code, 0);
}

// Two cameras on a rover: the way and the pictures of each, and the links of the robot with a pose for each moment.
TEST_F(View, HoldsTheCamerasOfARigAndTheRobotsLinks) {
  write_file(scratch / "rover.lua", R"(return rubble.mission {
  pile = { layers = 0, placed = { { box = { 0.2, 2, 1 }, position = { 3, 0, 0.5 } } } },
  robots = { rubble.robot.rover { name = "rover", position = { 0, 0, 0.001 }, drive = { { t = 0, linear = 0.5 } } } },
  robot_run = { duration = 1 },
  cameras = { front = { width = 32, height = 24, ride = { robot = "rover" }, position = { 0.3, 0, 0.3 }, rate_hz = 4 },
              watch = { width = 32, height = 24 } },
  trajectory = { rate_hz = 2, waypoints = { { t = 0, position = { -2, 0, 1 }, look_at = { 0, 0, 0 } }, { t = 1, position = { -2, 1, 1 }, look_at = { 0, 0, 0 } } } },
})");
  const Outcome run = run_rubble("run " + (scratch / "rover.lua") + " --quiet --out " + (scratch / "r"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Outcome made = run_rubble("view " + (scratch / "r") + " --frames 2 --width 32");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const nlohmann::json data = data_of(read_file(scratch / "r/view.html"));
  ASSERT_EQ(data.at("tracks").size(), 2u);
  EXPECT_EQ(data.at("tracks")[0].at("name"), "front");
  EXPECT_EQ(data.at("tracks")[0].at("stamps").size(), 5u);
  EXPECT_EQ(data.at("tracks")[0].at("frames").size(), 2u);
  EXPECT_EQ(data.at("tracks")[1].at("stamps").size(), 3u);
  ASSERT_EQ(data.at("robots").size(), 1u);
  const nlohmann::json& rover = data.at("robots")[0];
  EXPECT_EQ(rover.at("name"), "rover");
  EXPECT_EQ(rover.at("stamps").size(), 61u);
  EXPECT_EQ(rover.at("stamps")[0], 1.0);
  ASSERT_EQ(rover.at("links").size(), 5u);  // a body and four wheels
  EXPECT_EQ(rover.at("links")[0].at("poses").get<std::string>().size(), (61u * 28 + 2) / 3 * 4);
}

// A triangle as `rubble voids` writes it.
std::string make_surface(const std::string& pile_state) {
  std::string text = "ply\nformat binary_little_endian 1.0\n" + pile_state +
                     "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
                     "property list uchar uint vertex_indices\nend_header\n";
  const float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::uint32_t face[] = {0, 1, 2};
  text.append(reinterpret_cast<const char*>(corners), sizeof corners).append(1, '\3');
  return text.append(reinterpret_cast<const char*>(face), sizeof face);
}

// A folder may come from a stranger, and may have been run again.
TEST_F(View, ShowsVoidsOfThisPileAloneAndFollowsNoLinks) {
  const std::string state = read_state_hash(scratch / "a");
  fs::create_directories(scratch / "a/voids");
  write_file(scratch / "mine", "precious");
  fs::create_symlink(scratch / "mine", scratch / "a/view.html.part");
  write_file(scratch / "a/voids/void_r50_1.ply", make_surface("comment pile state " + state + "\n"));
  const Outcome right = run_rubble("view " + (scratch / "a") + " --frames 0");
  ASSERT_EQ(right.exit_code, 0) << right.err;
  EXPECT_EQ(right.err, "");
  EXPECT_EQ(data_of(read_file(scratch / "a/view.html")).at("voids").size(), 1u);
  EXPECT_EQ(read_file(scratch / "mine"), "precious");
  write_file(scratch / "a/voids/void_r50_1.ply", make_surface("comment pile state 0123456789abcdef\n"));
  write_file(scratch / "a/voids/void_r50_2.ply", make_surface(""));
  const Outcome stale = run_rubble("view " + (scratch / "a") + " --frames 0");
  ASSERT_EQ(stale.exit_code, 0) << stale.err;
  EXPECT_IN("warning: 2 surfaces in " + (scratch / "a") + "/voids are of another pile, or do not say of which", stale.err);
  const std::string page = read_file(scratch / "a/view.html");
  EXPECT_TRUE(data_of(page).at("voids").empty());
  EXPECT_IN("not on this page: voids of another pile", page);
  const Outcome again = run_rubble("settle " + (scratch / "tiny.lua") + " --seed 3 --force --quiet --out " + (scratch / "a"));
  EXPECT_IN("view.html, voids were made of the earlier run", again.err);
}

TEST_F(View, SaysWhatIsWrong) {
  EXPECT_EQ(run_rubble("view " + (scratch / "none")).exit_code, 1);
  EXPECT_EQ(run_rubble("view " + (scratch / "a") + " --frames -1").exit_code, 1);
  EXPECT_EQ(run_rubble("view " + (scratch / "a") + " --out /proc/none/page.html").exit_code, 2);
  write_file(scratch / "a/pile.bin", "no pile");
  const Outcome damaged = run_rubble("view " + (scratch / "a"));
  EXPECT_EQ(damaged.exit_code, 1);
  EXPECT_IN("pile.bin", damaged.err);
}

// Chromium draws it without a window and a graphics card.
TEST_F(NightlyView, IsDrawnByABrowser) {
  if (std::system("command -v chromium >/dev/null") != 0) GTEST_SKIP() << "chromium is not installed";
  ASSERT_EQ(run_rubble("voids " + (scratch / "a") + " --voxel 0.05 --radius 0.05 --quiet").exit_code, 0);
  ASSERT_EQ(run_rubble("view " + (scratch / "a")).exit_code, 0);
  const std::string browser = "chromium --headless --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader "
                              "--virtual-time-budget=20000 --user-data-dir=" + (scratch / "profile") + " ";
  const std::string page = "'file://" + (scratch / "a/view.html") + "' ";
  ASSERT_EQ(std::system((browser + "--dump-dom " + page + ">" + (scratch / "dom") + " 2>" + (scratch / "err")).c_str()), 0)
      << read_file(scratch / "err");
  const std::string dom = read_file(scratch / "dom");
  EXPECT_NE(dom.find("data-state=\"drawn\""), std::string::npos) << dom.substr(0, 1000) << read_file(scratch / "err");
  EXPECT_NE(dom.find("16 pieces, "), std::string::npos);
  ASSERT_EQ(std::system((browser + "--window-size=640,480 --screenshot=" + (scratch / "shot.png") + " " + page +
                         ">/dev/null 2>" + (scratch / "err")).c_str()), 0);
  // The bricks: not the background's colour in the middle of the picture.
  const RgbImage shot = read_rgb_png(scratch / "shot.png");
  int other = 0;
  for (int y = shot.height / 4; y < 3 * shot.height / 4; ++y)
    for (int x = shot.width / 2; x < 3 * shot.width / 4; ++x) {
      const std::uint8_t* p = &shot.rgb[std::size_t((y * shot.width + x) * 3)];
      other += std::abs(p[0] - 0xe9) + std::abs(p[1] - 0xec) + std::abs(p[2] - 0xef) > 120;
    }
  EXPECT_GT(other, 500);
}

TEST(Preview, SaysSizeBeforeAndTimeAfterAFirstRun) {
  const ScratchFolder scratch;
  write_file(scratch / "tiny.lua", kTinyMission);
  const std::string cache = "RUBBLE_CACHE=" + (scratch / "cache");
  const std::string run = "run " + (scratch / "tiny.lua") + " --out " + (scratch / "a");
  const Outcome before = run_rubble(run + " --preview", cache);
  EXPECT_EQ(before.exit_code, 0) << before.err;
  EXPECT_IN("16 pieces, 3 frames; at most ", before.out);
  EXPECT_IN("time not known: nothing like it was run here yet", before.out);
  EXPECT_IN("mission.bag ", before.out);
  EXPECT_FALSE(fs::exists(scratch / "a")) << "nothing is run";
  const Outcome first = run_rubble(run, cache);
  EXPECT_EQ(first.exit_code, 0) << first.err;
  EXPECT_IN("16 pieces, 3 frames; at most ", first.err);
  const Outcome after = run_rubble(run + " --preview", cache);
  EXPECT_IN(" s by earlier runs here", after.out);
  // A run of three small pictures tells nothing of one that is much larger, or path traced; nor do two layers of twelve, the
  // last of which fall on all before: six times the pieces, 26 times the work.
  for (const char* larger : {" --set trajectory.rate_hz=800", " --set camera.width=4000",
                             " --set camera.quality=reference", " --set pile.layers=50", " --set pile.layers=12"})
    EXPECT_IN("time not known", run_rubble(run + " --preview" + larger, cache).out) << larger;
  const Outcome pile = run_rubble("settle " + (scratch / "tiny.lua") + " --preview --out " + (scratch / "b"), cache);
  EXPECT_EQ(pile.exit_code, 0);
  EXPECT_EQ(pile.out.find("frames"), std::string::npos) << pile.out;
  EXPECT_EQ(pile.out.find("mission.bag"), std::string::npos) << pile.out;
}

}  // namespace view_test
}  // namespace rubble::testing
