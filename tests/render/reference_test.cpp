// The reference renderer as a whole: beside the fast one, denoised, interrupted.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "kernel/base/portable_math.h"
#include "render/devices/software/software_device.h"
#include "render/materials/surface_appearance.h"
#include "render/reference/denoise.h"
#include "render/reference/tile_journal.h"
#include "render/renderer.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace reference_test {

namespace fs = std::filesystem;

RenderOptions reference(int samples, int threads = 1) {
  RenderOptions options;
  options.colour.quality = RenderQuality::reference;
  options.colour.samples = samples, options.threads = threads;
  options.texture_size = 64;
  return options;
}

TEST(Reference, IsTheSameWhateverTheNumberOfThreads) {
  SoftwareDevice device;
  const auto draw = [&](int threads) {
    Renderer renderer(device, make_heap(40, 7), reference(4, threads));
    return renderer.render(look_at({4, 2, 1.5}, {0, 0, 0.5}), pinhole(80, 70, 60), 0, 1000000000).rgb;
  };
  EXPECT_TRUE(draw(1) == draw(2));
}

TEST(Reference, LeavesDepthAndChannelsAsTheyAre) {
  SoftwareDevice device;
  const StreamSet channels{find_image_stream("normals"), find_image_stream("instance"),
                           find_image_stream("label")};
  const auto draw = [&](RenderQuality quality) {
    RenderOptions options = reference(1);
    options.colour.quality = quality, options.bake_rays = 8;
    Renderer renderer(device, make_heap(40, 7), options);
    return renderer.view({1000000000, pinhole(80, 70, 60), look_at({4, 2, 1.5}, {0, 0, 0.5})})
        .into_frame(0, channels);
  };
  const Frame fast = draw(RenderQuality::fast), slow = draw(RenderQuality::reference);
  const auto bytes = [](const std::vector<float>& v) {
    return std::string(reinterpret_cast<const char*>(v.data()), v.size() * sizeof(float));
  };
  EXPECT_TRUE(bytes(fast.depth) == bytes(slow.depth));
  EXPECT_TRUE(bytes(normals_of(fast)) == bytes(normals_of(slow)));
  EXPECT_TRUE(instances_of(fast) == instances_of(slow));
  EXPECT_TRUE(labels_of(fast) == labels_of(slow));
  EXPECT_FALSE(fast.rgb == slow.rgb);
}

// A block of each look, lit from one side by a far, strong lamp: no bounce, hardly any sky. Then a
// pixel is the look's albedo and normal alone, by the shader and by the path tracer's own formulas.
Scene block_of(const std::string& look) {
  Scene scene;
  scene.ground = false;
  scene.seed = 5;
  scene.lamp.on = false;
  scene.light.type = LightType::point;
  scene.light.intensity = 1000, scene.light.position = {-4, 3, 6};
  scene.meshes.push_back(share(make_box({2, 3, 1}, look.c_str())));
  Pose pose{normalized(Quat(0.9, 0.2, -0.3, 0.1)), {3, 0.2, -0.1}};
  scene.instances.push_back({0, 1, pose, 1});
  return scene;
}

TEST(Reference, KnowsTheSurfacesOfTheShader) {
  SoftwareDevice device;
  for (const SurfaceAppearance& look : all_surface_appearances()) {
    if (look.name == std::string("ground")) continue;
    const auto draw = [&](RenderQuality quality) {
      RenderOptions options = reference(1);
      options.colour.quality = quality, options.bake = false;
      options.antialias = false;
      options.texture_size = 32;  // each texel wider than a pixel: both read the finest level
      return Renderer(device, block_of(look.name), options).render_linear({}, pinhole(64, 64, 1000));
    };
    const LinearFrame fast = draw(RenderQuality::fast), slow = draw(RenderQuality::reference);
    double sum = 0, off = 0;
    for (std::size_t i = 0; i < fast.rgb.size(); ++i) {
      if (fast.instance[i / 3] == kNoInstance) continue;
      sum += double(fast.rgb[i]), off += std::fabs(double(fast.rgb[i]) - double(slow.rgb[i]));
    }
    EXPECT_GT(sum, 100) << look.name;
    // What mirrors leave for the base is by a fit here, by tables there; most is mirrored by zinc.
    const double limit = look.reflectance > 0.2f ? 0.05 : 0.02;
    EXPECT_LT(off / sum, limit) << look.name;
  }
}

