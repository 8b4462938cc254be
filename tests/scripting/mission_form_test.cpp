// What users may write in two ways is the same list afterwards; names, keys and the JSON of a mission follow the way.
#include "scripting/scenario/mission_form.h"

#include <gtest/gtest.h>

#include "tests/scripting/test_support.h"

namespace rubble {
namespace mission_form_test {

Scenario load(const std::string& keys) { return load_text("return rubble.mission { " + keys + " }").scenario; }

void expect_same_json(const Scenario& s) {
  const std::string json = scenario_to_json(s);
  EXPECT_EQ(scenario_to_json(scenario_from_json(json, "s.json")), json);
}

TEST(MissionForm, OneCameraIsAListWithoutNames) {
  const Scenario s = load("camera = { width = 64 }, depth_sensor = { type = \"ideal\" }, event_camera = { on = true }");
  ASSERT_EQ(s.cameras.size(), 1u);
  const MountedCamera& camera = s.cameras[0];
  EXPECT_EQ(camera.camera.width, 64);
  EXPECT_EQ(camera.depth_sensor.type, DepthSensorType::ideal);
  EXPECT_TRUE(camera.event_camera.on);
  EXPECT_FALSE(s.names_cameras());
  EXPECT_EQ(camera.key(), "camera");
  EXPECT_EQ(camera.topic(), "/camera");
  EXPECT_EQ(camera.frame_id(), "camera_optical_frame");
  EXPECT_EQ(camera.folder_in("out"), "out");
  expect_same_json(s);
}

TEST(MissionForm, CamerasOfATableHaveTheirNames) {
  const Scenario s = load("cameras = { camera = { width = 64, topic = \"/eye\" } }");
  ASSERT_EQ(s.cameras.size(), 1u);
  const MountedCamera& camera = s.cameras[0];
  EXPECT_EQ(camera.camera.width, 64);
  EXPECT_TRUE(s.names_cameras()) << "though it has the name that the only one has";
  EXPECT_EQ(camera.key(), "cameras.camera");
  EXPECT_EQ(camera.topic(), "/eye");
  EXPECT_EQ(camera.folder_in("out"), "out/cameras/camera");
  expect_same_json(s);
  EXPECT_NE(scenario_to_json(s), scenario_to_json(load("camera = { width = 64, topic = \"/eye\" }")));
}

TEST(MissionForm, UnitsAreAListToo) {
  EXPECT_TRUE(load("").imus.empty());
  EXPECT_TRUE(load("imu = { on = false, rate_hz = 50 }").imus.empty());
  const Scenario one = load("imu = { on = true, rate_hz = 50 }");
  ASSERT_EQ(one.imus.size(), 1u);
  EXPECT_EQ(one.imus[0].model.rate_hz, 50);
  EXPECT_EQ(one.imus[0].key(), "imu");
  EXPECT_EQ(one.imus[0].ros_topic(), "/imu");
  const Scenario several = load("imus = { head = { rate_hz = 50 }, tail = {} }");
  ASSERT_EQ(several.imus.size(), 2u);
  EXPECT_EQ(several.imus[0].key(), "imus.head");
  EXPECT_EQ(several.imus[1].ros_topic(), "/tail");
  expect_same_json(one);
  expect_same_json(several);
}

TEST(MissionForm, TheMainLightComesFirst) {
  const Scenario s = load("light = { type = \"sun\", elevation_deg = 12 }, lights = { { type = \"point\", intensity = 3 } }");
  ASSERT_EQ(s.lights.size(), 2u);
  EXPECT_EQ(s.lights[0].spec.elevation_deg, 12);
  EXPECT_EQ(s.lights[1].spec.intensity, 3);
  EXPECT_EQ(resolve_light(s).type, LightType::sun);
  expect_same_json(s);
  EXPECT_NE(mission_error("return rubble.mission { lights = { {}, {}, {}, {} } }").find("at most 3 besides the main one, found 4"),
            std::string::npos);
}

TEST(MissionForm, BothFormsOfTheSameAreAMistake) {
  const auto error = [](const std::string& keys) { return mission_error("return rubble.mission { " + keys + " }"); };
  EXPECT_NE(error("camera = { width = 64 }, cameras = { a = {} }").find("camera.width: contradicts cameras"), std::string::npos);
  EXPECT_NE(error("depth_sensor = { type = \"ideal\" }, cameras = { a = {} }").find("depth_sensor.type: contradicts cameras"),
            std::string::npos);
  EXPECT_NE(error("imu = true, imus = { a = {} }").find("imu.on: contradicts imus"), std::string::npos);
}

// The rig moves smoothly where a unit on it measures, in either form; a unit on a robot asks nothing of the rig.
TEST(MissionForm, AUnitOnTheRigSmoothsItsPath) {
  const std::string path = ", trajectory = { waypoints = { { t = 0, position = { -3, 0, 1 } }, { t = 1, position = { 3, 0, 1 } } } }";
  const std::string robot = ", robots = { { name = \"r\" } }";
  EXPECT_EQ(flown_trajectory(load("imu = true" + path)).smoothing, kUsualSmoothing);
  EXPECT_EQ(flown_trajectory(load("imus = { a = {} }" + path)).smoothing, kUsualSmoothing);
  EXPECT_EQ(flown_trajectory(load("imus = { a = { ride = { robot = \"r\" } } }" + robot + path)).smoothing, std::nullopt);
  EXPECT_EQ(flown_trajectory(load("imu = { on = true, ride = { robot = \"r\" } }" + robot + path)).smoothing, std::nullopt);
}

TEST(MissionForm, WarnsOfAnyCameraInRadians) {
  EXPECT_EQ(find_suspicious(load_text("return rubble.mission { camera = { fov_deg = 90 } }")).size(), 0u);
  const std::vector<std::string> of_one = find_suspicious(load_text("return rubble.mission { camera = { fov_deg = 1.5 } }"));
  ASSERT_EQ(of_one.size(), 1u);
  EXPECT_NE(of_one[0].find("camera.fov_deg"), std::string::npos);
  const std::vector<std::string> of_two =
      find_suspicious(load_text("return rubble.mission { cameras = { a = {}, b = { fov_deg = 1.5 } } }"));
  ASSERT_EQ(of_two.size(), 1u);
  EXPECT_NE(of_two[0].find("cameras.b.fov_deg"), std::string::npos) << of_two[0];
}

std::string sentences_of(const std::string& text, const std::vector<std::string>& settings = {}) {
  std::string sentences;
  for (const Diagnostic& idle : load_text("return rubble.mission {\n" + text + "\n}", with_overrides(settings)).idle_keys)
    sentences += idle.text() + "\n";
  return sentences;
}

TEST(MissionForm, SaysWhichKeysNothingReads) {
  EXPECT_EQ(sentences_of("light = { type = \"sun\", intensity = 30 }"),
            "m.lua:2: light.intensity: has no effect, because the sun has the illuminance of its elevation and sky\n");
  EXPECT_EQ(sentences_of("light = { type = \"sun\", elevation_deg = 30 }"), "");
  EXPECT_EQ(sentences_of("event_camera = { threshold_up = 0.3 }"),
            "m.lua:2: event_camera.threshold_up: has no effect, because event_camera.on is false\n");
  EXPECT_EQ(sentences_of("cameras = { left = {\nexposure = { mode = \"fixed\", delay = 2, time = 0.01 } } }"),
            "m.lua:3: cameras.left.exposure.delay: has no effect, because cameras.left.exposure.mode is \"fixed\"\n");
  EXPECT_EQ(sentences_of("pile = { building = { storeys = 1, kind = \"masonry\", wall = 0.3, slab = 0.2 } }"),
            "m.lua:2: pile.building.slab: has no effect, because masonry has walls and timber floors\n");
  // What is switched off on purpose may say what it likes; --set may not.
  const std::string off = "lamp = { on = false, intensity_cd = 200 }";
  EXPECT_EQ(sentences_of(off), "");
  EXPECT_EQ(sentences_of(off, {"lamp.cone_deg=40"}), "--set: lamp.cone_deg: has no effect, because lamp.on is false\n");
  EXPECT_EQ(sentences_of(off, {"lamp.cone_deg=40", "lamp.on=true"}), "");
  EXPECT_EQ(sentences_of("lamp = { intensity_cd = 200 }", {"lamp.on=false"}), "");
  EXPECT_EQ(sentences_of("lamp = { intensity_cd = 200 }", {"lamp=false"}), "");
  EXPECT_EQ(sentences_of("imu = true", {" imu = false"}), "");
  EXPECT_EQ(sentences_of("cameras = { a = { event_camera = { dark = 1 } } }", {"cameras.a.event_camera=false"}), "");
  EXPECT_NE(sentences_of("light = { type = \"sun\" }", {"lightintensity=3"}).find("--set: light.intensity: "), std::string::npos);
  EXPECT_EQ(sentences_of("air = { fog_noise = 0.5, dust = { period = 1 } }"), "");
  EXPECT_EQ(sentences_of("lights = { { type = \"point\", cone_deg = 20 } }"),
            "m.lua:2: lights[1].cone_deg: has no effect, because lights[1].type is \"point\"\n");
}

TEST(MissionForm, SaysWhichKeysARobotOfItsKindDoesNotRead) {
  EXPECT_EQ(sentences_of("robots = { { model = \"snake\", modules = 8, flippers = false } }"),
            "m.lua:2: robots[1].flippers: has no effect, because only a crawler has it\n");
  EXPECT_EQ(sentences_of("robots = { { model = \"crawler\", flippers = false, odometry_noise = 0.01 } }"), "");
  EXPECT_EQ(sentences_of("robots = { {}, { model = \"vine\", radius = 0.04,\nwheel_radius = 0.2 } }"),
            "m.lua:3: robots[2].wheel_radius: has no effect, because only a robot from a URDF file has it\n");
  EXPECT_EQ(sentences_of("robots = { { model = \"vine\", odometry_noise = 0.01 } }"),
            "m.lua:2: robots[1].odometry_noise: has no effect, because the robot has neither tracks nor driven wheels, so no odometry\n");
  EXPECT_EQ(sentences_of("robots = { { urdf = \"a.urdf\", radius = 0.1,\ntrack_speed = 2 } }"),
            "m.lua:2: robots[1].radius: has no effect, because only a vine has it\n"
            "m.lua:3: robots[1].track_speed: has no effect, because robots[1].left_tracks is empty\n");
}

TEST(MissionForm, SaysWhichKeysOfAPathACauseAndAStreetNothingReads) {
  EXPECT_EQ(sentences_of("trajectory = { radius = 0.3 }"),
            "m.lua:2: trajectory.radius: has no effect, because trajectory.plan is \"ghost\"\n");
  EXPECT_EQ(sentences_of("trajectory = rubble.trajectory.orbit { radius = 0.3 }"),
            "m.lua:2: trajectory.radius: has no effect, because trajectory.plan is \"ghost\"\n");
  EXPECT_EQ(sentences_of("trajectory = rubble.trajectory.orbit { radius = 0.3, plan = \"refuse\" }"), "");
  EXPECT_EQ(sentences_of("trajectory = rubble.trajectory.orbit { turns = 0.5 }"), "");
  EXPECT_EQ(sentences_of("trajectory = { radius = 0.3, plan = \"avoid\", waypoints = { { position = { 0, 0, 1 } }, { position = { 1, 0, 1 } } } }"),
            "");
  EXPECT_EQ(sentences_of("trajectory = { ride = { position = { 0, 0, 1 } } }"),
            "m.lua:2: trajectory.ride.position: has no effect, because trajectory.ride.robot is not given\n");
  EXPECT_EQ(sentences_of("pile = { building = { storeys = 2, cause = { overloaded_floor = 0 } } }"),
            "m.lua:2: pile.building.cause.overloaded_floor: has no effect, because pile.building.cause.overload is 0\n");
  EXPECT_EQ(sentences_of("pile = { mix = { { asset = \"a\", scale = { 1, 2 }, typical = 1.5 } } }"),
            "m.lua:2: pile.mix[1].typical: has no effect, because pile.mix[1].spread is \"uniform\"\n");
  EXPECT_EQ(sentences_of("pile = { mix = { { asset = \"a\", spread = \"normal\", typical = 1.5 } } }"), "");
  const auto about = [](const std::string& text) {
    const std::string said = sentences_of(text);
    return said.substr(0, said.find(": has no effect"));
  };
  EXPECT_EQ(about("trajectory = { duration = 3, waypoints = { { position = { 0, 0, 1 } } } }"), "m.lua:2: trajectory.duration");
  EXPECT_EQ(about("trajectory = { duration = 3, waypoints = { { position = { 0, 0, 1 } }, { position = { 1, 0, 1 } } } }"), "");
  EXPECT_EQ(about("outputs = { bag = false, depth = \"32FC1\" }"), "m.lua:2: outputs.depth");
  EXPECT_EQ(about("outputs = { bag = false, mcap = true, depth = \"32FC1\" }"), "");
  EXPECT_EQ(about("pile = { terrain = { file = \"a.obj\", spacing = 2 } }"), "m.lua:2: pile.terrain.spacing");
  EXPECT_EQ(about("pile = { terrain = { columns = 2, rows = 2, heights = { 0, 0, 0, 0 }, up = \"y\" } }"), "m.lua:2: pile.terrain.up");
  EXPECT_EQ(about("pile = { terrain = { friction = 0.5 } }"), "m.lua:2: pile.terrain.friction");
  EXPECT_EQ(about("pile = { building = { storeys = 2, cause = { vehicle = { mass = 9000, speed = 0 } } } }"), "") << "its speed is stated";
  const std::string unlit = "surroundings = { type = \"street\", lamps = \"off\", lit_windows = 0.5 }";
  EXPECT_EQ(sentences_of(unlit), "");
  EXPECT_EQ(sentences_of(unlit, {"surroundings.lit_windows=1"}),
            "--set: surroundings.lit_windows: has no effect, because surroundings.lamps is \"off\"\n");
}

}  // namespace mission_form_test
}  // namespace rubble
