#include "render/sensors/depth_sensor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/base/parallel.h"
#include "kernel/base/quick_math.h"
#include "render/sensors/noise_field.h"

namespace rubble {

namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr double kPi = portable::kPi;
constexpr double kLightSpeed = 299792458;  // unit: m/s
constexpr double kWidestAngle = 80 * kPi / 180;
constexpr int kWindow = 4;         // half the correlation window, in pixels of a 640-pixel image
constexpr double kJump = 0.03;     // of depth, as a share of it: another surface
constexpr int kAirSteps = 48;
constexpr double kNearestAir = 1e-3;  // of a ray that the emitter lights from the lens on; unit: m
constexpr double kCompact = 0.1;

std::size_t at(const DepthView& view, int u, int v) {
  return std::size_t(v) * std::size_t(view.rays.intrinsics.width) + std::size_t(u);
}

// Cosine of the angle at which a surface is seen.
double cosine_at(const DepthView& view, int u, int v) {
  const std::size_t i = at(view, u, v);
  const Vec3 n(double(view.normals[i * 3]), double(view.normals[i * 3 + 1]),
               double(view.normals[i * 3 + 2]));
  return std::max(0.0, -dot(n, view.rays.direction(u, v)));
}

}  // namespace

// What comes back along a ray, per unit of light that the sensor sends: from the surface and from
// the air before it.
struct DepthSensor::Returns {
  double surface = 0;  // 0: none within reach
  double air = 0;      // sum of the parts
  double range[kAirSteps] = {}, part[kAirSteps] = {};
  double middle = 0;         // range by which half of the air's light has come back
  double middle_half = 1e9;  // length from which its middle half comes

  void sum_up();
};

void DepthSensor::Returns::sum_up() {
  for (double p : part) air += p;
  double sum = 0, quarter = 0;
  for (int i = 0; i < kAirSteps; ++i) {
    const double before = sum;
    sum += part[i];
    if (before < 0.25 * air && sum >= 0.25 * air) quarter = range[i];
    if (before < 0.5 * air && sum >= 0.5 * air) middle = range[i];
    if (before < 0.75 * air && sum >= 0.75 * air) middle_half = range[i] - quarter;
  }
}

double DepthSensor::reflectance_at(const DepthView& view, int u, int v) const {
  const double stated = spec_.depth_sensor.reflectance;
  return stated > 0 ? stated : double(view.albedos[at(view, u, v)]);
}

double DepthSensor::emitter_offset() const {
  const DepthSensorSpec& s = spec_.depth_sensor;
  return s.type == DepthSensorType::structured_light ? s.baseline : s.emitter_offset;
}

// The emitter stands to the right and lights no more than the image's width: a ray of the slope x / z
// is lit from the z on at which it comes into the emitter's left edge.
double DepthSensor::lit_from(const DepthView& view, const Vec3& direction) const {
  const Intrinsics& k = view.rays.intrinsics;
  if (direction.z <= 0) return kNearestAir;
  const double left = -(k.cx + 0.5) / k.fx, slope = direction.x / direction.z;
  const double z = slope > left ? emitter_offset() / (slope - left) : 1e9;
  return std::max(kNearestAir, z / direction.z);
}

DepthSensor::Returns DepthSensor::trace_air(const DepthView& view, int u, int v,
                                            double distance) const {
  Returns out;
  const double reach = std::isnan(distance) ? 2 * spec_.depth_sensor.max_range : distance;
  const Pose pose = view.rays.pose(v);
  const Vec3 seen = view.rays.direction(u, v), direction = pose.rotation.rotate(seen);
  const Vec3 emitter{emitter_offset(), 0, 0};
  double depth = 0;  // optical, up to the step
  if (!view.air.clear()) {
    const double first = std::min(lit_from(view, seen), reach);
    depth = view.air.optical_depth(pose.translation, direction, first);
    // Each step is longer than the one before, as what comes back falls with the square of range.
    const double growth = quick::pow(reach / first, 1.0 / kAirSteps);
    double begin = first;
    const AirOnRay air(view.air, pose.translation, direction, first, reach);
    for (int i = 0; i < kAirSteps && growth > 1; ++i, begin *= growth) {
      const double end = begin * growth, r = std::sqrt(begin * end);
      const Vec3 from = seen * r - emitter;
      const double out2 = dot(from, from);
      const AirOnRay::Sample here = air.at(r, -dot(from, seen) / std::sqrt(out2));
      out.range[i] = 0.5 * (r + std::sqrt(out2));
      out.part[i] = here.scattering * (end - begin) / out2 * quick::exp(-2 * (depth + here.extinction * (r - begin)));
      depth += here.extinction * (end - begin);
    }
    out.sum_up();
  }
  if (!std::isnan(distance))
    out.surface = reflectance_at(view, u, v) / kPi * cosine_at(view, u, v) * quick::exp(-2 * depth) /
                  (distance * distance);
  return out;
}