// A block behind two panes, whose depth is that of the first.
TEST(Reference, SeesThroughGlassAsMuchAsTheFastRendererDoes) {
  SoftwareDevice device;
  Scene scene = block_of("plaster");
  scene.meshes.push_back(share(make_box({0.006, 0.3, 0.3}, "glass")));
  scene.instances.push_back({1, 1, {portable::quat_from_rpy(0, 0, 0.6), {0.8, 0, 0}}, 2});
  scene.instances.push_back({1, 1, {portable::quat_from_rpy(0, 0.4, 0), {1.2, 0, 0}}, 3});
  const auto draw = [&](RenderQuality quality) {
    RenderOptions options = reference(256);
    options.colour.quality = quality, options.bake = false;
    return Renderer(device, scene, options).render_linear({}, pinhole(64, 64, 1500));
  };
  const LinearFrame fast = draw(RenderQuality::fast), slow = draw(RenderQuality::reference);
  double shown = 0, traced = 0;
  for (const float light : fast.rgb) shown += double(light);
  for (const float light : slow.rgb) traced += double(light);
  EXPECT_GT(traced, 100);
  EXPECT_NEAR(shown / traced, 1, 0.03);
  for (const float depth : fast.depth) EXPECT_NEAR(double(depth), 0.8, 0.03);
  EXPECT_EQ(fast.instance[0], 2u);
}

// The block cut in two: without a word of it two blocks with looks of their own, else nothing is seen of the cut.
Scene cut_block(const std::string& look, bool told) {
  Scene scene = block_of(look);
  const SceneInstance whole = scene.instances[0];
  scene.meshes[0] = share(make_box({2, 1.5, 1}, look.c_str()));
  scene.instances.clear();
  for (const double y : {-0.75, 0.75}) {
    SceneInstance half = whole;
    half.world_from_body.translation = whole.world_from_body * Vec3(0, y, 0);
    half.id = scene.instances.empty() ? 1 : 2;
    if (told) half.cut_from = {7, {0, y, 0}, 1};
    scene.instances.push_back(half);
  }
  return scene;
}

TEST(Reference, PiecesOfOneBodyLookLikeTheBody) {
  SoftwareDevice device;
  for (const std::string look : {"concrete_cast", "brick", "timber"}) {
    for (const RenderQuality quality : {RenderQuality::fast, RenderQuality::reference}) {
      RenderOptions options = reference(1);
      options.colour.quality = quality, options.bake = false;
      options.antialias = false;
      options.texture_size = 64;
      const auto draw = [&](const Scene& scene) {
        return Renderer(device, scene, options).render_linear({}, pinhole(64, 64, 1000));
      };
      Scene block = block_of(look);
      block.instances[0].cut_from = {7, {}, 1};
      const LinearFrame whole = draw(block), told = draw(cut_block(look, true)), untold = draw(cut_block(look, false));
      double sum = 0, off = 0, far_off = 0;
      for (std::size_t i = 0; i < whole.rgb.size(); ++i) {
        const double value = double(whole.rgb[i]);
        sum += value;
        off += std::fabs(double(told.rgb[i]) - value), far_off += std::fabs(double(untold.rgb[i]) - value);
      }
      EXPECT_GT(sum, 100) << look;
      EXPECT_LT(off / sum, 0.003) << look;
      EXPECT_GT(far_off / sum, 0.03) << look;
    }
  }
}

// A pinhole as a table of directions, with a pose for each row, is the pinhole.
TEST(Reference, SeesThroughAnyLensAndShutter) {
  SoftwareDevice device;
  RenderOptions options = reference(2);
  options.antialias = false;
  Renderer renderer(device, make_heap(40, 7), options);
  ViewRays view{1000000000, pinhole(48, 40, 40), look_at({4, 2, 1.5}, {0, 0, 0.5})};
  const LinearFrame plain = renderer.render_linear(view);
  view.directions = make_lens_directions(view.intrinsics, 1);
  view.row_poses.assign(40, view.world_from_camera * camera_from_optical);
  const LinearFrame rays = renderer.render_linear(view);
  double off = 0, sum = 0;
  for (std::size_t i = 0; i < plain.rgb.size(); ++i)
    off += std::fabs(double(plain.rgb[i]) - double(rays.rgb[i])), sum += double(plain.rgb[i]);
  EXPECT_LT(off / sum, 0.01);  // a ray that rounds the other way meets another edge
  // The lower half from a camera 1 m to the side: only there it is another image.
  for (std::size_t row = 20; row < 40; ++row) view.row_poses[row].translation.y += 1;
  const LinearFrame moved = renderer.render_linear(view);
  const auto differ = [&](std::size_t first, std::size_t last) {
    double d = 0;
    for (std::size_t i = first * 48 * 3; i < last * 48 * 3; ++i)
      d += std::fabs(double(moved.rgb[i]) - double(rays.rgb[i]));
    return d / sum;
  };
  EXPECT_EQ(differ(0, 20), 0);
  EXPECT_GT(differ(20, 40), 0.02);
}

