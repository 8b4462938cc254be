#include "render/lidar/beam.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "kernel/base/quick_math.h"

namespace rubble {
namespace {

constexpr std::size_t kRays = RayWorld::kPacket;
constexpr double kNoOverlap = 0.9, kFullOverlap = 1.0;  // of transmitter and receiver; unit: m
constexpr double kStrengthNoise = 0.1;                  // standard deviation, as a share
constexpr int kAirSteps = 48;

// Places of a ray's random numbers.
enum Use : std::uint64_t { kAirRange, kDetection, kRange = kDetection + 9, kUses = kRange + 2 };

// Directions around an axis, in units of the Gaussian's standard deviation.
const std::array<std::array<double, 2>, kRays>& spread() {
  static const auto made = [] {
    std::array<std::array<double, 2>, kRays> out{};
    const double radius = std::sqrt(16.0 / 7);
    for (std::size_t i = 1; i < kRays; ++i) {
      const portable::SinCos a = portable::sincos(2 * portable::kPi * double(i - 1) / (kRays - 1));
      out[i] = {radius * a.cos, radius * a.sin};
    }
    return out;
  }();
  return made;
}

double overlap(double range) {
  return std::clamp((range - kNoOverlap) / (kFullOverlap - kNoOverlap), 0.0, 1.0);
}

}  // namespace

// What comes back, unsorted: of each ray that meets something, and of the air.
struct Beam::Parts {
  struct Part {
    double range = 0, energy = 0;
  };
  std::array<Part, kRays + 1> list;
  int count = 0;
  double nearest = 0;  // of the surfaces, or max_range; unit: m

