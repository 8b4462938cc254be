// The streams of one recording agree on when each begins and ends: by rosbag, and by a session that is stepped.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/control/robot_control.h"
#include "app/pipeline/stages.h"
#include "app/scene/build_scene.h"
#include "app/sensors/camera_renderers.h"
#include "app/session/session.h"
#include "render/devices/software/software_device.h"
#include "scripting/mission.h"
#include "tests/app/program.h"

namespace rubble::testing {
namespace streams_test {

using Json = nlohmann::json;
using Stamps = std::vector<std::int64_t>;

// Two bricks fall while the rig watches, then two robots start: one drives slowly, one out of the world. Rates of cameras, units
// and scanners that do not divide each other; three cameras at one place, of two qualities.
const char* const kStreams = R"(return rubble.mission {
  seed = 4,
  pile = { layers = 1, pieces_per_layer = 2, spawn_position = { 0, 0, 0.6 }, spawn_bounds = { 0.5, 0.5, 0.5 }, mix = { { asset = "brick" } } },
  settle = { lost_beyond = 4 },
  record_settling = { rate_hz = 5 },
  robots = { rubble.robot.rover { name = "scout", position = { 1.5, -1, 0.001 }, drive = { { t = 0, linear = 0.2 } } },
             rubble.robot.rover { name = "gone", position = { 3.2, 1, 0.001 }, drive = { { t = 0, linear = 0.5 } } } },
  robot_run = { duration = 1.5 },
  cameras = {
    fast = { width = 48, height = 36 }, draft = { width = 48, height = 36, quality = "draft" },
    again = { width = 48, height = 36, quality = "fast" },
    riding = { width = 16, height = 16, rate_hz = 7, ride = { robot = "scout" }, position = { 0.2, 0, 0.25 } },
    lost = { width = 16, height = 16, rate_hz = 10, ride = { robot = "gone" }, position = { 0.2, 0, 0.25 } },
  },
  imus = { unit = { rate_hz = 150, ride = { robot = "scout" } }, lost_unit = { ride = { robot = "gone" } }, flown = {} },
  lidars = { scan = { model = "utm30lx", rate_hz = 7, ride = { robot = "scout" }, position = { 0, 0, 0.5 } } },
  trajectory = { rate_hz = 4, waypoints = { { t = 0, position = { -2, 0, 1 }, look_at = { 0, 0, 0 } },
                                            { t = 0.6, position = { -2, 0, 1 }, look_at = { 0, 0, 0 } } } },
  outputs = { rawlog = false, simplemap = false, stl = false, preview = false },
})";

class Streams : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new ScratchFolder;
    write_file(*folder_ / "m.lua", kStreams);
    outcome_ = run_rubble("run " + (*folder_ / "m.lua") + " --quiet --out " + (*folder_ / "out"));
    const std::string read = "/usr/bin/python3 '" RUBBLE_SOURCE_DIR "/tests/app/read_cameras.py' " + (*folder_ / "out/mission.bag") +
                             " >" + (*folder_ / "read") + " 2>&1";
    read_ = std::system(read.c_str()) == 0 ? Json::parse(read_file(*folder_ / "read"), nullptr, false)["headers"] : Json();
  }
  static void TearDownTestSuite() { delete folder_; }
  void SetUp() override {
    ASSERT_EQ(outcome_.exit_code, 0) << outcome_.err;
    ASSERT_TRUE(read_.is_object()) << read_file(*folder_ / "read");
  }
  static Stamps stamps(const std::string& topic) {
    const auto found = read_.find(topic);
    EXPECT_NE(found, read_.end()) << topic;
    return found == read_.end() ? Stamps{0} : found->at("stamps").get<Stamps>();
  }
  static Stamps pictures(const std::string& camera) { return stamps("/" + camera + "/rgb/camera_info"); }

  static ScratchFolder* folder_;
  static Outcome outcome_;
  static Json read_;
};
ScratchFolder* Streams::folder_ = nullptr;
Outcome Streams::outcome_;
Json Streams::read_;

TEST_F(Streams, RobotsAndWhatTheyCarryStartWithTheFlight) {
  const Stamps rig = pictures("fast");
  const std::int64_t start = pictures("riding").front();
  EXPECT_LT(rig.front(), start) << "the rig watches the bricks fall";
  EXPECT_NE(std::find(rig.begin(), rig.end(), start), rig.end()) << "the flight starts with the robots";
  for (const char* topic : {"/scout/joint_states", "/scout/odom", "/gone/ground_truth/odom", "/unit", "/scan"})
    EXPECT_EQ(stamps(topic).front(), start) << topic;
  EXPECT_EQ(stamps("/flown").front(), rig.front());
}

TEST_F(Streams, RobotsAndUnitsLastUntilTheLastPicture) {
  const std::int64_t last = pictures("riding").back();
  for (const char* topic : {"/scout/joint_states", "/scout/odom", "/unit"}) EXPECT_GE(stamps(topic).back(), last) << topic;
  const Stamps scans = stamps("/scan");
  ASSERT_GT(scans.size(), 2u);
  EXPECT_LE(scans.back() + scans[1] - scans[0], stamps("/unit").back() + 1000) << "a scan that no unit can undistort";
}

TEST_F(Streams, WhatIsOnTheRigEndsWithItsPath) {
  const std::int64_t end = pictures("riding").front() + 600'000'000;
  EXPECT_LE(stamps("/flown").back(), end + 1000);
  EXPECT_GE(stamps("/flown").back(), pictures("fast").back());
  EXPECT_GT(pictures("riding").back(), end) << "nothing was tested";
}

