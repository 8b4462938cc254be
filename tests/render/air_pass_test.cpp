// The table of the air by a graphics card beside that of the processor, with all that may hang in the air and shine there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "kernel/base/random.h"
#include "render/colour/frame_fill.h"
#include "render/devices/gl/air_pass.h"
#include "render/gl/gl_context.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace air_pass_test {

class Surroundings {
 public:
  Surroundings() : random_(11, "tests.air"), scene_(make_heap(1, 1)) {
    lights_ = make_lights(scene_);
    LightModel spot;
    spot.type = LightType::spot;
    spot.position = {2, 1, 3}, spot.axis = {0, 0, -1}, spot.colour = {4, 3, 2}, spot.cos_outer = 0.6f, spot.cos_inner = 0.8f;
    LightModel point = spot;
    point.type = LightType::point;
    point.position = {-1, 2, 2};
    lights_.lights.push_back(spot), lights_.lights.push_back(point);
    baked_.origin = {-4, -4, 0}, baked_.cell = {2, 2, 1}, baked_.size = {5, 5, 4};
    for (int i = 0; i < 100; ++i) baked_.radiance.push_back(colour(0.3));
    for (std::size_t i = 0; i < 100 * lights_.lights.size(); ++i) baked_.direct.push_back(i % 3 == 0 ? Vec3f() : colour(2));
    field_.grid = {{-4, -4, 0}, {1, 1, 1}, {9, 9, 5}};
    field_.seen.cuts = 2;
    const std::size_t count = field_.grid.count();
    for (std::size_t i = 0; i < count * 8; ++i) field_.seen.seen.push_back(std::uint8_t(random_.next() >> 56));
    field_.terms = terms(count, 1), field_.of_lamp = terms(count, 0.5), field_.ends_of_lamp = terms(count, 0.3);
    field_.open = terms(1, 0.7).front();
    for (std::vector<std::uint32_t>* other : {&field_.stand_in, &field_.lamp_stand_in})
      for (std::size_t i = 0; i < count; ++i) other->push_back(std::uint32_t(random_.uniform() * double(count)));
    lamp_.position = {-0.8f, 0.1f, 1}, lamp_.axis = {1, 0, 0}, lamp_.colour = {0.2f, 0.18f, 0.15f}, lamp_.cone = 3;
  }

  // The largest difference of a number of the table, as a share of itself and of the mean of all.
  double compare(AirPass& card, const Gl& gl, const ViewRays& view, const AirSpec& spec, bool with_field, bool with_lamp,
                 std::size_t lights, double& brightest) {
    LightSet set = lights_;
    set.lights.resize(lights);
    AirLight baked = baked_;
    baked.direct.resize(100 * lights);
    const Medium medium(spec, 7);
    const Air air = medium.at(2.3);
    const LitAir lit{baked, set, with_field ? &field_ : nullptr, Aabb{{-4, -4, 0}, {4, 4, 4}}};
    AirVolume volume;
    volume.prepare(view, air, lit, with_lamp ? &lamp_ : nullptr, false, {});
    ThreadPool pool(2);
    const auto expected = volume.table(find_wide_shader({}), pool);

    FrameBlock block{};
    const Mat3 r = view.pose(0).rotation.matrix();
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) block.world_from_optical[i][k] = float(r.rows[std::size_t(i)][k]);
      block.world_from_optical[i][3] = float(view.pose(0).translation[i]);
    }
    const Intrinsics& k = view.intrinsics;
    block.lens[0] = float(1 / k.fx), block.lens[1] = float(1 / k.fy), block.lens[2] = float(k.cx), block.lens[3] = float(k.cy);
    block.view[2] = float(k.width), block.view[3] = float(k.height);
    const GlBuffer frame(gl);
    give_buffer(gl, frame.name(), sizeof block, &block, GL_STREAM_DRAW);
    if (view.plain()) {
      card.trace(volume, frame, {});
    } else {
      std::vector<float> slopes, poses;
      for (int v = 0; v < k.height; ++v) {
        for (int u = 0; u < k.width; ++u) {
          const Vec3 d = view.direction(u, v) * (1 / std::max(view.direction(u, v).z, 0.05));
          slopes.insert(slopes.end(), {float(d.x), float(d.y), float(d.z), 0});
        }
        const Mat3 turn = view.pose(v).rotation.matrix();
        for (std::size_t i = 0; i < 3; ++i)
          poses.insert(poses.end(), {float(turn.rows[i].x), float(turn.rows[i].y), float(turn.rows[i].z),
                                     float(view.pose(v).translation[int(i)])});
      }
      const GlTexture lens_rays = make_target(gl, GL_RGBA32F, k.width, k.height), row_poses = make_target(gl, GL_RGBA32F, 3, k.height);
      give_image(gl, lens_rays.name(), 0, {0, 0, 0, k.width, k.height}, GL_RGBA, GL_FLOAT, slopes.data());
      give_image(gl, row_poses.name(), 0, {0, 0, 0, 3, k.height}, GL_RGBA, GL_FLOAT, poses.data());
      card.trace(volume, frame, {nullptr, nullptr, &lens_rays, &row_poses});
    }
    std::vector<float> found(expected.size() * 4);
    take_image(gl, card.table().name(), GL_RGBA, GL_FLOAT, found.size() * sizeof(float), found.data());
    double mean = 0, worst = 0;
    brightest = 0;
    for (const auto& entry : expected)
      for (int c = 0; c < 3; ++c) mean += double(entry[std::size_t(c)]), brightest = std::max(brightest, double(entry[std::size_t(c)]));
    mean /= 3 * double(expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double a = double(expected[i / 4][i % 4]), b = double(found[i]);
      if (!std::isfinite(b)) return 1e9;
      worst = std::max(worst, std::fabs(a - b) / (std::fabs(a) + (i % 4 == 3 ? 1 : mean)));
    }
    return worst;
  }

 private:
  Vec3f colour(double most) {
    const auto draw = [&] { return float(random_.uniform() * most); };
    return {draw(), draw(), draw()};
  }
  std::vector<RadianceTerms> terms(std::size_t count, double mean) {
    std::vector<RadianceTerms> out(count);
    for (RadianceTerms& of : out) {
      of[0] = colour(2 * mean) + Vec3f(0.5f, 0.5f, 0.5f);
      for (std::size_t t = 1; t < of.size(); ++t) of[t] = colour(0.2 * mean) - Vec3f(0.1f, 0.1f, 0.1f) * float(mean);
    }
    return out;
  }

  RandomStream random_;
  Scene scene_;
  LightSet lights_;
  AirLight baked_;
  RadianceGrid field_;
  AirLamp lamp_;
};