// A block that moves is lit, and throws its shadow, where it is.
TEST(Reference, FollowsWhatMoves) {
  SoftwareDevice device;
  const auto scene_at = [](double x) {
    Scene scene;
    scene.lamp.on = false;
    scene.seed = 5;
    scene.meshes.push_back(share(make_box({0.5, 0.5, 0.5}, "plaster")));
    scene.instances.push_back({0, 1, {{}, {x, 0, 0.25}}, 1});
    // On a floor of its own: the map of the ground is that of where the block was at the start.
    scene.ground = false;
    scene.meshes.push_back(share(make_box({12, 12, 0.2}, "plaster")));
    scene.instances.push_back({1, 1, {{}, {0, 0, -0.1}}, 2});
    return scene;
  };
  Scene moving = scene_at(0);
  moving.motion.moving = {0};
  moving.motion.poses_at = [](std::int64_t stamp_ns) {
    return std::vector<std::optional<Pose>>{Pose{{}, {double(stamp_ns) * 1e-9, 0, 0.25}}};
  };
  moving.motion.reach.include({0, 0, 0}), moving.motion.reach.include({2, 0, 1});
  ViewRays view{0, pinhole(48, 48, 60), look_at({1, -2.5, 3}, {1, 0, 0})};
  const auto mean_off = [&](const LinearFrame& a, const LinearFrame& b) {
    double off = 0, sum = 0;
    for (std::size_t i = 0; i < a.rgb.size(); ++i)
      off += std::fabs(double(a.rgb[i]) - double(b.rgb[i])), sum += double(a.rgb[i]);
    return off / sum;
  };
  Renderer renderer(device, moving, reference(32));
  const LinearFrame start = renderer.render_linear(view);
  view.stamp_ns = 2000000000;
  const LinearFrame end = renderer.render_linear(view);
  const LinearFrame still = Renderer(device, scene_at(2), reference(32)).render_linear(view);
  EXPECT_GT(mean_off(start, end), 0.02);
  EXPECT_LT(mean_off(still, end), 0.1 * mean_off(start, end));
}

TEST(Reference, WithWaterIsDarkerAndMirrorsTheSky) {
  SoftwareDevice device;
  const auto draw = [&](double wetness) {
    Scene scene = make_heap(30, 7);
    scene.wetness = wetness;
    return Renderer(device, scene, reference(16)).render_linear(look_at({4, 2, 1.5}, {0, 0, 0.5}), pinhole(48, 48, 40));
  };
  const auto mean = [](const LinearFrame& f) {
    double sum = 0;
    for (std::size_t i = 0; i < f.rgb.size(); ++i)
      if (f.instance[i / 3] != kNoInstance) sum += double(f.rgb[i]);
    return sum;
  };
  const double dry = mean(draw(0)), wet = mean(draw(1));
  EXPECT_LT(wet, 0.9 * dry);
  EXPECT_GT(wet, 0.4 * dry);
}

double error_of(const std::vector<Vec3f>& light, const std::vector<Vec3f>& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < light.size(); ++i) {
    const Vec3f d = light[i] - truth[i];
    sum += double(dot(d, d));
  }
  return std::sqrt(sum / double(light.size()));
}

// Half lit, half in shadow, on a checkered floor, with noise of a known strength.
TracedImage noisy_floor(std::vector<Vec3f>& truth) {
  constexpr int kSide = 64;
  TracedImage image;
  image.width = image.height = kSide;
  const SampleSequence numbers(1, 1);
  for (int i = 0; i < kSide * kSide; ++i) {
    const int x = i % kSide, y = i / kSide;
    const float albedo = (x / 3 + y / 3) % 2 ? 0.6f : 0.2f, lit = x < kSide / 2 ? 1.0f : 0.2f;
    const float noise = numbers.pair(std::uint32_t(i), 1).x - 0.5f;  // of variance 1/12
    truth.push_back(Vec3f(1, 1, 1) * (albedo * lit));
    image.light.push_back(truth.back() * (1 + 0.3f * noise));
    image.variance.push_back(truth.back().x * truth.back().x * 0.09f / 12);
    image.albedo.push_back(Vec3f(1, 1, 1) * albedo);
    image.normal.push_back({0, 0, 1});
    image.distance.push_back(2), image.cover.push_back(1);
  }
  return image;
}

