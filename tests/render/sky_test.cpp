// Skies against published formulas and figures, and both renderers under them.
#include "render/lighting/sky.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "render/devices/software/software_device.h"
#include "render/sky/atmosphere.h"
#include "render/sky/clouds.h"
#include "render/lighting/lighting.h"
#include "render/sky/sky_model.h"
#include "render/renderer.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace sky_test {

double luminance(const Vec3f& c) {
  return 0.2126 * double(c.x) + 0.7152 * double(c.y) + 0.0722 * double(c.z);
}

Scene under(SkyType type, double elevation, double cover = 0.5, std::uint64_t seed = 1) {
  Scene scene;
  scene.light.type = LightType::sun;
  scene.light.elevation_deg = elevation, scene.light.azimuth_deg = 30;
  scene.sky.type = type, scene.sky.cloud_cover = cover;
  scene.seed = seed;
  scene.lamp.on = false;
  return scene;
}

// Horizontal illuminance by quadrature over the upper half: rings of equal height have equal solid angles.
double horizontal_klx(const Sky& sky) {
  constexpr int kRings = 400, kSides = 800;
  double sum = 0;
  for (int i = 0; i < kRings; ++i)
    for (int j = 0; j < kSides; ++j) {
      const double z = (i + 0.5) / kRings, flat = std::sqrt(1 - z * z), a = 2 * M_PI * (j + 0.5) / kSides;
      sum += z * luminance(sky.radiance(Vec3f(Vec3(flat * std::cos(a), flat * std::sin(a), z))));
    }
  return sum * 2 * M_PI / (double(kRings) * kSides);
}

// CIE S 011: three times as bright at the zenith as at the horizon, the same all around; Krochmann and Seidl:
// 300 + 21000 sin(elevation) lx.
TEST(Overcast, IsTheSkyOfTheCie) {
  for (const double elevation : {8.0, 35.0, 70.0}) {
    const LightSet lights = make_lights(under(SkyType::overcast, elevation));
    const Sky& sky = lights.sky;
    const double zenith = luminance(sky.radiance({0, 0, 1}));
    for (const double turn : {0.3, 2.0, 4.4}) {
      for (const double g : {1.5, 20.0, 50.0}) {
        const double sine = std::sin(g * M_PI / 180);
        const Vec3f d = sun_direction(g, turn * 180 / M_PI);
        EXPECT_NEAR(luminance(sky.radiance(d)) / zenith, (1 + 2 * sine) / 3, 0.003) << g;
      }
    }
    // The lowest texels of the map stand 0.7 degrees above the horizon.
    EXPECT_NEAR(zenith / luminance(sky.radiance(sun_direction(0, 77))), 3, 0.08);
    const double stated = 0.3 + 21 * std::sin(elevation * M_PI / 180);
    EXPECT_NEAR(horizontal_klx(sky) / stated, 1, 0.003);
    EXPECT_NEAR(M_PI * luminance(sky.mean) / stated, 1, 0.003);  // what the fast renderer lights ground by
    EXPECT_EQ(luminance(lights.lights.front().colour), 0);  // no sun
    EXPECT_EQ(luminance(sky.sun_radiance), 0);
  }
  const auto dusk = [](double elevation) {
    return horizontal_klx(make_lights(under(SkyType::overcast, elevation)).sky);
  };
  EXPECT_NEAR(dusk(-0.01), dusk(0), 0.02 * dusk(0));
  EXPECT_LT(dusk(-6), 0.03 * dusk(0));
  EXPECT_GT(dusk(-6), 0);
}

// CIE S 011:2003, type 12, written out with its own constants: a = -1, b = -0.32, c = 10, d = -3, e = 0.45.
double standard_ratio(double elevation, double sun_elevation, double apart) {
  const double rad = M_PI / 180;
  const auto phi = [](double zenith) { return 1 - std::exp(-0.32 / std::cos(zenith)); };
  const auto f = [](double chi) {
    return 1 + 10 * (std::exp(-3 * chi) - std::exp(-1.5 * M_PI)) + 0.45 * std::cos(chi) * std::cos(chi);
  };
  return phi((90 - elevation) * rad) * f(apart * rad) / (phi(0) * f((90 - sun_elevation) * rad));
}