float DepthSensor::measure_ideal(const DepthView& view, int u, int v) const {
  const double z =
      double(view.distances[at(view, u, v)]) * view.rays.direction(u, v).z;
  const DepthSensorSpec& s = spec_.depth_sensor;
  return z >= s.min_range && z <= s.max_range ? float(z) : kNone;
}

// Of eight places at the rim and half-way in a correlation window around the pixel.
double DepthSensor::other_surface_share(const DepthView& view, int u, int v) const {
  const Intrinsics& k = view.rays.intrinsics;
  const double z = double(view.distances[at(view, u, v)]);
  const int rim = std::max(1, int(std::lround(double(kWindow) * k.width / 640)));
  int other = 0, all = 0;
  for (const int reach : {std::max(1, rim / 2), rim}) {
    for (int dv = -1; dv <= 1; ++dv) {
      for (int du = -1; du <= 1; ++du) {
        const int x = u + du * reach, y = v + dv * reach;
        if ((!du && !dv) || x < 0 || y < 0 || x >= k.width || y >= k.height) continue;
        const double there = double(view.distances[at(view, x, y)]);
        ++all;
        other += std::isnan(there) || std::fabs(there - z) > kJump * z;
      }
    }
  }
  return all ? double(other) / all : 0;
}

float DepthSensor::measure_disparity(const DepthView& view, int u, int v) const {
  const DepthSensorSpec& s = spec_.depth_sensor;
  const std::size_t i = at(view, u, v);
  const NoiseField dice(spec_.seed, "depth/dice", std::uint64_t(view.frame));
  const NoiseField noise(spec_.seed, "depth/noise", std::uint64_t(view.frame));
  // Without noise, what is more likely.
  const auto happens = [&](double share, std::size_t die) { return s.noise ? dice.uniform(die) < share : share > 0.5; };
  const double distance = double(view.distances[i]), cosine = view.rays.direction(u, v).z;
  if (cosine <= 0) return kNone;
  const Returns returns = trace_air(view, u, v, distance);
  const double veil = returns.surface > 0 ? returns.air / returns.surface
                                          : (returns.air > 0 ? 1e9 : 0);
  double z = distance * cosine, growth = 1 + veil, angle = 0;
  const double lost = 1.5 * (veil / (1 + veil) - 1.0 / 3);
  if (happens(lost, i * 2)) {
    if (returns.middle_half > kCompact * returns.middle) return kNone;
    z = returns.middle * cosine, growth = 1;
  } else {
    if (std::isnan(distance) || !view.projected[i]) return kNone;
    angle = quick::acos(std::min(1.0, cosine_at(view, u, v)));
    if (angle > kWidestAngle) return kNone;
    if (happens(2 * other_surface_share(view, u, v), i * 2 + 1)) return kNone;
  }
  const double focal_baseline = view.rays.intrinsics.fx * 640 / view.rays.intrinsics.width *
                                s.baseline;
  double disparity = focal_baseline / z;
  if (s.noise) {
    // The rounding below is part of the noise that the specification states.
    const double rest = s.disparity_noise * s.disparity_noise -
                        s.disparity_step * s.disparity_step / 12;
    const double tilt = angle * angle / ((kPi / 2 - angle) * (kPi / 2 - angle));
    const double tilted = 1e-4 / std::sqrt(z) * tilt * focal_baseline / (z * z);
    const double sigma = std::sqrt(std::max(rest, 0.0)) * growth;
    disparity += std::sqrt(sigma * sigma + tilted * tilted) * noise.normal(i);
  }
  disparity = std::floor(disparity / s.disparity_step + 0.5) * s.disparity_step;
  const double measured = disparity > 0 ? focal_baseline / disparity : 1e9;
  return measured >= s.min_range && measured <= s.max_range ? float(measured) : kNone;
}