TEST_F(Streams, WhatALostRobotCarriesEndsWithIt) {
  const std::int64_t lost = stamps("/gone/joint_states").back(), period = 1'000'000'000 / 60;
  EXPECT_LT(lost, stamps("/scout/joint_states").back() - period) << "it was to be lost";
  for (const char* topic : {"/lost/rgb/camera_info", "/lost_unit", "/lost/ground_truth/pose"}) {
    EXPECT_LE(stamps(topic).back(), lost + period) << topic;
    EXPECT_GT(stamps(topic).back(), lost - 200'000'000) << topic;
  }
  EXPECT_NE(outcome_.err.find("robot gone was lost"), std::string::npos) << outcome_.err;
}

TEST_F(Streams, EveryCameraHasItsTruePose) {
  EXPECT_EQ(stamps("/riding/ground_truth/pose"), pictures("riding"));
  EXPECT_EQ(stamps("/ground_truth/pose"), pictures("fast"));
}

TEST_F(Streams, ThePathIsThatOfTheRig) {
  const Json metrics = Json::parse(read_file(*folder_ / "out/manifest.json"))["metrics"];
  EXPECT_LT(metrics["path_m"].get<double>(), 1e-9) << "the rig stands";
  EXPECT_GT(metrics["robot_path_m"].get<double>(), 0.3);
}

// The mission, settled in memory.
class StreamsInMemory : public ::testing::Test {
 protected:
  void SetUp() override {
    write_file(scratch_ / "m.lua", kStreams);
    RunRequest request;
    request.mission = scratch_ / "m.lua";
    mission_ = resolve_mission(request, RunKind::run, context_);
    pile_ = settle_in_memory(mission_, context_, [] { return true; }).state;
  }
  static RunOptions quiet() {
    RunOptions options;
    options.quiet = true;
    return options;
  }
  std::size_t camera(const std::string& name) const {
    const auto& all = mission_.scenario.cameras;
    return std::size_t(std::find_if(all.begin(), all.end(), [&](const MountedCamera& c) { return c.name == name; }) - all.begin());
  }

  ScratchFolder scratch_;
  RunContext context_{quiet()};
  ResolvedMission mission_;
  PileState pile_;
};

// While they are driven: none of what is lost.
TEST_F(StreamsInMemory, EndWithALostRobot) {
  SessionOptions observed;
  observed.observed = true;
  Session session(mission_, pile_, make_robots(mission_, context_), context_, observed);
  session.start();
  std::map<int, std::int64_t> robots;          // the last stamp of each
  std::map<std::string, std::int64_t> units;  // likewise
  for (std::int64_t i = 0; i < session.steps_of_mission(); ++i) {
    session.step();
    for (const Sample& sample : session.observe()) {
      if (const auto* robot = std::get_if<RobotSample>(&sample)) robots[robot->sensor] = robot->stamp_ns;
      if (const auto* unit = std::get_if<ImuSample>(&sample))
        units[mission_.scenario.imus[std::size_t(unit->sensor)].name] = unit->stamp_ns;
    }
  }
  ASSERT_EQ(robots.size(), 2u);
  EXPECT_LT(robots[1], robots[0] - 100'000'000) << "it was to be lost";
  EXPECT_LE(units["lost_unit"], robots[1] + 1'000'000'000 / 60);
  EXPECT_GT(units["lost_unit"], robots[1] - 50'000'000);
  EXPECT_GT(units["unit"], robots[0] - 50'000'000) << "the other goes on";
}

// One renderer for each quality, which draws as if there were no other.
TEST_F(StreamsInMemory, EachCameraHasItsOwnQuality) {
  SoftwareDevice device;
  const std::vector<MountedCamera>& cameras = mission_.scenario.cameras;
  Scene scene = build_scene(mission_.scenario, mission_.assets, pile_);
  scene.air.fog_density = 0.1;  // drafts scatter light once
  CameraRenderers renderers(scene, cameras, {}, device, {});
  Renderer &fast = renderers.of(camera("fast")), &draft = renderers.of(camera("draft"));
  EXPECT_EQ(&fast, &renderers.of(camera("again")));
  const auto draw = [&](Renderer& renderer) {
    const Intrinsics k = cameras[camera("fast")].camera.intrinsics();
    return renderer.render({{}, {-2, 0, 0.5}}, k, 0, mission_.scenario.start_ns).rgb;
  };
  const auto as_fast = draw(fast), as_draft = draw(draft);
  EXPECT_NE(as_fast, as_draft);
  ColourSpec colour;
  EXPECT_EQ(as_fast, draw(*prepare_renderer(scene, colour, device, {})));
  colour.quality = RenderQuality::draft;
  EXPECT_EQ(as_draft, draw(*prepare_renderer(scene, colour, device, {})));
}

TEST(StreamsInput, SomebodyMustWatchThePileSettle) {
  const auto error_of = [](const std::string& more) -> std::string {
    try {
      load_mission_text("return rubble.mission { robots = { rubble.robot.rover { name = \"r\" } },\nrecord_settling = true,\n" + more +
                            " }\n", "m.lua");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const std::string refused = "m.lua:2: record_settling: robots start when the pile rests, and every camera is on a robot";
  EXPECT_NE(error_of("trajectory = { ride = { robot = \"r\" } }").find(refused), std::string::npos);
  EXPECT_NE(error_of("cameras = { a = { ride = { robot = \"r\" } } }").find(refused), std::string::npos);
  EXPECT_EQ(error_of("cameras = { a = {}, b = { ride = { robot = \"r\" } } }"), "");
}

}  // namespace streams_test
}  // namespace rubble::testing
