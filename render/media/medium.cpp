#include "render/media/medium.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "kernel/base/quick_math.h"
#include "kernel/base/random.h"

namespace rubble {

namespace {

constexpr double kThrowTime = 0.5, kRiseTime = 0.2;  // unit: s
constexpr double kLives = 5;           // half-lives after which a puff is gone
constexpr double kWidest = 4.5;        // deviations; beyond, a puff is less than 5e-5 of its middle
constexpr double kStepShare = 1.0 / 6;  // of the largest billow
constexpr double kFarBillows = 60;
constexpr double kRootHalfPi = 1.2533141373155003, kRootHalf = 0.7071067811865476;

float smooth(float t) { return t * t * (3 - 2 * t); }

// Smooth noise of period kNoiseSide.
float block_noise(const float* block, float x, float y, float z) {
  constexpr int kMask = Medium::kNoiseSide - 1, kRow = Medium::kNoiseSide;
  const float fx = std::floor(x), fy = std::floor(y), fz = std::floor(z);
  const int x0 = int(fx) & kMask, y0 = int(fy) & kMask, z0 = int(fz) & kMask;
  const int x1 = (x0 + 1) & kMask, y1 = (y0 + 1) & kMask, z1 = (z0 + 1) & kMask;
  const float u = smooth(x - fx), v = smooth(y - fy), w = smooth(z - fz);
  const auto at = [&](int i, int j, int k) { return block[(k * kRow + j) * kRow + i]; };
  const auto row = [&](int j, int k) { return at(x0, j, k) + (at(x1, j, k) - at(x0, j, k)) * u; };
  const float a = row(y0, z0), b = row(y1, z0), c = row(y0, z1), d = row(y1, z1);
  return (a + (b - a) * v) * (1 - w) + (c + (d - c) * v) * w;
}

}  // namespace

double DustPuff::at(const Vec3& p) const {
  const Vec3 d = p - centre;
  const double q = dot(d, d) / (deviation * deviation);
  return q < kWidest * kWidest ? extinction * quick::exp(-0.5 * q) : 0;
}

double DustPuff::optical_depth(const Vec3& from, const Vec3& direction, double near,
                               double far) const {
  const Vec3 d = from - centre;
  const double along = dot(d, direction);
  const double aside2 = std::max(0.0, dot(d, d) - along * along);
  const double s = deviation;
  if (aside2 > kWidest * kWidest * s * s) return 0;
  const double low = (near + along) / s, high = (far + along) / s;
  if (low > kWidest || high < -kWidest) return 0;
  return extinction * quick::exp(-0.5 * aside2 / (s * s)) * s * kRootHalfPi *
         (quick::erf(high * kRootHalf) - quick::erf(low * kRootHalf));
}

bool Air::homogeneous() const {
  return puffs_.empty() && spec_.fog_height <= 0 && spec_.fog_noise <= 0;
}

double Air::fog(const Vec3& p) const {
  const bool falls = spec_.fog_height > 0 && p.z > 0;
  return falls ? spec_.fog_density * quick::exp(-p.z / spec_.fog_height) : spec_.fog_density;
}

// exp(-z/h) along a straight line is an exponential in the distance; below z = 0 it is constant.
double Air::fog_depth(const Vec3& from, const Vec3& direction, double distance) const {
  const double h = spec_.fog_height, density = spec_.fog_density;
  if (h <= 0 || density <= 0) return density * distance;
  const double slope = direction.z, end = from.z + slope * distance;
  if (from.z <= 0 && end <= 0) return density * distance;
  double low = 0;  // the part of the way that lies below the ground
  double z0 = from.z, above = distance;
  if (from.z < 0 || end < 0) {
    low = from.z < 0 ? -from.z / slope : end / slope;
    above = distance - low;
    z0 = std::max(from.z, 0.0);
  }
  const double x = slope * above / h;
  const double mean = std::fabs(x) < 1e-5 ? 1 - 0.5 * x : -quick::expm1(-x) / x;
  return density * (low + above * quick::exp(-z0 / h) * mean);
}

double Air::billows(const Vec3& p) const {
  if (spec_.fog_noise <= 0) return 1;
  const float scale = float(1 / spec_.fog_noise_size);
  const Vec3f q = Vec3f(p - drift_) * scale;
  const float* block = noise_->data();
  const float sum = block_noise(block, q.x, q.y, q.z) +
                    0.5f * block_noise(block, q.x * 2.03f + 7.7f, q.y * 2.03f, q.z * 2.03f) +
                    0.25f * block_noise(block, q.x * 4.1f, q.y * 4.1f + 3.1f, q.z * 4.1f);
  return 1 + spec_.fog_noise * double(std::clamp(sum * 1.3f, -1.0f, 1.0f));
}

double Air::extinction(const Vec3& p) const {
  double sum = fog(p);
  for (const DustPuff& puff : puffs_) sum += puff.at(p);
  return (sum > 0 ? sum * billows(p) : 0) + drops_;
}

double Air::scattering(const Vec3& p, double cosine) const {
  double dust = 0;
  for (const DustPuff& puff : puffs_) dust += puff.at(p);
  const double mist = fog(p);
  const double of_drops = drops_ > 0 ? drops_ * phase_function(Precipitation::kAsymmetry, cosine) : 0;
  if (!(mist + dust > 0)) return of_drops * albedo();
  return albedo() * (billows(p) * (mist * phase_function(fog_asymmetry(), cosine) +
                                   dust * phase_function(dust_asymmetry(), cosine)) + of_drops);
}

double Air::optical_depth(const Vec3& from, const Vec3& direction, double distance) const {
  double sum = drops_ > 0 ? drops_ * distance : 0;
  if (spec_.fog_noise <= 0) {
    for (const DustPuff& puff : puffs_) sum += puff.optical_depth(from, direction, 0, distance);
    return sum + fog_depth(from, direction, distance);
  }
  const double near = std::min(distance, kFarBillows * spec_.fog_noise_size);
  const int steps = std::max(1, int(std::ceil(near / (kStepShare * spec_.fog_noise_size))));
  const double step = near / steps;
  for (int i = 0; i < steps; ++i) {
    const double r = i * step;
    const Vec3 p = from + direction * r;
    double depth = fog_depth(p, direction, step);
    for (const DustPuff& puff : puffs_) depth += puff.optical_depth(from, direction, r, r + step);
    if (depth > 0) sum += depth * billows(p + direction * (0.5 * step));
  }
  if (near >= distance) return sum;
  for (const DustPuff& puff : puffs_) sum += puff.optical_depth(from, direction, near, distance);
  return sum + fog_depth(from + direction * near, direction, distance - near);
}

AirOnRay::AirOnRay(const Air& air, const Vec3& from, const Vec3& direction, double near, double far)
    : air_(air), from_(from), direction_(direction) {
  constexpr double kSlack = 1e-6;  // for rounding: relative, and unit: m
  for (const DustPuff& puff : air.puffs()) {
    const Vec3 d = from - puff.centre;
    const double along = dot(d, direction), reach = kWidest * puff.deviation;
    const double half2 = reach * reach * (1 + kSlack) - (dot(d, d) - along * along);
    if (half2 < 0) continue;
    const double half = std::sqrt(half2) + kSlack;
    if (half - along >= near && -half - along <= far) met_.push_back({&puff, -half - along, half - along});
  }
}

AirOnRay::Sample AirOnRay::at(double distance, double cosine) const {
  const Vec3 p = from_ + direction_ * distance;
  const double mist = air_.fog(p), drops = air_.drops();
  double all = mist, dust = 0;  // added in the orders of Air::extinction() and Air::scattering()
  for (const Met& met : met_) {
    if (distance < met.first || distance > met.last) continue;
    const double part = met.puff->at(p);
    all += part, dust += part;
  }
  const double billows = all > 0 || mist + dust > 0 ? air_.billows(p) : 1;
  Sample sample;
  sample.extinction = (all > 0 ? all * billows : 0) + drops;
  sample.scattering = drops > 0 ? drops * phase_function(Precipitation::kAsymmetry, cosine) : 0;
  if (mist + dust > 0)
    sample.scattering = billows * (mist * phase_function(air_.fog_asymmetry(), cosine) +
                                   dust * phase_function(air_.dust_asymmetry(), cosine)) + sample.scattering;
  sample.scattering *= air_.albedo();
  return sample;
}

Medium::Medium(const AirSpec& spec, std::uint64_t seed) : spec_(spec), seed_(seed) {
  if (spec.rain_mm_h > 0) falling_.emplace_back(PrecipitationKind::rain, spec.rain_mm_h);
  if (spec.snow_mm_h > 0) falling_.emplace_back(PrecipitationKind::snow, spec.snow_mm_h);
  if (spec.fog_noise <= 0) return;
  RandomStream random(seed, "air.noise");
  auto block = std::make_shared<std::vector<float>>(kNoiseSide * kNoiseSide * kNoiseSide);
  for (float& value : *block) value = float(random.uniform(-1, 1));
  noise_ = std::move(block);
}

bool Medium::homogeneous() const {
  return !has_dust() && spec_.fog_height <= 0 && spec_.fog_noise <= 0;
}

double Medium::burst_time(std::uint64_t burst) const {
  RandomStream random(seed_, "air.dust.time." + std::to_string(burst));
  const double off = random.uniform(-0.5, 0.5) * spec_.dust.irregularity;
  return (double(burst) + 0.5 + off) * spec_.dust.period;
}

void Medium::add_burst(std::uint64_t burst, double seconds, std::vector<DustPuff>& puffs) const {
  const DustSpec& dust = spec_.dust;
  const double age = seconds - burst_time(burst), gone = kLives * dust.half_life;
  if (age <= 0 || age >= gone) return;
  RandomStream random(seed_, "air.dust.place." + std::to_string(burst));
  const auto within = [&](double middle, double edge) {
    return middle + random.uniform(-0.5, 0.5) * edge;
  };
  Vec3 start;
  for (int i = 0; i < 3; ++i) start[i] = within(dust.position[i], dust.bounds[i]);
  const double left = quick::exp2(-age / dust.half_life) * (1 - age / gone) *
                      (1 - quick::exp(-age / kRiseTime));
  const double thrown = dust.speed * kThrowTime * (1 - quick::exp(-age / kThrowTime));
  for (int i = 0; i < kPuffs; ++i) {
    const double share = random.uniform(0.2, 1);
    Vec3 throw_out = random.direction() * share;
    throw_out.z = std::fabs(throw_out.z) * 0.6;
    const double r = dust.radius * random.uniform(0.6, 1.2);
    DustPuff puff;
    puff.deviation = std::sqrt(r * r + 2 * dust.spread * age);
    puff.centre = start + throw_out * thrown + spec_.wind * age - Vec3(0, 0, dust.fall * age);
    // What reaches the ground lies on it as a veil.
    puff.centre.z = std::max(puff.centre.z, std::min(start.z, 0.3 * puff.deviation));
    const double thinner = r / puff.deviation;
    puff.extinction = dust.density * random.uniform(0.3, 1) * left * thinner * thinner * thinner;
    puffs.push_back(puff);
  }
}

Air Medium::at(double seconds) const {
  Air air;
  air.spec_ = spec_;
  air.noise_ = noise_;
  air.falling_ = falling_;
  for (const Precipitation& kind : falling_) air.drops_ += kind.extinction();
  air.drift_ = spec_.wind * seconds;
  if (!has_dust() || seconds <= 0) return air;
  const double oldest = seconds - kLives * spec_.dust.half_life - spec_.dust.period;
  const std::uint64_t first = std::uint64_t(std::max(0.0, oldest / spec_.dust.period));
  const std::uint64_t last = std::uint64_t(seconds / spec_.dust.period);
  for (std::uint64_t burst = first; burst <= last; ++burst) add_burst(burst, seconds, air.puffs_);
  return air;
}

}  // namespace rubble