// Surface and air of one ray; the range is the phase. In electrons.
DepthSensor::Phasor DepthSensor::surface_phasor(const DepthView& view, int u, int v) const {
  const DepthSensorSpec& s = spec_.depth_sensor;
  const double distance = double(view.distances[at(view, u, v)]);
  if (view.rays.direction(u, v) == Vec3()) return {};
  const Returns returns = trace_air(view, u, v, distance);
  const double turn = 4 * kPi * s.modulation_mhz * 1e6 / kLightSpeed;
  Phasor sum;
  const auto add = [&](double share, double range) {
    const double electrons = s.signal * kPi * share;
    sum.real += electrons * quick::cos(turn * range);
    sum.imaginary += electrons * quick::sin(turn * range);
  };
  if (returns.surface > 0) add(returns.surface, distance);
  for (int i = 0; i < kAirSteps && returns.air > 0; ++i) add(returns.part[i], returns.range[i]);
  return sum;
}

float DepthSensor::measure_phase(const DepthView& view, const std::vector<Phasor>& phasors, int u,
                                 int v) const {
  const DepthSensorSpec& s = spec_.depth_sensor;
  const Intrinsics& k = view.rays.intrinsics;
  const std::size_t i = at(view, u, v);
  Phasor sum;
  double weights = 0;
  for (int y = std::max(v - 1, 0); y <= std::min(v + 1, k.height - 1); ++y) {
    for (int x = std::max(u - 1, 0); x <= std::min(u + 1, k.width - 1); ++x) {
      const double weight = (x == u ? 2 : 1) * (y == v ? 2 : 1);
      sum.real += weight * phasors[at(view, x, y)].real;
      sum.imaginary += weight * phasors[at(view, x, y)].imaginary;
      weights += weight;
    }
  }
  const double amplitude = quick::hypot(sum.real, sum.imaginary) / weights;
  if (amplitude < s.least_amplitude) return kNone;
  const double span = kLightSpeed / (2 * s.modulation_mhz * 1e6);
  double range = quick::atan2(sum.imaginary, sum.real) / (2 * kPi) * span;
  if (s.noise) {
    const NoiseField noise(spec_.seed, "depth/noise", std::uint64_t(view.frame));
    range += span / std::sqrt(8) * std::sqrt(amplitude + s.background) / (2 * amplitude) *
             noise.normal(i);
  }
  range -= span * std::floor(range / span);
  double z = range * view.rays.direction(u, v).z;
  if (s.step > 0) z = std::floor(z / s.step + 0.5) * s.step;
  return z >= s.min_range && z <= s.max_range ? float(z) : kNone;
}

std::vector<float> DepthSensor::measure(const DepthView& view) const {
  const Intrinsics& k = view.rays.intrinsics;
  std::vector<float> out(view.distances.size(), kNone);
  std::vector<Phasor> phasors;
  const auto each_pixel = [&](const auto& job) {
    parallel_for(std::size_t(k.height), spec_.threads, [&](std::size_t v) {
      for (int u = 0; u < k.width; ++u) job(at(view, u, int(v)), u, int(v));
    });
  };
  const DepthSensorType type = spec_.depth_sensor.type;
  if (type == DepthSensorType::time_of_flight) {
    phasors.resize(out.size());
    each_pixel([&](std::size_t i, int u, int v) { phasors[i] = surface_phasor(view, u, v); });
  }
  each_pixel([&](std::size_t i, int u, int v) {
    if (type == DepthSensorType::structured_light)
      out[i] = measure_disparity(view, u, v);
    else if (type == DepthSensorType::time_of_flight)
      out[i] = measure_phase(view, phasors, u, v);
    else
      out[i] = measure_ideal(view, u, v);
  });
  return out;
}

}  // namespace rubble
