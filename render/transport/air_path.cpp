#include "render/transport/air_path.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "kernel/base/quick_math.h"
#include "render/media/air_box.h"

namespace rubble {

namespace {

constexpr int kMostSteps = 40;

// Cosine by which Henyey and Greenstein's law turns light (Witt 1977, equation 18).
float draw_cosine(double g, double random) {
  if (std::fabs(g) < 1e-3) return float(1 - 2 * random);
  const double s = (1 - g * g) / (1 - g + 2 * g * random);
  return float(std::clamp((1 + g * g - s * s) / (2 * g), -1.0, 1.0));
}

}  // namespace

bool AirPath::clip(const Vec3f& from, const Vec3f& direction, float& near, float& far) const {
  return clip_to_box(box_, from, direction, near, far);
}

float AirPath::passes(const Vec3f& from, const Vec3f& direction, float near, float far) const {
  if (clear_ || near >= far) return 1;
  return float(quick::exp(-air_.optical_depth(Vec3(from + direction * near), Vec3(direction),
                                            double(far - near))));
}

float AirPath::passes_in_box(const Vec3f& from, const Vec3f& direction, float far) const {
  float near = 0;
  if (clear_ || !clip(from, direction, near, far)) return 1;
  return passes(from, direction, near, far);
}

bool AirPath::find_event(const Vec3f& from, const Vec3f& direction, float near, float far,
                         float random, float& at) const {
  if (clear_ || near >= far) return false;
  const Vec3 start(from + direction * near), way(direction);
  const double wanted = -quick::log1p(-double(random)), length = double(far - near);
  if (air_.homogeneous()) {
    const double t = wanted / std::max(air_.extinction({}), 1e-12);
    at = near + float(t);
    return t < length;
  }
  double low = 0, high = length, below = 0, above = air_.optical_depth(start, way, length);
  if (above <= wanted) return false;
  // Between a place before it and one behind: a secant step, then a halving, in turn.
  for (int i = 0; i < kMostSteps && high - low > 1e-4 * (1 + high); ++i) {
    const double share = i % 2 ? 0.5 : std::clamp((wanted - below) / (above - below), 0.02, 0.98);
    const double middle = low + share * (high - low);
    const double depth = below + air_.optical_depth(start + way * low, way, middle - low);
    if (depth < wanted)
      low = middle, below = depth;
    else
      high = middle, above = depth;
  }
  at = near + float(0.5 * (low + high));
  return true;
}

AirPath::Shares AirPath::shares(const Vec3f& p) const {
  const Vec3 q(p);
  double dust = 0;
  for (const DustPuff& puff : air_.puffs()) dust += puff.at(q);
  const double fog = air_.fog(q), drops = air_.drops();
  if (drops <= 0) return {fog + dust > 0 ? float(fog / (fog + dust)) : 1, 0};
  const double billows = air_.billows(q), all = (fog + dust) * billows + drops;
  return {float(fog * billows / all), float(drops / all)};
}

float AirPath::phase(const Vec3f& p, float cosine) const {
  const Shares share = shares(p);
  const double c = double(cosine);
  float sum = 0;
  if (share.fog > 0) sum += share.fog * float(phase_function(air_.fog_asymmetry(), c));
  if (share.drops > 0) sum += share.drops * float(phase_function(Precipitation::kAsymmetry, c));
  if (share.fog + share.drops < 1)
    sum += (1 - share.fog - share.drops) * float(phase_function(air_.dust_asymmetry(), c));
  return sum;
}

Vec3f AirPath::sample_phase(const Vec3f& p, const Vec3f& direction, SamplePair u,
                            float choice) const {
  const Shares share = shares(p);
  const double g = choice < share.fog                 ? air_.fog_asymmetry()
                   : choice < share.fog + share.drops ? Precipitation::kAsymmetry
                                                      : air_.dust_asymmetry();
  const float cosine = draw_cosine(g, double(u.x));
  const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
  const float turn = 2 * float(portable::kPi) * u.y;
  const Vec3f side = std::fabs(direction.z) < 0.9f ? Vec3f(0, 0, 1) : Vec3f(1, 0, 0);
  const Vec3f x = normalized(cross(side, direction)), y = cross(direction, x);
  return normalized(direction * cosine + x * (sine * quick::cos(turn)) + y * (sine * quick::sin(turn)));
}

}  // namespace rubble