TEST(CieClear, HasTheLuminancesOfTheStandard) {
  for (const double sun : {20.0, 55.0}) {
    const Sky sky = make_lights(under(SkyType::cie_clear, sun)).sky;
    const Vec3f to_sun = sun_direction(sun, 30);
    const double zenith = luminance(sky.radiance({0, 0, 1}));
    for (const double elevation : {5.0, 30.0, 75.0})
      for (const double turn : {60.0, 120.0, 210.0}) {
        const Vec3f d = sun_direction(elevation, turn);
        const double apart = std::acos(double(dot(d, to_sun))) * 180 / M_PI;
        EXPECT_NEAR(luminance(sky.radiance(d)) / zenith / standard_ratio(elevation, sun, apart), 1, 0.03)
            << sun << " " << elevation << " " << turn;
      }
    const Sky clear = make_lights(under(SkyType::clear, sun)).sky;
    EXPECT_NEAR(horizontal_klx(sky) / horizontal_klx(clear), 1, 0.005);
  }
  const Sky dusk = make_lights(under(SkyType::cie_clear, -4)).sky, clear = make_lights(under(SkyType::clear, -4)).sky;
  EXPECT_TRUE(std::equal(dusk.map.begin(), dusk.map.end(), clear.map.begin()));
}

// More haze takes the sun's light by Lambert and Beer's law, and brightens the sky.
TEST(Hazy, FollowsTheOpticalDepth) {
  const Scene clear = under(SkyType::clear, 50), hazy = under(SkyType::hazy, 50);
  const LightSet a = make_lights(clear), b = make_lights(hazy);
  const double more = 2.92e-5 * 1200 * (kHazyDay - 1) / std::sin(50 * M_PI / 180);
  EXPECT_NEAR(double(b.lights[0].colour.y / a.lights[0].colour.y), std::exp(-more), 0.015);
  EXPECT_GT(horizontal_klx(b.sky), 1.5 * horizontal_klx(a.sky));
  // At an aerosol optical depth of 0.5, 40 to 50 % of visible light are diffuse, against a tenth on a clear day.
  const auto diffuse = [](const LightSet& l) {
    const double sky = horizontal_klx(l.sky);
    return sky / (sky + luminance(l.lights[0].colour) * std::sin(50 * M_PI / 180));
  };
  EXPECT_NEAR(diffuse(a), 0.11, 0.04);
  EXPECT_NEAR(diffuse(b), 0.46, 0.06);
  // White and bright at the horizon.
  const Vec3f low = b.sky.radiance(sun_direction(2, 150)), high = b.sky.radiance(sun_direction(60, 150));
  EXPECT_GT(low.y, 1.3 * double(high.y));
  EXPECT_NEAR(double(low.z / low.x), 1, 0.35);
  const auto total = [](const LightSet& l) {
    return horizontal_klx(l.sky) + luminance(l.lights[0].colour) * std::sin(50 * M_PI / 180);
  };
  EXPECT_LT(total(b), total(a));
  EXPECT_GT(total(b), 0.6 * total(a));
}

// A full moon high up gives about a quarter of a lux (Kyba, Mohar and Posch 2017, "How bright is moonlight?").
TEST(Moonlit, IsADayTwoMillionthsAsBright) {
  const LightSet moon = make_lights(under(SkyType::moonlit, 60));
  const double lux = 1000 * (horizontal_klx(moon.sky) + luminance(moon.lights[0].colour) * std::sin(M_PI / 3));
  EXPECT_GT(lux, 0.15);
  EXPECT_LT(lux, 0.3);
  // Its disc has the luminance of the moon, 2.5 kcd/m2 on average when full and outside the air.
  EXPECT_GT(luminance(moon.sky.sun_radiance), 1.5);
  EXPECT_LT(luminance(moon.sky.sun_radiance), 4);
  for (const Vec3f& value : moon.sky.map) ASSERT_GE(value.z, 0.999f * night_sky().z);
  const LightSet set = make_lights(under(SkyType::moonlit, -10));
  EXPECT_NEAR(luminance(set.sky.radiance({0, 0, 1})) / luminance(night_sky()), 1, 0.02);
}

