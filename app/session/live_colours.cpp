#include "app/session/live_colours.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/sensors/build_camera.h"
#include "app/sensors/exact_depth.h"
#include "kernel/base/system/disk_cache.h"
#include "render/sensors/camera.h"

namespace rubble {
namespace {

RenderOptions render_options(int threads) {
  RenderOptions options;
  options.threads = threads;
  options.cache_folder = DiskCache::usual_folder();
  return options;
}

// What is developed is what the recorded camera gives, and nothing besides.
CameraSpec build_eye(const Scenario& scenario, const MountedCamera& mounted, std::size_t number, int threads) {
  CameraSpec spec = build_camera(scenario, mounted, threads);
  spec.number = int(number);
  spec.seed = camera_seed(mounted, scenario.seed);
  spec.channels.clear();
  spec.baseline = 0;
  spec.depth_sensor.type = DepthSensorType::none;
  spec.event_camera.on = false;
  return spec;
}

// From the start of an exposure to its stamp, and from there to its end, at most.
std::int64_t half_exposure_ns(const CameraSpec& spec) {
  const double longest = std::max(spec.exposure.time, spec.exposure.longest_time);
  const bool modelled = spec.exposure.mode != ExposureMode::ideal;
  return std::int64_t(std::ceil(0.5e9 * ((modelled ? longest : 0) + spec.shutter.readout)));
}

class Eye : public LiveSensor {
 public:
  Eye(Renderer& renderer, const Scenario& scenario, const MountedCamera& mounted, const CameraSpec& spec,
      std::shared_ptr<const MotionPath> way)
      : mounted_(mounted),
        number_(spec.number),
        start_ns_(scenario.start_ns),
        half_ns_(half_exposure_ns(spec)),
        rate_hz_(mounted.rate_hz.value_or(scenario.trajectory.rate_hz)),
        way_(std::move(way)),
        camera_(renderer, spec, fly()) {}

  Needs needs() const override { return {stamp_ns() - half_ns_, stamp_ns() + half_ns_, stamp_ns() + half_ns_}; }
  Sample take() override {
    const std::int64_t stamp = stamp_ns();
    // The time of the frame, which its stamp rounds.
    const Pose carrier = way_->at(double(next_) / rate_hz_);
    camera_.fly_on(stamp, place_on_mount(mounted_, carrier));
    Frame drawn = camera_.take(next_++);
    drawn.sensor = number_;
    drawn.world_from_rig = carrier;
    drawn.depth.clear();
    return drawn;
  }

 private:
  std::int64_t stamp_ns() const { return start_ns_ + std::int64_t(std::floor(double(next_) * 1e9 / rate_hz_ + 0.5)); }
  Flight fly() const {
    Flight flight;
    flight.pose_at = [way = way_, mounted = mounted_, start = start_ns_](std::int64_t stamp_ns) {
      return place_on_mount(mounted, way->at(double(stamp_ns - start) * 1e-9));
    };
    return flight;
  }

  MountedCamera mounted_;
  int number_, next_ = 0;
  std::int64_t start_ns_, half_ns_;
  double rate_hz_;
  std::shared_ptr<const MotionPath> way_;
  Camera camera_;
};

}  // namespace

LiveColours::LiveColours(const Scene& scene, const LiveColoursOptions& options)
    : gl_({options.gl_device, options.threads}),
      renderer_(gl_, scene, render_options(options.threads), options.progress) {}

std::unique_ptr<LiveSensor> LiveColours::make_eye(const LiveSensorParts& parts, std::size_t number) {
  const MountedCamera& mounted = parts.scenario.cameras.at(number);
  return std::make_unique<Eye>(renderer_, parts.scenario, mounted,
                               build_eye(parts.scenario, mounted, number, parts.threads),
                               parts.history.way_of(mounted.ride, mounted.key()));
}

}  // namespace rubble