TEST(Denoise, TakesMostNoiseAndLeavesTexturesAndShadows) {
  std::vector<Vec3f> truth;
  const TracedImage image = noisy_floor(truth);
  const std::vector<Vec3f> clean = denoise_image(image, 1);
  EXPECT_LT(error_of(clean, truth), 0.3 * error_of(image.light, truth));
  EXPECT_TRUE(clean == denoise_image(image, 2));
  // Right beside the shadow's edge.
  double lit = 0, dark = 0;
  for (std::size_t y = 0; y < 64; ++y) {
    lit += double(clean[y * 64 + 31].x / image.albedo[y * 64 + 31].x) / 64;
    dark += double(clean[y * 64 + 32].x / image.albedo[y * 64 + 32].x) / 64;
  }
  EXPECT_NEAR(lit, 1, 0.05);
  EXPECT_NEAR(dark, 0.2, 0.03);
}

TEST(Denoise, TakesOutSpecksButNotSmallLights) {
  std::vector<Vec3f> truth;
  TracedImage image = noisy_floor(truth);
  const std::size_t speck = 10 * 64 + 10, spot = 40 * 64 + 15;
  image.light[speck] = {50, 50, 50}, image.variance[speck] = 2000;  // one sample of 64 found it
  image.light[spot] = {50, 50, 50}, image.variance[spot] = 0.01f;   // all samples agree on it
  const std::vector<Vec3f> clean = denoise_image(image, 1);
  EXPECT_LT(clean[speck].x, 2 * truth[speck].x);
  EXPECT_GT(clean[spot].x, 40);
}

TEST(Denoise, BringsAnImageOfFewSamplesNearerToOneOfMany) {
  SoftwareDevice device;
  const auto draw = [&](int samples, bool denoise) {
    RenderOptions options = reference(samples, 2);
    options.colour.denoise = denoise;
    Scene scene = make_heap(60, 7);
    const std::vector<float> rgb =
        Renderer(device, scene, options).render_linear(look_at({1.6, 0.3, 0.6}, {-1.5, 0, 0.5}), pinhole(40, 40, 25)).rgb;
    std::vector<Vec3f> out;
    for (std::size_t i = 0; i < rgb.size(); i += 3) out.push_back({rgb[i], rgb[i + 1], rgb[i + 2]});
    return out;
  };
  const auto truth = draw(512, false);
  EXPECT_LT(error_of(draw(16, true), truth), 0.7 * error_of(draw(16, false), truth));
}

struct Folder {
  Folder() : path(fs::temp_directory_path() / ("reference_test_" + std::to_string(std::rand()))) {
    fs::remove_all(path);
  }
  ~Folder() { fs::remove_all(path); }
  fs::path path;
};

TEST(Reference, GoesOnWhereItWasStopped) {
  const Folder folder;
  SoftwareDevice device;
  int reports = 0, stop_after = 0;
  RenderOptions options = reference(4);
  options.image_progress = [&](double) {
    if (++reports == stop_after) throw std::runtime_error("stopped");
  };
  const auto draw = [&] {
    reports = 0;
    return Renderer(device, make_heap(40, 7), options)
        .render(look_at({4, 2, 1.5}, {0, 0, 0.5}), pinhole(96, 96, 80), 0, 1000000000)
        .rgb;
  };
  const auto whole = draw();  // without a cache
  EXPECT_EQ(reports, 9);
  options.cache_folder = folder.path.string();
  stop_after = 4;
  EXPECT_THROW(draw(), std::runtime_error);
  const fs::path tiles = folder.path / "reference_tiles";
  ASSERT_TRUE(fs::exists(tiles));
  const fs::path journal = fs::directory_iterator(tiles)->path();
  // Cut off in the middle of a record, as a kill does.
  fs::resize_file(journal, fs::file_size(journal) - 100);
  stop_after = 0;
  EXPECT_TRUE(draw() == whole);
  EXPECT_TRUE(fs::is_empty(tiles));
  draw();  // from the cache
  EXPECT_EQ(reports, 0);
}

TEST(TileJournal, DoesNotTakeWhatWasChanged) {
  const Folder folder;
  std::vector<PixelSums> sums(10);
  sums[3].light = {1, 2, 3};
  TileJournal(folder.path.string(), "a").note(7, sums);
  {
    const TileJournal journal(folder.path.string(), "a");
    ASSERT_TRUE(journal.find(7, 10));
    EXPECT_TRUE((*journal.find(7, 10))[3].light == Vec3(1, 2, 3));
    EXPECT_FALSE(journal.find(7, 9));
    EXPECT_FALSE(journal.find(6, 10));
  }
  std::fstream file(folder.path / "a.tiles", std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(200);
  file.put('!');
  file.close();
  EXPECT_FALSE(TileJournal(folder.path.string(), "a").find(7, 10));
}

}  // namespace reference_test
}  // namespace rubble::testing
