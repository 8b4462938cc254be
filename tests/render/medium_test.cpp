// The medium against closed forms, against a fine quadrature of its own extinction, and in time.
#include "render/media/medium.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernel/base/random.h"

namespace rubble {
namespace medium_test {

AirSpec fog(double density, double height = 0, double noise = 0) {
  AirSpec air;
  air.fog_density = density;
  air.fog_height = height;
  air.fog_noise = noise;
  return air;
}

AirSpec dusty(double noise = 0) {
  AirSpec air = fog(0, 0, noise);
  air.dust.period = 2;
  air.wind = {0.3, -0.1, 0};
  return air;
}

// The midpoint rule over `steps` steps of the extinction itself.
double fine_sum(const Air& air, const Vec3& from, const Vec3& direction, double distance,
                int steps) {
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    sum += air.extinction(from + direction * (distance * (i + 0.5) / steps));
  return sum * distance / steps;
}

TEST(Medium, HomogeneousFogFollowsBeerAndLambert) {
  const Air air = Medium(fog(0.3), 1).at(7);
  EXPECT_TRUE(air.homogeneous());
  for (const double d : {0.1, 1.0, 10.0, 1000.0})
    EXPECT_DOUBLE_EQ(air.optical_depth({1, 2, 3}, {0.6, 0, 0.8}, d), 0.3 * d);
  EXPECT_TRUE(Medium().clear());
  EXPECT_TRUE(Medium().at(3).clear());
  EXPECT_FALSE(Medium(dusty(), 1).clear());
  EXPECT_FALSE(Medium(dusty(), 1).homogeneous());
}

// Over all directions 1, and the mean cosine is g: what defines the function.
TEST(PhaseFunction, IsNormalizedAndHasItsMeanCosine) {
  for (const double g : {-0.5, 0.0, 0.3, 0.75, 0.9}) {
    double sum = 0, mean = 0;
    constexpr int kSteps = 200000;
    for (int i = 0; i < kSteps; ++i) {
      const double c = -1 + 2 * (i + 0.5) / kSteps;
      sum += phase_function(g, c) * 2 * M_PI * 2 / kSteps;
      mean += c * phase_function(g, c) * 2 * M_PI * 2 / kSteps;
    }
    EXPECT_NEAR(sum, 1, 1e-6) << g;
    EXPECT_NEAR(mean, g, 1e-6) << g;
  }
  EXPECT_NEAR(phase_function(0, 0.3), 1 / (4 * M_PI), 1e-15);
  EXPECT_NEAR(phase_function(0.75, -1) * 4 * M_PI, 0.25 / (1.75 * 1.75), 1e-12);
}

TEST(Medium, FogAndDustScatterEachByItsOwnPhaseFunction) {
  AirSpec spec = dusty();
  spec.fog_density = 0.2, spec.fog_intensity = 0.8;
  spec.fog_asymmetry = 0.5, spec.dust.asymmetry = 0.8;
  const Air air = Medium(spec, 5).at(6);
  ASSERT_FALSE(air.puffs().empty());
  const Vec3 p = air.puffs()[0].centre;
  double dust = 0;
  for (const DustPuff& puff : air.puffs()) dust += puff.at(p);
  ASSERT_GT(dust, 0.01);
  for (const double c : {-1.0, 0.2, 1.0})
    EXPECT_NEAR(air.scattering(p, c), 0.8 * (0.2 * phase_function(0.5, c) + dust * phase_function(0.8, c)), 1e-12);
}

// With fog, billows, drops and without; in puffs, beside them, and along rays that meet none.
TEST(AirOnRay, IsTheAirThereToTheLastBit) {
  RandomStream random(6, "rays");
  int met = 0;
  for (const bool fog_too : {false, true})
    for (const bool billows : {false, true})
      for (const bool rain : {false, true}) {
        AirSpec spec = dusty(billows ? 0.8 : 0);
        if (fog_too) spec.fog_density = 0.1, spec.fog_height = 1.5;
        if (rain) spec.rain_mm_h = 10;
        const Air air = Medium(spec, 5).at(30);
        ASSERT_GT(air.puffs().size(), std::size_t(3 * Medium::kPuffs));
        for (int i = 0; i < 60; ++i) {
          const Vec3 from(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-1, 4));
          const Vec3 direction = i % 3 == 0 ? normalized(air.puffs()[random.below(air.puffs().size())].centre - from)
                                            : random.direction();
          const double near = random.uniform(0.05, 2), far = near + random.uniform(0.1, 20);
          const AirOnRay on_ray(air, from, direction, near, far);
          for (int k = 0; k <= 40; ++k) {
            const double r = near + (far - near) * k / 40, cosine = random.uniform(-1, 1);
            const Vec3 p = from + direction * r;
            const AirOnRay::Sample here = on_ray.at(r, cosine);
            ASSERT_EQ(here.extinction, air.extinction(p)) << i << " " << k;
            ASSERT_EQ(here.scattering, air.scattering(p, cosine)) << i << " " << k;
            met += here.extinction > (fog_too || rain ? 0.15 : 0.001);
          }
        }
      }
  EXPECT_GT(met, 1000) << "most rays met nothing";
}

TEST(Medium, FogThatThinsWithHeightHasItsClosedForm) {
  const Air air = Medium(fog(0.5, 2), 1).at(0);
  EXPECT_FALSE(air.homogeneous());
  // Straight up from the ground to infinity: density times scale height.
  EXPECT_NEAR(air.optical_depth({}, {0, 0, 1}, 100), 1.0, 1e-9);
  EXPECT_NEAR(air.extinction({5, 5, 2}), 0.5 / std::exp(1), 1e-12);
  RandomStream random(3, "rays");
  for (int i = 0; i < 40; ++i) {
    const Vec3 from(0, 0, random.uniform(-1, 3)), direction = random.direction();
    const double d = random.uniform(0.1, 12);
    const double fine = fine_sum(air, from, direction, d, 20000);
    EXPECT_NEAR(air.optical_depth(from, direction, d), fine, 2e-4) << i;
  }
  const double level = air.optical_depth({0, 0, 1}, {1, 0, 0}, 4);
  EXPECT_NEAR(level, 4 * 0.5 * std::exp(-0.5), 1e-12);
  EXPECT_NEAR(air.optical_depth({0, 0, 1}, normalized(Vec3(1, 0, 1e-7)), 4), level, 1e-6);
}

TEST(Medium, PuffsHaveTheClosedFormOfAGaussian) {
  DustPuff puff{{1, 0, 0}, 0.4, 2};
  // Through the middle, end to end: extinction s sqrt(2 pi).
  EXPECT_NEAR(puff.optical_depth({-9, 0, 0}, {1, 0, 0}, 0, 20), 2 * 0.4 * std::sqrt(2 * M_PI),
              1e-12);
  EXPECT_NEAR(puff.optical_depth({-9, 0, 0}, {1, 0, 0}, 0, 10), 0.4 * std::sqrt(2 * M_PI), 1e-12);
  EXPECT_EQ(puff.optical_depth({-9, 5, 0}, {1, 0, 0}, 0, 20), 0);
  const Air air = Medium(dusty(), 5).at(6);
  ASSERT_GE(air.puffs().size(), std::size_t(2 * Medium::kPuffs));
  RandomStream random(4, "rays");
  for (int i = 0; i < 40; ++i) {
    const Vec3 from(random.uniform(-4, 4), random.uniform(-4, 4), 1);
    const Vec3 to = air.puffs()[random.below(air.puffs().size())].centre;
    const double d = 1.5 * distance(from, to);
    const Vec3 direction = normalized(to - from);
    const double fine = fine_sum(air, from, direction, d, 4000);
    EXPECT_GT(fine, 0);
    EXPECT_NEAR(air.optical_depth(from, direction, d), fine, 1e-3 * fine + 1e-4);
  }
}

TEST(Medium, BillowsAreSummedAsFineStepsSayAndHaveMeanOne) {
  AirSpec spec = dusty(0.8);
  spec.fog_density = 0.2;
  spec.fog_height = 3;
  const Air air = Medium(spec, 9).at(5);
  RandomStream random(5, "rays");
  double worst = 0;
  for (int i = 0; i < 60; ++i) {
    const Vec3 from(random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(0, 2));
    const Vec3 direction = random.direction();
    const double d = random.uniform(1, 15);
    const double fine = fine_sum(air, from, direction, d, 5000);
    const double got = air.optical_depth(from, direction, d);
    worst = std::max(worst, std::fabs(got - fine) / (fine + 0.02));
  }
  EXPECT_LT(worst, 0.02);
  double sum = 0, least = 9, most = 0;
  for (int i = 0; i < 20000; ++i) {
    const double b = air.billows(
        {random.uniform(-90, 90), random.uniform(-90, 90), random.uniform(-90, 90)});
    sum += b, least = std::min(least, b), most = std::max(most, b);
  }
  EXPECT_NEAR(sum / 20000, 1, 0.02);
  EXPECT_LT(least, 0.3);
  EXPECT_GT(most, 1.7);
  EXPECT_GE(least, 0.2 - 1e-9);
}

TEST(Medium, WindCarriesTheBillows) {
  AirSpec spec = fog(0.2, 0, 1);
  spec.wind = {2, 0, 0};
  const Medium medium(spec, 9);
  EXPECT_NEAR(medium.at(3).extinction({7, 1, 1}), medium.at(0).extinction({1, 1, 1}), 1e-6);
  EXPECT_NE(medium.at(3).extinction({1, 1, 1}), medium.at(0).extinction({1, 1, 1}));
}

double mass(const Air& air) {
  double sum = 0;
  for (const DustPuff& p : air.puffs())
    sum += p.extinction * p.deviation * p.deviation * p.deviation;
  return sum;
}

TEST(Medium, ABurstComesAtItsTimeSpreadsDriftsAndSettles) {
  AirSpec spec = dusty();
  spec.dust.period = 1000;  // one burst alone
  spec.dust.half_life = 4;
  const Medium medium(spec, 5);
  const double start = medium.burst_time(0);
  EXPECT_GE(start, 0);
  EXPECT_LE(start, 1000);
  EXPECT_TRUE(medium.at(start - 1e-3).puffs().empty());
  const Air young = medium.at(start + 2), old = medium.at(start + 6);
  ASSERT_EQ(young.puffs().size(), std::size_t(Medium::kPuffs));
  ASSERT_EQ(old.puffs().size(), young.puffs().size());
  for (std::size_t i = 0; i < old.puffs().size(); ++i) {
    EXPECT_GT(old.puffs()[i].deviation, young.puffs()[i].deviation);
    EXPECT_LT(old.puffs()[i].extinction, young.puffs()[i].extinction);
    EXPECT_GT(old.puffs()[i].centre.x, young.puffs()[i].centre.x + 1);  // 0.3 m/s for 4 s
    EXPECT_LT(old.puffs()[i].centre.z, young.puffs()[i].centre.z);
    EXPECT_GT(old.puffs()[i].centre.z, 0);
  }
  // One half-life, and the fade by age 6/20 against 2/20.
  EXPECT_NEAR(mass(old) / mass(young), 0.5 * (14.0 / 20) / (18.0 / 20), 1e-3);
  EXPECT_TRUE(medium.at(start + 20.001).puffs().empty());
  EXPECT_LT(mass(medium.at(start + 19.99)), 1e-3 * mass(young));  // it does not vanish in a jump
}

TEST(Medium, FollowsFromTheSeed) {
  const auto look = [](std::uint64_t seed) {
    const Air air = Medium(dusty(0.5), seed).at(9);
    return air.optical_depth({-3, 0, 1}, {1, 0, 0}, 6);
  };
  EXPECT_EQ(look(1), look(1));
  EXPECT_NE(look(1), look(2));
  const Medium beat(dusty(), 3);
  for (std::uint64_t i = 0; i < 50; ++i) {
    EXPECT_GE(beat.burst_time(i), 2.0 * double(i));
    EXPECT_LE(beat.burst_time(i), 2.0 * double(i + 1));
  }
}

}  // namespace medium_test
}  // namespace rubble