  void add(double range, double energy) { list[std::size_t(count++)] = {range, energy}; }
};

void Beam::add_surfaces(const RayWorld::Ray& axis, const Air& air, Parts& parts) const {
  std::array<RayWorld::Ray, kRays> rays;
  std::array<RayWorld::Hit, kRays> hits;
  rays.fill(axis);
  const std::size_t count = spec_.divergence_mrad > 0 ? kRays : 1;
  const double deviation = 0.25e-3 * spec_.divergence_mrad;  // unit: rad
  const Vec3 side = std::fabs(axis.direction.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
  const Vec3 x = normalized(cross(side, axis.direction)), y = cross(axis.direction, x);
  for (std::size_t i = 1; i < count; ++i)
    rays[i].direction = normalized(axis.direction + x * (deviation * spread()[i][0]) +
                                   y * (deviation * spread()[i][1]));
  const double reach = spec_.max_range + spec_.echo_separation;
  world_.cast(rays.data(), count, reach, hits.data());
  parts.nearest = spec_.max_range;
  const bool clear = air.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const RayWorld::Hit& hit = hits[i];
    if (hit.distance <= 0) continue;
    double light = double(hit.reflectance) * double(hit.cosine) / double(count);
    if (!clear) light *= quick::exp(-2 * air.optical_depth(axis.from, rays[i].direction, hit.distance));
    parts.add(hit.distance, light / (hit.distance * hit.distance));
    parts.nearest = std::min(parts.nearest, hit.distance);
  }
}

// The first step is that in which transmitter and receiver come to overlap; those after it grow with range,
// as what comes back falls with its square.
void Beam::add_air(const RayWorld::Ray& axis, const Air& air, double random, Parts& parts) const {
  const double last = parts.nearest, second = std::min(kFullOverlap, last);
  if (last <= kNoOverlap) return;
  std::array<double, kAirSteps + 1> edge{}, sum{};
  const double growth = quick::pow(last / second, 1.0 / (kAirSteps - 1));
  edge[0] = kNoOverlap, edge[1] = second;
  for (std::size_t i = 2; i <= kAirSteps; ++i) edge[i] = edge[i - 1] * growth;
  double depth = air.optical_depth(axis.from, axis.direction, kNoOverlap);
  const AirOnRay on_ray(air, axis.from, axis.direction, kNoOverlap, last);
  for (std::size_t i = 0; i < kAirSteps; ++i) {
    const double length = edge[i + 1] - edge[i], r = edge[i] + 0.5 * length;
    const AirOnRay::Sample here = on_ray.at(r, -1);
    const double step = here.extinction * length;
    sum[i + 1] = sum[i] + portable::kPi * here.scattering * overlap(r) * length / (r * r) *
                              quick::exp(-2 * (depth + 0.5 * step));
    depth += step;
  }
  if (sum[kAirSteps] <= 0) return;
  const auto sum_until = [&](double range) {
    const auto above = std::upper_bound(edge.begin(), edge.end(), range);
    if (above == edge.begin()) return 0.0;
    if (above == edge.end()) return sum[kAirSteps];
    const auto i = std::size_t(above - edge.begin());
    return sum[i - 1] + (sum[i] - sum[i - 1]) * (range - edge[i - 1]) / (edge[i] - edge[i - 1]);
  };
  const double wanted = random * sum[kAirSteps];
  const auto i = std::size_t(std::upper_bound(sum.begin(), sum.end() - 1, wanted) - sum.begin());
  double share = sum[i] > sum[i - 1] ? (wanted - sum[i - 1]) / (sum[i] - sum[i - 1]) : 0;
  if (i == 1) share = std::sqrt(share);  // the overlap grows in proportion
  const double range = edge[i - 1] + (edge[i] - edge[i - 1]) * share;
  const double half = 0.5 * spec_.echo_separation;
  parts.add(range, sum_until(range + half) - sum_until(range - half));
}

int Beam::merge(Parts& parts, const NoiseField& noise, std::uint64_t ray,
                std::array<Echo, 9>& found) const {
  const auto begin = parts.list.begin(), end = begin + parts.count;
  std::sort(begin, end, [](const auto& a, const auto& b) { return a.range < b.range; });
  const double enough = 0.1 / (spec_.range_at_10_percent * spec_.range_at_10_percent);
  int count = 0;
  for (auto first = begin; first != end;) {
    auto next = first;
    double energy = 0, weighted = 0;
    for (; next != end && next->range - first->range < spec_.echo_separation; ++next)
      energy += next->energy, weighted += next->energy * (next->range - first->range);
    Echo echo{first->range + (energy > 0 ? weighted / energy : 0), energy / enough, 0};
    echo.intensity = 100 * energy * echo.range * echo.range;
    first = next;
    const double seen =
        spec_.noise ? echo.strength *
                          (1 + kStrengthNoise * noise.normal(ray * kUses + kDetection + std::uint64_t(count)))
                    : echo.strength;
    if (seen < 1 || echo.range < spec_.min_range || echo.range > spec_.max_range) continue;
    found[std::size_t(count++)] = echo;
  }
  return count;
}

Echoes Beam::choose(const std::array<Echo, 9>& found, int count) const {
  Echoes out;
  if (count == 0) return out;
  const auto weaker = [](const Echo& a, const Echo& b) { return a.strength < b.strength; };
  const auto last = std::size_t(count - 1);
  if (spec_.returns == LidarReturns::last) {
    out.list[0] = found[last], out.count = 1;
    return out;
  }
  const auto strongest =
      std::size_t(std::max_element(found.begin(), found.begin() + count, weaker) - found.begin());
  out.list[0] = found[strongest], out.count = 1;
  if (spec_.returns == LidarReturns::strongest || count == 1) return out;
  // The last; where that is the strongest, the next strongest.
  std::size_t other = last;
  if (strongest == last)
    other = std::size_t(std::max_element(found.begin(), found.begin() + count - 1, weaker) - found.begin());
  out.list[1] = found[other], out.count = 2;
  return out;
}

double Beam::round_range(double range, double normal) const {
  if (spec_.noise) range += spec_.range_noise * normal;
  if (spec_.range_step > 0) range = std::floor(range / spec_.range_step + 0.5) * spec_.range_step;
  return std::clamp(range, spec_.min_range, spec_.max_range);
}

Echoes Beam::measure(const RayWorld::Ray& axis, const Air& air, const NoiseField& noise,
                     std::uint64_t ray) const {
  Parts parts;
  add_surfaces(axis, air, parts);
  if (!air.clear()) add_air(axis, air, noise.uniform(2 * (ray * kUses + kAirRange)), parts);
  std::array<Echo, 9> found;
  Echoes echoes = choose(found, merge(parts, noise, ray, found));
  for (int i = 0; i < echoes.count; ++i) {
    double& range = echoes.list[std::size_t(i)].range;
    range = round_range(range, noise.normal(ray * kUses + kRange + std::uint64_t(i)));
  }
  return echoes;
}

}  // namespace rubble
