// Surfaces with colours of their own: where their images lie, how they are averaged, and that both renderers and the
// LiDAR mean the same.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "render/devices/software/software_device.h"
#include "render/geometry/geometry.h"
#include "render/lidar/lidar.h"
#include "render/reference/image_key.h"
#include "render/renderer.h"
#include "render/surface/scalar_surface.h"
#include "render/transport/paint_point.h"
#include "scripting/sensors/lidar.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace paint_test {

using MakeTexel = std::function<std::array<std::uint8_t, 4>(int x, int y)>;

PaintImage make_image(int side, const MakeTexel& texel) {
  PaintImage image{side, {}};
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      for (const std::uint8_t value : texel(x, y)) image.texels.push_back(value);
  return image;
}

std::shared_ptr<SurfacePaint> make_paint(const char* key) {
  auto paint = std::make_shared<SurfacePaint>();
  paint->sha256 = key;
  return paint;
}

// A level square of 2 m about the origin, of `cells` x `cells` pairs of triangles; the image covers it once, its upper
// left corner at (-1, 1).
TriangleMesh make_sheet(int cells, std::shared_ptr<const SurfacePaint> paint) {
  TriangleMesh mesh;
  mesh.surface_names = {"sheet"}, mesh.paints = {std::move(paint)};
  const auto row = std::uint32_t(cells + 1);
  for (std::uint32_t j = 0; j < row; ++j)
    for (std::uint32_t i = 0; i < row; ++i)
      mesh.positions.push_back({float(2 * i) / float(cells) - 1, float(2 * j) / float(cells) - 1, 0});
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.triangles.push_back({a, b, c});
    mesh.surfaces.push_back(0);
    std::array<PaintCorner, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3f& p = mesh.positions[mesh.triangles.back()[k]];
      corners[k] = {(p.x + 1) / 2, (p.y + 1) / 2, {1, 1, 1}};
    }
    mesh.paint_corners.push_back(corners);
  };
  for (std::uint32_t j = 0; j + 1 < row; ++j)
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      const std::uint32_t a = j * row + i, b = a + 1, c = a + row, d = c + 1;
      add(a, b, d), add(a, d, c);
    }
  return mesh;
}

Scene scene_of(TriangleMesh mesh, const Pose& pose = {}) {
  Scene scene;
  scene.ground = false;
  scene.lamp.on = false;
  scene.light.type = LightType::point;
  scene.light.intensity = 2000, scene.light.position = {-6, 4, 9};
  scene.meshes.push_back(share(std::move(mesh)));
  scene.instances.push_back({0, 1, pose, 1});
  return scene;
}

RenderOptions plain(RenderQuality quality = RenderQuality::fast, int samples = 4) {
  RenderOptions options;
  options.colour.quality = quality, options.colour.samples = samples;
  options.bake = false, options.antialias = false, options.texture_size = 32;
  return options;
}

// From straight above, north up: the sheet fills 200 of 220 pixels.
LinearFrame from_above(Device& device, const Scene& scene, const RenderOptions& options, double height = 10) {
  const Pose down = look_at({0, 0, height}, {0, 1e-6, 0});
  return Renderer(device, scene, options).render_linear(down, pinhole(220, 220, 100 * height));
}

// Where each pixel of from_above() meets the ground.
Vec3 place_of(std::size_t pixel) {
  return {(double(pixel % 220) - 109.5) / 100, (109.5 - double(pixel / 220)) / 100, 0};
}

double to_linear(double code) { return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4); }

// Light by white paint's is albedo: over a ramp it tells where each pixel's texel lies.
void expect_ramp(Device& device, int cells, RenderQuality quality) {
  auto ramp = make_paint("ramp");
  ramp->albedo = make_image(64, [](int x, int y) {
    return std::array<std::uint8_t, 4>{std::uint8_t(40 + 3 * x), std::uint8_t(40 + 3 * y), 128, 255};
  });
  const LinearFrame seen = from_above(device, scene_of(make_sheet(cells, ramp)), plain(quality));
  const LinearFrame white = from_above(device, scene_of(make_sheet(cells, make_paint("white"))), plain(quality));
  double worst = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < seen.instance.size(); ++i) {
    const Vec3 at = place_of(i);
    if (std::max(std::fabs(at.x), std::fabs(at.y)) > 0.97) continue;
    ASSERT_NE(seen.instance[i], kNoInstance);
    const double x = 32 * (at.x + 1) - 0.5, y = 32 * (1 - at.y) - 0.5;
    const double expected[] = {to_linear((40 + 3 * x) / 255), to_linear((40 + 3 * y) / 255), to_linear(128 / 255.0)};
    for (std::size_t c = 0; c < 3; ++c)
      worst = std::max(worst, std::fabs(double(seen.rgb[3 * i + c] / white.rgb[3 * i + c]) / expected[c] - 1));
    ++count;
  }
  EXPECT_GT(count, 30000u);
  EXPECT_LT(worst, 0.05) << cells;
}