TEST(AirPass, IsWhatTheProcessorFinds) {
  const GlContext context;
  AirPass card(context.gl());
  Surroundings place;
  AirSpec fog, dust, rain;
  fog.fog_density = 0.2, fog.fog_height = 1.5, fog.fog_noise = 0.5, fog.fog_noise_size = 3;
  dust.fog_density = 0.05;
  dust.dust.period = 1, dust.dust.density = 3, dust.dust.half_life = 4, dust.dust.position = {2, 0.5, 0.5};
  rain = fog, rain.rain_mm_h = 20;
  ViewRays inside{0, pinhole(192, 160, 100), look_at({-1, 0, 1}, {3, 0.4, 0.6})}, outside = inside, rolling = inside, fisheye = inside;
  outside.world_from_camera = look_at({-9, 5, 2}, {0, 0, 1});
  for (int v = 0; v < rolling.intrinsics.height; ++v) {
    Pose pose = rolling.pose(0);
    pose.translation.y += 0.002 * v;
    fisheye.row_poses.push_back(pose);
  }
  rolling.row_poses = fisheye.row_poses;
  auto directions = std::make_shared<LensDirections>();
  for (int v = 0; v < 160; ++v)
    for (int u = 0; u < 192; ++u) directions->push_back(Vec3f(normalized(Vec3((u - 95.5) / 60, (v - 79.5) / 60, 1))));
  fisheye.directions = directions;
  const auto check = [&](const char* name, const ViewRays& view, const AirSpec& air, bool field, bool lamp, std::size_t lights) {
    double brightest = 0;
    EXPECT_LT(place.compare(card, context.gl(), view, air, field, lamp, lights, brightest), 2e-3) << name;
    EXPECT_GT(brightest, 1e-3) << name << ": dark air tells nothing";
  };
  check("fog", inside, fog, true, true, 1);
  check("fog, as baked", inside, fog, false, false, 1);
  check("dust", inside, dust, true, true, 1);
  check("rain, local lights", inside, rain, false, true, 3);
  check("from far away", outside, rain, true, true, 3);
  check("no lamp", inside, dust, true, false, 2);
  check("rolling shutter", rolling, dust, true, true, 3);
  check("lens", fisheye, fog, true, true, 2);
}

}  // namespace air_pass_test
}  // namespace rubble::testing
