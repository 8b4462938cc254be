// Frames are the same with no cache, a cold one, a warm one and a damaged one, and whatever was
// seen before.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "kernel/base/hash.h"
#include "render/devices/software/software_device.h"
#include "render/lighting/bake.h"
#include "render/renderer.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace cache_test {

namespace fs = std::filesystem;

RenderOptions options_with(const std::string& folder, int bake_rays) {
  RenderOptions options;
  options.bake_rays = bake_rays;
  options.shadow_size = 256;
  options.texture_size = 64;
  options.cache_folder = folder;
  return options;
}

std::string hash_of(const Frame& frame) {
  StateHash hash;
  hash.add_bytes(frame.rgb.data(), frame.rgb.size());
  hash.add_bytes(frame.depth.data(), frame.depth.size() * sizeof(float));
  return hex64(hash.digest());
}

std::string draw(const Scene& scene, const std::string& folder) {
  SoftwareDevice device;
  Renderer renderer(device, scene, options_with(folder, 16));
  return hash_of(renderer.render(look_at({4, 1, 1.2}, {0, 0, 0.7}), pinhole(160, 120, 100), 0, 0));
}

std::size_t entries(const fs::path& folder) {
  std::size_t count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    count += entry.is_regular_file();
  return count;
}

TEST(RenderCache, NeverChangesAFrame) {
  const fs::path folder =
      fs::temp_directory_path() / ("rubble_render_cache_" + std::to_string(getpid()));
  fs::remove_all(folder);
  Scene scene = make_heap(30, 11);
  scene.air.fog_density = 0.1;
  const std::string without = draw(scene, "");
  EXPECT_EQ(draw(scene, folder.string()), without) << "cold";
  ASSERT_EQ(entries(folder),
            4u);  // textures, what all points throw back, the light of pieces, and the air's
  EXPECT_EQ(draw(scene, folder.string()), without) << "warm";
  EXPECT_EQ(entries(folder), 4u);
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    std::fstream file(entry.path(), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(std::streamoff(fs::file_size(entry.path()) / 2));
    file.put('!').put('?');
  }
  EXPECT_EQ(draw(scene, folder.string()), without) << "damaged";
  // Another light is another entry, not the old one.
  scene.light.intensity = 30;
  const std::string brighter = draw(scene, "");
  EXPECT_NE(brighter, without);
  EXPECT_EQ(draw(scene, folder.string()), brighter);
  EXPECT_EQ(entries(folder), 7u);
  EXPECT_EQ(draw(scene, "/proc/no/such/folder"), brighter) << "not to be written";
  fs::remove_all(folder);
}

// The light of a piece is found when it is first seen. From this side and from that, with a lamp in
// fog, and past something that moves.
class LightOfPieces : public ::testing::TestWithParam<const char*> {
 protected:
  static constexpr std::int64_t kNow = 500000000;  // unit: ns

  LightOfPieces() : scene_(make_heap(40, 12)) {
    const std::string kind = GetParam();
    if (kind == "fog") scene_.air.fog_density = 0.1;
    if (kind == "motion") add_mover();
  }
  // The last piece goes along above the others.
  void add_mover() {
    scene_.motion.moving = {std::uint32_t(scene_.instances.size() - 1)};
    scene_.motion.reach = {{-1, 0, 2.2}, {1, 0, 2.2}};
    scene_.motion.poses_at = [](std::int64_t stamp_ns) {
      return std::vector<std::optional<Pose>>{Pose{{}, {double(stamp_ns) * 2e-9 - 1, 0, 2.2}}};
    };
  }
  static std::string from_the_left(Renderer& r) { return shot(r, {4, 1, 1.2}); }
  static std::string from_the_right(Renderer& r) { return shot(r, {-4, -1, 1.0}); }
  static std::string shot(Renderer& r, const Vec3& eye) {
    return hash_of(r.render(look_at(eye, {0, 0, 0.7}), pinhole(160, 120, 100), 0, kNow));
  }

  Scene scene_;
  SoftwareDevice device_;
};

TEST_P(LightOfPieces, DoesNotDependOnWhatWasSeenBefore) {
  const fs::path folder =
      fs::temp_directory_path() / ("rubble_light_of_pieces_" + std::to_string(getpid()));
  fs::remove_all(folder);
  std::string alone, left;
  {
    Renderer renderer(device_, scene_, options_with("", 64));
    alone = from_the_right(renderer);
  }
  {
    Renderer renderer(device_, scene_, options_with(folder.string(), 64));
    left = from_the_left(renderer);
    EXPECT_NE(left, alone);
    EXPECT_EQ(from_the_right(renderer), alone) << "after the other side";
  }
  fs::remove_all(folder);
  {
    Renderer renderer(device_, scene_, options_with(folder.string(), 64));
    EXPECT_EQ(from_the_left(renderer), left);
  }
  {
    Renderer renderer(device_, scene_, options_with(folder.string(), 64));
    EXPECT_EQ(from_the_right(renderer), alone) << "with the light of the other side in the cache";
    EXPECT_EQ(from_the_left(renderer), left);
  }
  fs::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(Kinds, LightOfPieces, ::testing::Values("day", "fog", "motion"),
                         [](const auto& of) { return std::string(of.param); });

TEST(LightBake, FindsEachPieceApartAsAllAtOnce) {
  const Scene scene = make_heap(30, 11);
  const PreparedScene prepared = prepare_scene(scene, 2);
  SceneRays rays(prepared);
  const LightSet light = make_lights(scene);
  BakeOptions options;
  options.rays = 64;
  const auto grey = [](const RayScene::Triangle&, float, float) { return Vec3f(0.5f, 0.4f, 0.3f); };
  LightBake all(prepared, rays, light, grey, options), apart(prepared, rays, light, grey, options);
  EXPECT_EQ(all.light_all().size(), prepared.placed.size());
  EXPECT_TRUE(all.light_all().empty());
  for (std::uint32_t piece = std::uint32_t(prepared.placed.size()); piece-- > 0;) {
    EXPECT_FALSE(apart.knows_all());
    EXPECT_EQ(apart.light_pieces({piece, piece}), std::vector<std::uint32_t>{piece});
  }
  EXPECT_TRUE(apart.knows_all());
  const auto bytes = [](const LightTable& nodes) {
    return std::string(reinterpret_cast<const char*>(nodes.data()),
                       nodes.size() * sizeof(BakedLight));
  };
  EXPECT_TRUE(bytes(all.nodes()) == bytes(apart.nodes()));
  EXPECT_NE(bytes(all.nodes()), std::string(all.nodes().size() * sizeof(BakedLight), 0));
}

}  // namespace cache_test
}  // namespace rubble::testing