TEST(CityNight, GlowsAtTheHorizon) {
  const LightSet town = make_lights(under(SkyType::city_night, 40));
  const double zenith = luminance(town.sky.radiance({0, 0, 1}));
  EXPECT_NEAR(zenith, 3e-6, 3e-8);
  EXPECT_NEAR(luminance(town.sky.radiance(sun_direction(0, 12))) / zenith, 5, 0.2);
  EXPECT_GT(town.sky.mean.x, 3 * town.sky.mean.z);  // street lamps are yellow
  EXPECT_EQ(luminance(town.lights[0].colour), 0);
}

TEST(Cloudy, CoversTheStatedShareOfTheLayer) {
  for (const double cover : {0.2, 0.5, 0.8}) {
    double cloud = 0, asked = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const CloudLayer layer(cover, seed, {0, 0, 1}, {1, 1, 1}, {1, 1, 1});
      for (double x = -9000; x <= 9000; x += 450)
        for (double y = -9000; y <= 9000; y += 450, ++asked)
          cloud += layer.thickness(normalized(Vec3f(float(x), float(y), 1200))) > 0 ? 1 : 0;
    }
    EXPECT_NEAR(cloud / asked, cover, 0.07);
  }
  const CloudLayer none(0, 1, {0, 0, 1}, {1, 1, 1}, {1, 1, 1}), all(1, 1, {0, 0, 1}, {1, 1, 1}, {1, 1, 1});
  for (const Vec3f& d : {Vec3f(0, 0, 1), Vec3f(0.6f, 0, 0.8f), Vec3f(0, 0.9f, 0.4f)}) {
    EXPECT_EQ(none.thickness(normalized(d)), 0);
    EXPECT_LT(all.beam_share(normalized(d)), 1e-6);
  }
}

TEST(Cloudy, FollowsFromTheSeedAndStaysWithinDaylight) {
  const LightSet clear = make_lights(under(SkyType::clear, 40));
  const LightSet open = make_lights(under(SkyType::cloudy, 40, 0));
  EXPECT_EQ(open.lights[0].colour, clear.lights[0].colour);
  EXPECT_NEAR(horizontal_klx(open.sky) / horizontal_klx(clear.sky), 1, 0.01);
  const auto total = [](const LightSet& l) {
    return horizontal_klx(l.sky) + luminance(l.lights[0].colour) * std::sin(40 * M_PI / 180);
  };
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const LightSet one = make_lights(under(SkyType::cloudy, 40, 0.6, seed));
    EXPECT_LT(total(one), 1.3 * total(clear)) << seed;  // clouds beside the sun add up to a quarter
    EXPECT_GT(total(one), 0.1 * total(clear)) << seed;
    const LightSet again = make_lights(under(SkyType::cloudy, 40, 0.6, seed));
    EXPECT_TRUE(std::equal(one.sky.map.begin(), one.sky.map.end(), again.sky.map.begin()));
    const LightSet other = make_lights(under(SkyType::cloudy, 40, 0.6, seed + 10));
    EXPECT_FALSE(std::equal(one.sky.map.begin(), one.sky.map.end(), other.sky.map.begin()));
  }
}

// Level ground under each sky: baked light and paths agree.
TEST(Skies, LightTheGroundAlikeInBothRenderers) {
  SoftwareDevice device;
  const Pose down = look_at({0, 0, 2}, {0.01, 0, 0});
  for (const SkyType type : {SkyType::clear, SkyType::hazy, SkyType::cloudy, SkyType::overcast,
                             SkyType::moonlit, SkyType::city_night, SkyType::cie_clear}) {
    const auto green = [&](RenderQuality quality) {
      RenderOptions options;
      options.colour.quality = quality, options.colour.samples = 256;
      options.bake = false, options.shadow_size = 64, options.texture_size = 64;
      Renderer renderer(device, under(type, 45), options);
      const LinearFrame frame = renderer.render_linear(down, pinhole(24, 24, 20));
      double sum = 0;
      for (std::size_t i = 1; i < frame.rgb.size(); i += 3) sum += double(frame.rgb[i]);
      return sum;
    };
    const double fast = green(RenderQuality::fast), slow = green(RenderQuality::reference);
    EXPECT_GT(slow, 0);
    EXPECT_NEAR(fast / slow, 1, 0.03) << int(type);
  }
}

}  // namespace sky_test
}  // namespace rubble::testing
