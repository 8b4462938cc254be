// Frames are the same with no cache, a cold one, a warm one and a damaged one.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "kernel/base/hash.h"
#include "render/devices/software/software_device.h"
#include "render/renderer.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace cache_test {

namespace fs = std::filesystem;

std::string draw(const Scene& scene, const std::string& folder) {
  RenderOptions options;
  options.bake_rays = 16;
  options.shadow_size = 256;
  options.texture_size = 64;
  options.cache_folder = folder;
  SoftwareDevice device;
  Renderer renderer(device, scene, options);
  const Frame frame =
      renderer.render(look_at({4, 1, 1.2}, {0, 0, 0.7}), pinhole(160, 120, 100), 0, 0);
  StateHash hash;
  hash.add_bytes(frame.rgb.data(), frame.rgb.size());
  hash.add_bytes(frame.depth.data(), frame.depth.size() * sizeof(float));
  return hex64(hash.digest());
}

std::size_t entries(const fs::path& folder) {
  std::size_t count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) count += entry.is_regular_file();
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
  ASSERT_EQ(entries(folder), 2u);  // textures and light
  EXPECT_EQ(draw(scene, folder.string()), without) << "warm";
  EXPECT_EQ(entries(folder), 2u);
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
  EXPECT_EQ(entries(folder), 3u);
  EXPECT_EQ(draw(scene, "/proc/no/such/folder"), brighter) << "not to be written";
  fs::remove_all(folder);
}

}  // namespace cache_test
}  // namespace rubble::testing
