// What judge_scenes gives another renderer: the sky, the pieces' colours, and only scenes that both can mean.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "app/assets/asset_library.h"
#include "app/scene/build_scene.h"
#include "bench/images/judged_view.h"
#include "bench/images/sky_panorama.h"
#include "io/base/atomic_file.h"
#include "kernel/base/error.h"
#include "kernel/settling/generator.h"
#include "kernel/settling/settle.h"
#include "scripting/mission.h"

namespace rubble {
namespace judged_view_test {

namespace fs = std::filesystem;

TEST(SkyPanorama, LightsLevelGroundAsTheSkyDoes) {
  SkySpec clouds;
  clouds.type = SkyType::cloudy;
  for (const double elevation : {3.0, 40.0}) {
    for (const SkySpec& spec : {SkySpec(), clouds}) {
      const Sky sky = make_sky_light(spec, elevation, sun_direction(elevation, 70), 5).sky;
      const Vec3 mean = make_sky_panorama(sky, 512).mean();
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(mean[i] / double(sky.mean[i]), 1, 0.01) << elevation;
    }
  }
}

TEST(SkyPanorama, HasTheSunsSideWhereOtherProgramsLookForIt) {
  for (const double azimuth : {-120.0, 0.0, 70.0}) {
    const Sky sky = make_clear_sky(10, sun_direction(10, azimuth), 1);
    const SkyPanorama panorama = make_sky_panorama(sky, 180);
    float most = 0;
    int column = 0;
    const std::size_t row = 80;  // elevation 9.5 degrees
    for (int x = 0; x < panorama.width; ++x) {
      const float green = panorama.rgb[(row * 360 + std::size_t(x)) * 3 + 1];
      if (green > most) most = green, column = x;
    }
    EXPECT_NEAR(column + 0.5, 180 - azimuth, 4) << azimuth;
    EXPECT_EQ(panorama.rgb[(90 * 360 + 17) * 3], 0) << "below the horizon it is black";
    EXPECT_GT(panorama.rgb[(89 * 360 + 17) * 3], 0);
  }
}

TEST(PortableFloatMap, HasTheLastRowFirst) {
  const std::string bytes = encode_pfm(1, 2, {{1, 2, 3}, {4, 5, 6}});
  EXPECT_EQ(bytes.substr(0, 12), "PF\n1 2\n-1.0\n");
  ASSERT_EQ(bytes.size(), 12u + 24u);
  float first = 0;
  std::memcpy(&first, bytes.data() + 12, sizeof first);
  EXPECT_EQ(first, 4);
}

// A brick wall and a box of timber on the ground, seen from above.
class JudgedViewTest : public ::testing::Test {
 protected:
  static constexpr const char* kMission = R"(return rubble.mission {
    seed = 2,
    pile = { layers = 0, placed = {
      { box = { 0.2, 2, 1 }, position = { 0, 0, 0.5 }, material = "brick" },
      { box = { 0.5, 0.5, 0.5 }, position = { 1, 0, 0.25 }, material = "timber" },
    } },
    light = { rpy_deg = { 0, 48, 60 } }, lamp = { on = false },
    camera = { fov_deg = 40 },
    trajectory = { waypoints = { { position = { 2.5, 0.1, 2.5 }, look_at = { 0.5, 0, 0.2 } } } },
  })";

  JudgedView make(std::vector<std::string> set = {}) {
    MissionOptions changes;
    changes.overrides = std::move(set);
    const Mission mission = load_mission_text(kMission, "judged.lua", changes);
    assets_ = load_assets(mission, {});
    const PileState pile =
        settle_pile(generate_pile(build_pile_spec(mission.scenario.pile, mission.scenario.seed, assets_)), mission.scenario.settle);
    JudgeOptions options;
    options.size = 24, options.samples = 4;
    return JudgedView(mission.scenario, assets_, pile, options);
  }

  AssetLibrary assets_;
};

nlohmann::json materials_of(const std::string& glb) {
  std::uint32_t size = 0;
  std::memcpy(&size, glb.data() + 12, sizeof size);
  return nlohmann::json::parse(glb.substr(20, size)).at("materials");
}

TEST_F(JudgedViewTest, IsWrittenWithTheColoursThatWereTraced) {
  const JudgedView view = make();
  const TracedImage image = view.trace();
  const std::string folder = ::testing::TempDir() + "judged_view";
  fs::create_directories(folder);
  view.write(folder, "wall", image, 1.5);
  const auto json = nlohmann::json::parse(read_whole_file(folder + "/wall.json"));
  std::vector<Vec3f> colours{view.model().colour_of("ground")};
  for (int i = 0; i < 3; ++i) EXPECT_EQ(json.at("ground").at("colour").at(std::size_t(i)), colours[0][i]);
  const std::string glb = read_whole_file(folder + "/" + json.at("mesh").get<std::string>());
  for (const auto& material : materials_of(glb)) {
    const auto& c = material.at("pbrMetallicRoughness").at("baseColorFactor");
    colours.push_back({c.at(0).get<float>(), c.at(1).get<float>(), c.at(2).get<float>()});
    EXPECT_GT(std::fabs(colours.back().x - colours.back().z), 0.1f) << "brick and timber are no grey";
  }
  ASSERT_EQ(colours.size(), 3u);
  std::vector<int> seen(colours.size(), 0);
  int edges = 0;  // between surfaces: a mixture
  for (const Vec3f& albedo : image.albedo) {
    bool known = false;
    for (std::size_t i = 0; i < colours.size(); ++i)
      if (norm(albedo - colours[i]) < 1e-5f) known = true, ++seen[i];
    edges += !known;
  }
  for (const int count : seen) EXPECT_GT(count, 20);
  EXPECT_LT(edges, 24 * 24 / 4);
  fs::remove_all(folder);
}

TEST_F(JudgedViewTest, RefusesWhatTheRenderersDoNotShare) {
  EXPECT_THROW(make({"air.fog_density=0.1"}), RunError);
  EXPECT_THROW(make({"light.type=point"}), RunError);
  EXPECT_THROW(make({"camera.lens.model=plumb_bob", "camera.lens.k1=-0.2"}), RunError);
  EXPECT_THROW(make({"trajectory.waypoints[1].look_at=-9,0,2.6"}).trace(), RunError);  // the sky
}

}  // namespace judged_view_test
}  // namespace rubble
