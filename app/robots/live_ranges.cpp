#include "app/robots/live_ranges.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "kernel/base/error.h"
#include "kernel/base/random.h"

namespace rubble {
namespace {

constexpr double kFarthestDepth = 1000;  // along a ray; unit: m

// `key` is that of the camera in the mission.
DepthRays make_depth_rays(const MountedCamera& camera, const std::string& key) {
  const Intrinsics k = camera.camera.intrinsics();
  const bool straight = std::all_of(k.distortion.begin(), k.distortion.end(), [](double d) { return d == 0; });
  if (camera.camera.lens.model == LensKind::fisheye || !straight)
    throw InputError({"", 0, key + ".lens", "a controller cannot use this camera",
                      "a pinhole", "a lens with distortion", "add a second camera without `lens` for the controller"});
  return DepthRays(k, kFarthestDepth);
}

}  // namespace

LiveRanges::LiveRanges(const Scenario& scenario, const std::vector<RidingSensor>& lidars,
                       const std::vector<RidingSensor>& cameras, const Scene& scene, const Medium& medium,
                       double step, int threads)
    : steps_(scenario.start_ns, step), pool_(threads) {
  if (lidars.empty() && cameras.empty()) return;
  world_ = std::make_shared<LidarWorld>(scene);
  for (const RidingSensor& at : lidars) {
    const LidarScenario& lidar = scenario.lidars[at.number];
    const auto place = [this, carrier_from_lidar = lidar.rig_from_lidar()](std::int64_t stamp_ns) {
      return steps_.carrier_at(stamp_ns) * carrier_from_lidar;
    };
    // As the sensor that records: the same noise.
    const std::uint64_t seed = RandomStream(scenario.seed, "lidars/" + lidar.name).next();
    scanners_.push_back({at.number, steps_.add_carrier(at.mount),
                         std::make_unique<Lidar>(lidar.spec(), world_, LidarPlace{place, scenario.start_ns}, medium,
                                                 seed, threads)});
  }
  const std::vector<MountedCamera> all = all_cameras(scenario);
  for (const RidingSensor& at : cameras) {
    const MountedCamera& camera = all[at.number];
    const std::string key = scenario.cameras.empty() ? "camera" : "cameras." + camera.name;
    imagers_.push_back({at.number, steps_.add_carrier(at.mount), make_depth_rays(camera, key),
                        camera.rate_hz.value_or(scenario.trajectory.rate_hz), camera.rig_from_camera()});
  }
}

std::int64_t LiveRanges::Imager::stamp_ns(int image, std::int64_t start_ns) const {
  return start_ns + std::int64_t(std::floor(double(image) * 1e9 / rate_hz + 0.5));
}

void LiveRanges::restart(const World& world) {
  for (Scanner& scanner : scanners_) scanner.next = 0;
  for (Imager& imager : imagers_) imager.next = 0;
  steps_.restart(world);
}

void LiveRanges::scan(Scanner& scanner, std::vector<LidarScan>& scans) {
  const std::int64_t until = steps_.known_until();
  if (scanner.lidar->stamp_ns(scanner.next + 1) > until) return;
  steps_.begin_measuring(scanner.carrier);
  while (scanner.lidar->stamp_ns(scanner.next + 1) <= until) {
    scans.push_back(scanner.lidar->take(scanner.next++));
    scans.back().sensor = int(scanner.number);
  }
  steps_.end_measuring();
}

void LiveRanges::look(Imager& imager, std::vector<SensedDepth>& images) {
  const std::int64_t until = steps_.known_until(), start = steps_.start_ns();
  if (imager.stamp_ns(imager.next, start) > until) return;
  steps_.begin_measuring(imager.carrier);
  for (std::int64_t stamp; (stamp = imager.stamp_ns(imager.next, start)) <= until; ++imager.next) {
    const Intrinsics& k = imager.rays.intrinsics();
    SensedDepth& image = images.emplace_back();
    image = {stamp, imager.number, k.width, k.height, std::vector<float>(std::size_t(k.width) * std::size_t(k.height))};
    if (world_->moves()) world_->span(stamp, stamp);
    imager.rays.cast(*world_, steps_.carrier_at(stamp) * imager.carrier_from_camera, pool_, image.depth.data());
  }
  steps_.end_measuring();
}

LiveRanges::Readings LiveRanges::take() {
  Readings readings;
  for (Scanner& scanner : scanners_) scan(scanner, readings.scans);
  for (Imager& imager : imagers_) look(imager, readings.images);
  forget();
  return readings;
}

void LiveRanges::forget() {
  std::int64_t needed = std::numeric_limits<std::int64_t>::max();
  for (const Scanner& scanner : scanners_) needed = std::min(needed, scanner.lidar->stamp_ns(scanner.next));
  for (const Imager& imager : imagers_) needed = std::min(needed, imager.stamp_ns(imager.next, steps_.start_ns()));
  steps_.forget_before(needed);
}

}  // namespace rubble