TEST(Paint, LiesWhereTheMeshSays) {
  SoftwareDevice device;
  for (const int cells : {1, 3, 40}) expect_ramp(device, cells, RenderQuality::fast);
  expect_ramp(device, 3, RenderQuality::reference);
}

// Squares of one texel, black and white, from so far that a pixel has many of them: half the light.
TEST(Paint, IsAveragedAsLightFromAfar) {
  SoftwareDevice device;
  auto checks = make_paint("checks");
  checks->albedo = make_image(1024, [](int x, int y) {
    const std::uint8_t v = (x + y) % 2 ? 255 : 0;
    return std::array<std::uint8_t, 4>{v, v, v, 255};
  });
  for (const RenderQuality quality : {RenderQuality::fast, RenderQuality::reference}) {
    const LinearFrame seen = from_above(device, scene_of(make_sheet(2, checks)), plain(quality));
    const LinearFrame white = from_above(device, scene_of(make_sheet(2, make_paint("white"))), plain(quality));
    double sum = 0, all = 0;
    for (std::size_t i = 0; i < seen.instance.size(); ++i)
      if (seen.instance[i] != kNoInstance) sum += double(seen.rgb[3 * i]), all += double(white.rgb[3 * i]);
    EXPECT_NEAR(sum / all, 0.5, 0.01);
  }
}

TEST(Paint, OfVerticesIsBetweenThem) {
  SoftwareDevice device;
  TriangleMesh mesh = make_sheet(3, make_paint("scan"));
  for (auto& corners : mesh.paint_corners)
    for (PaintCorner& c : corners) c.colour = {0.2f + 0.6f * c.u, 0.5f, 0.8f - 0.6f * c.v};
  const LinearFrame seen = from_above(device, scene_of(mesh), plain());
  const LinearFrame white = from_above(device, scene_of(make_sheet(3, make_paint("white"))), plain());
  for (std::size_t i = 0; i < seen.instance.size(); ++i) {
    const Vec3 at = place_of(i);
    if (std::max(std::fabs(at.x), std::fabs(at.y)) > 0.97) continue;
    ASSERT_NEAR(double(seen.rgb[3 * i] / white.rgb[3 * i]), 0.5 + 0.3 * at.x, 0.01);
    ASSERT_NEAR(double(seen.rgb[3 * i + 2] / white.rgb[3 * i + 2]), 0.5 - 0.3 * at.y, 0.01);
  }
}

// A normal that leans by 30 degrees to the right of the image, and one that leans up: closed forms for an image that
// lies as the mesh does, mirrored, and turned by a quarter.
TEST(Paint, ReliefLeansAsTheImageLies) {
  auto paint = make_paint("relief");
  const auto lean = [](float x, float y) {
    return make_image(2, [=](int, int) {
      return std::array<std::uint8_t, 4>{std::uint8_t(128 + 127 * x), std::uint8_t(128 + 127 * y), 255, 0};
    });
  };
  const auto normal_of = [&](float x, float y, const std::array<std::array<float, 2>, 3>& uv) {
    paint->relief = lean(x, y);
    const PaintLayers layers = make_paint_layers({paint});
    TrianglePaint triangle;
    for (std::size_t i = 0; i < 3; ++i) triangle.corners[i] = {uv[i][0], uv[i][1], {1, 1, 1}};
    triangle.paint = 0;
    return find_paint(layers, triangle, {{Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(0, 1, 0)}, {0.4f, 0.3f, 0.3f}, {0, 0, 1}, 0.001f}).normal;
  };
  const auto expect = [](const Vec3f& found, double x, double y) {
    EXPECT_NEAR(double(found.x), x, 0.01);
    EXPECT_NEAR(double(found.y), y, 0.01);
    EXPECT_NEAR(double(found.z), std::sqrt(0.75), 0.01);
  };
  const std::array<std::array<float, 2>, 3> straight{{{0, 0}, {1, 0}, {0, 1}}}, mirrored{{{1, 0}, {0, 0}, {1, 1}}},
      turned{{{0, 0}, {0, 1}, {-1, 0}}};
  expect(normal_of(0.5f, 0, straight), 0.5, 0);
  expect(normal_of(0, 0.5f, straight), 0, 0.5);
  expect(normal_of(0.5f, 0, mirrored), -0.5, 0);
  expect(normal_of(0, 0.5f, mirrored), 0, 0.5);
  expect(normal_of(0.5f, 0, turned), 0, -0.5);
  expect(normal_of(0, 0.5f, turned), 0.5, 0);
}

