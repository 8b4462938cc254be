#include "app/robots/live_colours.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/sensors/build_camera.h"
#include "kernel/base/system/disk_cache.h"

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
  spec.seed = camera_seed(scenario, mounted, scenario.seed);
  spec.channels.clear();
  spec.baseline = 0;
  spec.depth_sensor.type = DepthSensorType::none;
  spec.event_camera.on = false;
  return spec;
}

std::int64_t half_exposure_ns(const CameraSpec& spec) {
  const double longest = std::max(spec.exposure.time, spec.exposure.longest_time);
  const bool modelled = spec.exposure.mode != ExposureMode::ideal;
  return std::int64_t(std::ceil(0.5e9 * ((modelled ? longest : 0) + spec.shutter.readout)));
}

}  // namespace

LiveColours::LiveColours(const Scenario& scenario, const std::vector<RidingSensor>& cameras, const Scene& scene,
                         const LiveColoursOptions& options)
    : steps_(scenario.start_ns, options.step),
      gl_({options.gl_device, options.threads}),
      renderer_(gl_, scene, render_options(options.threads), options.progress) {
  const std::vector<MountedCamera> all = all_cameras(scenario);
  for (const RidingSensor& at : cameras) {
    const MountedCamera& mounted = all[at.number];
    const CameraSpec spec = build_eye(scenario, mounted, at.number, options.threads);
    Flight flight;
    flight.pose_at = [this, mounted](std::int64_t stamp_ns) {
      return place_on_mount(mounted, steps_.carrier_at(stamp_ns));
    };
    eyes_.push_back({at.number, steps_.add_carrier(at.mount), mounted,
                     mounted.rate_hz.value_or(scenario.trajectory.rate_hz), half_exposure_ns(spec),
                     std::make_unique<Camera>(renderer_, spec, std::move(flight))});
  }
}

LiveColours::~LiveColours() = default;

std::int64_t LiveColours::Eye::stamp_ns(std::int64_t start_ns) const {
  return start_ns + std::int64_t(std::floor(double(next) * 1e9 / rate_hz + 0.5));
}

void LiveColours::draw(Eye& eye, std::vector<SensedColours>& pictures) {
  const std::int64_t until = steps_.known_until() - eye.half_ns, start = steps_.start_ns();
  if (eye.stamp_ns(start) > until) return;
  steps_.begin_measuring(eye.carrier);
  for (std::int64_t stamp; (stamp = eye.stamp_ns(start)) <= until; ++eye.next) {
    // The time of the frame, which its stamp rounds.
    const Pose carrier = steps_.carrier_after(double(eye.next) / eye.rate_hz);
    eye.camera->fly_on(stamp, place_on_mount(eye.mounted, carrier));
    Frame frame = eye.camera->take(eye.next);
    pictures.push_back({stamp, eye.number, frame.intrinsics.width, frame.intrinsics.height, std::move(frame.rgb)});
  }
  steps_.end_measuring();
}

std::vector<SensedColours> LiveColours::take() {
  std::vector<SensedColours> pictures;
  for (Eye& eye : eyes_) draw(eye, pictures);
  std::int64_t needed = steps_.known_until();
  for (const Eye& eye : eyes_) needed = std::min(needed, eye.stamp_ns(steps_.start_ns()) - eye.half_ns);
  steps_.forget_before(needed);
  return pictures;
}

}  // namespace rubble
