#include "render/lidar/lidar.h"

#include <algorithm>

namespace rubble {
namespace {

constexpr std::int64_t kKnot = 50'000;       // between poses of the carrier; unit: ns
constexpr int kGrain = 64;                   // rays that a thread takes at once

Pose between(const Pose& a, const Pose& b, double share) {
  const Quat &p = a.rotation, &q = b.rotation;
  const double sign = p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z < 0 ? -1 : 1;
  const double u = 1 - share, v = sign * share;
  return {normalized(Quat(p.w * u + q.w * v, p.x * u + q.x * v, p.y * u + q.y * v, p.z * u + q.z * v)),
          a.translation * u + b.translation * share};
}

}  // namespace

// Rays that are cast together.
struct Lidar::Slice {
  const std::vector<PatternRay>& rays;
  const std::vector<Pose>& poses;  // at the knots of the scan
  std::int64_t begin_ns = 0, length_ns = 1;  // since the scan's stamp
  Air air;
  NoiseField noise;
};

Lidar::Lidar(const LidarSpec& spec, std::shared_ptr<RayWorld> world, LidarPlace place,
             const Medium& medium, std::uint64_t seed, int threads)
    : spec_(std::make_shared<const LidarSpec>(spec)),
      world_(std::move(world)),
      place_(std::move(place)),
      medium_(medium),
      seed_(seed),
      pattern_(*spec_),
      pool_(threads) {}

std::vector<Pose> Lidar::poses_of(std::int64_t stamp_ns, std::int64_t duration_ns) {
  // As far as the scan's own list of poses goes.
  constexpr std::int64_t kStep = RangeScan::kMotionStep;
  std::vector<Pose> poses(std::size_t((duration_ns / kStep + 1) * kStep / kKnot + 1));
  pool_.run(int(poses.size()), kGrain, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) poses[std::size_t(i)] = place_.world_from_sensor(stamp_ns + i * kKnot);
  });
  return poses;
}

// Two slots of `found` a ray.
void Lidar::measure(const Slice& slice, std::size_t begin, std::size_t end, std::vector<ScanPoint>& found,
                    std::vector<std::uint8_t>& counts) const {
  const Beam beam(*spec_, *world_);
  for (std::size_t i = begin; i < end; ++i) {
    const PatternRay& ray = slice.rays[i];
    const auto knot = std::size_t(ray.offset_ns / kKnot);
    const Pose pose = between(slice.poses[knot], slice.poses[knot + 1],
                              double(ray.offset_ns - std::int64_t(knot) * kKnot) / double(kKnot));
    const float time = float(double(ray.offset_ns - slice.begin_ns) / double(slice.length_ns));
    const Echoes echoes = beam.measure({pose * ray.origin, pose.rotation.rotate(ray.direction), time}, slice.air,
                                       slice.noise, i);
    counts[i] = std::uint8_t(echoes.count);
    for (int e = 0; e < echoes.count; ++e) {
      const Echo& echo = echoes.list[std::size_t(e)];
      const Vec3f at(ray.origin + ray.direction * echo.range);
      found[2 * i + std::size_t(e)] = {at.x,     at.y, at.z, float(echo.intensity), float(double(ray.offset_ns) * 1e-9),
                                       ray.ring, ray.column};
    }
  }
}

RangeScan Lidar::take(int scan) {
  RangeScan out;
  out.spec = spec_;
  out.index = scan;
  out.stamp_ns = stamp_ns(scan);
  const std::vector<PatternRay>& rays = pattern_.rays(scan);
  const std::int64_t duration = rays.back().offset_ns;
  const std::vector<Pose> poses = poses_of(out.stamp_ns, duration);
  for (std::size_t i = 0; i < poses.size(); i += std::size_t(RangeScan::kMotionStep / kKnot))
    out.world_from_sensor.push_back(poses[i]);
  std::vector<ScanPoint> found(2 * rays.size());
  std::vector<std::uint8_t> counts(rays.size());
  const bool still = !world_->moves() && medium_.homogeneous();
  const std::int64_t length = still ? duration + 1 : kSceneStep;
  for (std::int64_t from = 0; from <= duration; from += length) {
    const auto first_after = [&](std::int64_t offset) {
      return std::size_t(std::partition_point(rays.begin(), rays.end(), [&](const PatternRay& r) {
                           return r.offset_ns < offset;
                         }) - rays.begin());
    };
    const std::size_t first = first_after(from), last = first_after(from + length);
    world_->span(out.stamp_ns + from, out.stamp_ns + from + length);
    const double seconds = double(out.stamp_ns + from - place_.start_ns) * 1e-9;
    const Slice slice{rays, poses, from, length, medium_.at(seconds), NoiseField(seed_, "lidar", std::uint64_t(scan))};
    pool_.run(int(last - first), kGrain, [&](int begin, int end) {
      measure(slice, first + std::size_t(begin), first + std::size_t(end), found, counts);
    });
  }
  for (std::size_t i = 0; i < rays.size(); ++i)
    for (std::size_t e = 0; e < counts[i]; ++e) out.points.push_back(found[2 * i + e]);
  return out;
}

}  // namespace rubble