// Images, relief, gloss and metal on a turned block: the fast renderer and the path tracer draw the same.
TEST(Paint, IsTheSameByBothRenderers) {
  SoftwareDevice device;
  auto paint = make_paint("all");
  paint->reflectance = 0.04f, paint->roughness = 0.9f, paint->metalness = 1;
  paint->albedo = make_image(16, [](int x, int y) {
    return std::array<std::uint8_t, 4>{std::uint8_t(90 + 10 * x), std::uint8_t(90 + 10 * y), 150, 255};
  });
  paint->relief = make_image(16, [](int x, int y) {
    return std::array<std::uint8_t, 4>{std::uint8_t(100 + 4 * x), std::uint8_t(100 + 4 * y), 240, std::uint8_t(4 * y)};
  });
  for (const double wetness : {0.0, 0.6}) {
    Scene scene = scene_of(make_sheet(5, paint), {normalized(Quat(0.9, 0.2, -0.3, 0.1)), {0, 0, 0}});
    scene.wetness = wetness;
    const LinearFrame fast = from_above(device, scene, plain());
    const LinearFrame slow = from_above(device, scene, plain(RenderQuality::reference, 16));
    double sum = 0, off = 0;
    for (std::size_t i = 0; i < fast.rgb.size(); ++i) {
      if (fast.instance[i / 3] == kNoInstance) continue;
      sum += double(fast.rgb[i]), off += std::fabs(double(fast.rgb[i]) - double(slow.rgb[i]));
    }
    EXPECT_GT(sum, 1000);
    EXPECT_LT(off / sum, 0.06) << wetness;
  }
}

TEST(Paint, OfMetalMirrorsItsColour) {
  auto paint = make_paint("metal");
  paint->colour = {0.6f, 0.6f, 0.6f}, paint->metalness = 1, paint->roughness = 0.5f, paint->reflectance = 0.04f;
  const PaintLayers layers = make_paint_layers({paint});
  TrianglePaint triangle;
  triangle.paint = 0;
  const PaintPoint point = find_paint(layers, triangle, {{}, {1, 0, 0}, {0, 0, 1}, 0.01f});
  const scalar::SurfaceLayers found =
      scalar::paint_over({}, scalar::real3(point.albedo), point.roughness, point.metalness, point.reflectance);
  EXPECT_NEAR(double(found.reflectance), 0.6, 1e-5);
  EXPECT_NEAR(double(found.roughness), 0.25, 1e-6) << "alpha is the square";
}

TEST(Paint, IsKnownToTheLidar) {
  const auto intensity = [](float albedo) {
    auto paint = make_paint("wall");
    paint->colour = {albedo, 0.5f, 0.5f};
    Scene scene = scene_of(make_sheet(1, paint), {normalized(Quat(0.7071067811865476, 0, -0.7071067811865476, 0)), {3, 0, 0}});
    LidarFigures lidar;
    lidar.range_step = 0, lidar.divergence_mrad = 0;
    LidarSpec spec = lidar.spec();
    spec.noise = false;
    const LidarPlace place{[](std::int64_t) { return Pose(); }, 1'000'000'000};
    const RangeScan scan = Lidar(spec, std::make_shared<RayWorld>(scene), place, Medium(scene.air, 1), 3, 1).take(0);
    EXPECT_GT(scan.points.size(), 100u);
    double sum = 0;
    for (const ScanPoint& p : scan.points) sum += double(p.intensity);
    return sum / double(scan.points.size());
  };
  EXPECT_NEAR(intensity(0.8f) / intensity(0.2f), 4, 0.05);
}

// What is kept in the cache under a scene's key must not be taken for one of another image.
TEST(Paint, IsPartOfTheKeyOfAScene) {
  const auto key = [](const char* paint, float corner) {
    TriangleMesh mesh = make_sheet(1, make_paint(paint));
    mesh.paint_corners[0][0].u = corner;
    const PreparedScene scene = prepare_scene(scene_of(mesh), 1);
    return surroundings_key({scene, LightSet(), {}, make_ground_map(scene), 0});
  };
  EXPECT_EQ(key("one", 0), key("one", 0));
  EXPECT_NE(key("one", 0), key("two", 0));
  EXPECT_NE(key("one", 0), key("one", 0.5f));
}

TEST(Paint, OfManyMeshesIsKeptOnce) {
  Scene scene = scene_of(make_sheet(1, make_paint("one")));
  scene.meshes.push_back(share(make_sheet(2, make_paint("one"))));
  scene.meshes.push_back(share(make_sheet(2, make_paint("two"))));
  const PreparedScene prepared = prepare_scene(scene, 1);
  ASSERT_TRUE(prepared.paints);
  EXPECT_EQ(prepared.paints->paints.size(), 2u);
  EXPECT_EQ(prepared.meshes[1].paint.front().paint, 0);
  EXPECT_EQ(prepared.meshes[2].paint.front().paint, 1);
}

}  // namespace paint_test
}  // namespace rubble::testing
