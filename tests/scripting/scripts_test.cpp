// Every bundled script loads, and says what it is there to show.
#include <gtest/gtest.h>

#include <set>

#include "scripting/mission.h"
#include "tests/scripting/bundled_missions.h"

namespace rubble {
namespace scripts_test {

const std::string kScripts = RUBBLE_SOURCE_DIR "/scripts";

std::set<std::string> bundled_scripts() { return testing::find_bundled_missions(kScripts); }

Mission load(const std::string& name) { return load_mission(kScripts + "/" + name); }

TEST(Scripts, AllLoadAndSample) {
  const auto names = bundled_scripts();
  EXPECT_GE(names.size(), 36u);
  for (const std::string& name : names) {
    const Mission mission = load(name);
    EXPECT_NO_THROW(mission.scenario.validate()) << name;
    if (!mission.scenario.trajectory.needs_pile()) {
      EXPECT_GE(sample_trajectory(mission.scenario.trajectory, 1).size(), 1u) << name;
    }
    EXPECT_EQ(mission.script.text.rfind("-- ", 0), 0u) << name << " does not say what it shows";
  }
}

TEST(Scripts, StateNothingInVain) {
  for (const std::string& name : bundled_scripts()) {
    const Mission mission = load_mission(std::string(kScripts) + "/" + name);
    for (const Diagnostic& idle : mission.idle_keys) ADD_FAILURE() << idle.text();
  }
}

// "Lamp alone": the sun has its own strength, whatever else a mission states.
TEST(Scripts, WhatIsCalledDarkIsNight) {
  int dark = 0;
  for (const std::string& name : bundled_scripts()) {
    if (name.find("rubble50") == std::string::npos || name.find("_dark_") == std::string::npos) continue;
    const Scenario s = load(name).scenario;
    EXPECT_EQ(s.lights[0].spec.type, LightType::sun) << name;
    EXPECT_LE(resolve_light(s).elevation_deg, -18) << name;
    EXPECT_TRUE(s.lamp.on) << name;
    ++dark;
  }
  EXPECT_EQ(dark, 10);
}

TEST(Scripts, TheFirstPileIsLargeEnough) {
  const Scenario s = load("first_pile.lua").scenario;
  EXPECT_GE(s.pile.layers * s.pile.pieces_per_layer, 1200);
  EXPECT_EQ(s.cameras[0].camera.width, 1024);
  EXPECT_EQ(s.cameras[0].camera.height, 1024);
  EXPECT_EQ(s.trajectory.rate_hz, 30);
  EXPECT_GE(sample_trajectory(s.trajectory, s.start_ns).size(), 90u);
  EXPECT_FALSE(s.pile.placed.empty());
}

// The numbers of the published demonstration.
TEST(Scripts, ThePaperIsAsPublished) {
  for (const auto& [name, frames] : {std::pair{"paper/exterior.lua", 126},
                                     std::pair{"paper/void_dark.lua", 88},
                                     std::pair{"paper/void_lit.lua", 157}}) {
    const Scenario s = load(name).scenario;
    EXPECT_EQ(s.pile.layers, 15) << name;
    EXPECT_EQ(s.pile.layers * s.pile.pieces_per_layer, 3750) << name;
    ASSERT_TRUE(s.trajectory.duration) << name;
    EXPECT_EQ(int(*s.trajectory.duration * s.trajectory.rate_hz + 1e-6) + 1, frames) << name;
  }
}

TEST(Scripts, SmallIsSmall) {
  const Scenario s = load("small.lua").scenario;
  EXPECT_EQ(s.pile.layers * s.pile.pieces_per_layer, 40);
  EXPECT_EQ(s.cameras[0].camera.width, 160);
  EXPECT_EQ(s.cameras[0].camera.height, 120);
  EXPECT_EQ(sample_trajectory(s.trajectory, s.start_ns).size(), 5u);
}

TEST(Scripts, FeaturesAreShown) {
  EXPECT_EQ(load("lights.lua").scenario.lights[0].spec.type, LightType::spot);
  EXPECT_TRUE(load("random_light.lua").scenario.lights[0].random_rotation);
  EXPECT_GT(load("fog.lua").scenario.air.fog_density, 0);
  EXPECT_EQ(load("dusk.lua").scenario.lights[0].spec.type, LightType::sun);
  EXPECT_EQ(load("dusk.lua").scenario.lights.size(), 3u);
  EXPECT_EQ(load("reference.lua").scenario.cameras[0].camera.colour.quality, RenderQuality::reference);
  EXPECT_GT(load("dust.lua").scenario.air.dust.period, 0);
  EXPECT_TRUE(load("record_settling.lua").scenario.record_settling.on);
  EXPECT_EQ(load("rain.lua").scenario.settle.schedule, Schedule::planes);
  EXPECT_EQ(load("straight_legs.lua").scenario.trajectory.interpolation, Interpolation::linear);
  EXPECT_EQ(load("outputs.lua").scenario.outputs.depth, DepthEncoding::metres);
  EXPECT_EQ(load("fisheye.lua").scenario.cameras[0].camera.intrinsics().lens, LensModel::fisheye);
  EXPECT_EQ(load("distortion.lua").scenario.cameras[0].camera.intrinsics().distortion[0], -0.29);
  EXPECT_GT(load("stereo.lua").scenario.cameras[0].camera.stereo_baseline, 0);
  EXPECT_TRUE(load("blur.lua").scenario.cameras[0].camera.shutter.motion_blur);
  EXPECT_GT(load("rolling_shutter.lua").scenario.cameras[0].camera.shutter.readout, 0);
  EXPECT_EQ(load("exposure.lua").scenario.cameras[0].camera.exposure.mode, ExposureMode::automatic);
  EXPECT_EQ(load("skies.lua").scenario.lights[0].sky.type, SkyType::cloudy);
  EXPECT_TRUE(load("optics.lua").scenario.cameras[0].camera.optics.any());
  EXPECT_EQ(load("depth_sensor.lua").scenario.cameras[0].depth_sensor.type, DepthSensorType::structured_light);
  EXPECT_TRUE(load("events.lua").scenario.cameras[0].event_camera.on);
  EXPECT_EQ(load("published_names.lua").scenario.pile.layers, 2);
}

}  // namespace scripts_test
}  // namespace rubble
