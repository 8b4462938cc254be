#include "render/sensors/camera.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include "kernel/base/error.h"
#include "kernel/base/parallel.h"
#include "render/optics/lens_optics.h"
#include "render/sensors/depth_sensor.h"
#include "render/sensors/event_camera.h"
#include "render/sensors/exposure_control.h"
#include "render/sensors/image_sensor.h"
#include "render/sensors/motion.h"
#include "render/streams/image_streams.h"

namespace rubble {

namespace {

// A motion shorter than this leaves a sharp image; unit: pixel.
constexpr double kSharp = 0.5;
constexpr int kMostEventImages = 1000;  // between two frames

void add_scaled(std::vector<float>& sum, const std::vector<float>& image, float factor, int threads) {
  constexpr std::size_t kChunk = 1 << 16;
  parallel_for((sum.size() + kChunk - 1) / kChunk, threads, [&](std::size_t job) {
    for (std::size_t i = job * kChunk; i < std::min((job + 1) * kChunk, sum.size()); ++i) sum[i] += factor * image[i];
  });
}

std::vector<float> luminance_of(const std::vector<float>& rgb) {  // unit: cd/m2
  std::vector<float> out(rgb.size() / 3);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = 1000 * (0.2126f * rgb[i * 3] + 0.7152f * rgb[i * 3 + 1] + 0.0722f * rgb[i * 3 + 2]);
  return out;
}

}  // namespace

struct Camera::State {
  State(Renderer& r, const CameraSpec& s, Flight f);

  Renderer& renderer;
  CameraSpec spec;
  Flight flight;
  std::shared_ptr<const LensDirections> directions;  // none: a pinhole that needs none
  std::vector<Intrinsics> pixel_parts;  // of a pixel: the camera shifted to the middle of each
  std::vector<std::shared_ptr<const LensDirections>> part_directions;  // of each, as above
  ExposureControl exposure;
  std::unique_ptr<LensOptics> optics;   // none: a perfect lens
  std::unique_ptr<ImageSensor> sensor;  // none: an ideal image
  DepthSensor depth_sensor;
  std::unique_ptr<EventPixels> events;
  std::shared_ptr<LightWatch> light_watch;  // null: the device does not find which pixels report
  bool settled = false;
  double last_mean = 0;  // of the frame before, for the exposure
  struct Watched {  // the last image of the event camera
    ViewRays view;
    std::vector<float> distances;
    std::vector<MomentNearby> way;  // from the image to the frame that comes next, see longest_way()
  } watched;

  Pose pose_at(std::int64_t stamp_ns, std::int64_t frame_ns, const Pose& at_frame) const;
  // Of what bears the lamp; nothing: the camera itself.
  std::optional<Pose> rig_of(const Pose& world_from_camera) const;
  ViewRays view_at(int index, double seconds_off = 0) const;
  ViewRays view_beside(ViewRays view, int part) const;
  ViewRays right_of(ViewRays view) const;

  RenderedView open_view(int index);
  // A view that a device has begun while the frame before was read.
  struct Ahead {
    int index;
    RenderedView view;
  };
  std::optional<Ahead> ahead;
  RenderedView open_begun_view(int index);
  void begin_next(int index, RenderedView::Begun what);
  std::vector<MomentNearby> way_between(std::int64_t from, std::int64_t to, std::int64_t frame_ns, const Pose& at_frame,
                                        RenderedView& view) const;
  Frame take_ideal(int index);
  Frame take_exposed(int index);
  ExposureSettings expose(int index, RenderedView& view);
  int count_samples(int index, RenderedView& view, const ExposureSettings& settings) const;
  std::vector<float> gather_light(int index, const LinearFrame* middle, int samples, double time,
                                  bool right);
  std::vector<float> defocus(const LinearFrame& image) const;
  void add_drops(int index, const LinearFrame* middle, double time, bool right, std::vector<float>& light);
  std::vector<float> measure_depth(int index, RenderedView& view);
  void watch(int index, Frame& frame);
};

Camera::State::State(Renderer& r, const CameraSpec& s, Flight f)
    : renderer(r), spec(s), flight(std::move(f)), exposure(s.exposure), depth_sensor(s) {
  const Intrinsics& k = spec.intrinsics;
  const bool modelled = spec.exposure.mode != ExposureMode::ideal;
  if (spec.shutter.motion_blur && !modelled)
    throw RunError("motion blur needs an exposure time: the exposure must not be ideal");
  if (spec.optics.any() && !modelled)
    throw RunError("a real lens needs an exposure that is modelled: the exposure must not be ideal");
  if (!Lens(k).is_pinhole()) directions = make_lens_directions(k, spec.threads);
  const int across = spec.sensor.pixel_samples;
  for (int i = 0; across > 1 && i < across * across; ++i) {
    Intrinsics part = k;  // a pixel sees what lies beside it
    part.cx -= (i % across + 0.5) / across - 0.5;
    part.cy -= (i / across + 0.5) / across - 0.5;
    pixel_parts.push_back(part);
    part_directions.push_back(directions ? make_lens_directions(part, spec.threads) : nullptr);
  }
  if (modelled)
    sensor = std::make_unique<ImageSensor>(
        spec, directions ? *directions : *make_lens_directions(k, spec.threads));
  if (spec.optics.any())
    optics = std::make_unique<LensOptics>(spec.optics, spec.exposure.f_number, k, spec.seed, spec.threads);
  if (spec.event_camera.on)
    events = std::make_unique<EventPixels>(spec.event_camera, k.width, k.height, spec.seed);
  if (events) light_watch = renderer.watch_light(events->pixels());
}

// The frame's own pose at its own stamp, so that rounding between the two cannot show.
Pose Camera::State::pose_at(std::int64_t stamp_ns, std::int64_t frame_ns,
                            const Pose& at_frame) const {
  return stamp_ns == frame_ns ? at_frame : flight.pose_at(stamp_ns);
}

std::optional<Pose> Camera::State::rig_of(const Pose& world_from_camera) const {
  if (!spec.rig_from_camera) return std::nullopt;
  return world_from_camera * spec.rig_from_camera->inverse();
}

ViewRays Camera::State::view_at(int index, double seconds_off) const {
  const std::int64_t frame_ns = flight.stamps_ns[std::size_t(index)];
  const Pose& at_frame = flight.world_from_camera[std::size_t(index)];
  ViewRays view;
  view.stamp_ns = frame_ns + std::llround(seconds_off * 1e9);
  view.intrinsics = spec.intrinsics;
  view.world_from_camera = pose_at(view.stamp_ns, frame_ns, at_frame);
  view.directions = directions;
  view.world_from_rig = rig_of(view.world_from_camera);
  view.noise = (std::uint64_t(spec.number) << 33) + 2 * std::uint64_t(index);
  if (spec.shutter.readout <= 0) return view;
  const int rows = spec.intrinsics.height;
  for (int v = 0; v < rows; ++v) {
    const double late = spec.shutter.readout * (double(v) / std::max(1, rows - 1) - 0.5);
    const std::int64_t stamp = view.stamp_ns + std::llround(late * 1e9);
    view.row_poses.push_back(pose_at(stamp, frame_ns, at_frame) * camera_from_optical);
  }
  return view;
}

ViewRays Camera::State::view_beside(ViewRays view, int part) const {
  if (pixel_parts.empty()) return view;
  view.intrinsics = pixel_parts[std::size_t(part)];
  view.directions = part_directions[std::size_t(part)];
  return view;
}

ViewRays Camera::State::right_of(ViewRays view) const {
  view.world_from_rig = view.lamp_bearer();  // the one lamp of the pair stays where it is
  ++view.noise;
  const Pose right{{}, {0, -spec.baseline, 0}};
  view.world_from_camera = view.world_from_camera * right;
  const Pose in_optical = camera_from_optical.inverse() * right * camera_from_optical;
  for (Pose& pose : view.row_poses) pose = pose * in_optical;
  return view;
}

// With the view of the frame that follows, where a stream needs it.
RenderedView Camera::State::open_view(int index) {
  const bool more = index + 1 < int(flight.stamps_ns.size());
  const bool needed = std::any_of(spec.channels.begin(), spec.channels.end(),
                                  [](const ImageStream* s) { return s->needs_next; });
  if (!more || !needed) return renderer.view(view_at(index));
  const ViewRays next = view_at(index + 1);
  return renderer.view(view_at(index), &next);
}

RenderedView Camera::State::open_begun_view(int index) {
  std::optional<Ahead> begun = std::exchange(ahead, {});
  if (begun && begun->index == index) return std::move(begun->view);
  return open_view(index);
}

// So that a device has work while the processor reads and keeps the frame.
void Camera::State::begin_next(int index, RenderedView::Begun what) {
  if (index + 1 >= int(flight.stamps_ns.size()) || !renderer.runs_ahead()) return;
  ahead = Ahead{index + 1, open_view(index + 1)};
  ahead->view.begin(what);
}

std::vector<float> Camera::State::measure_depth(int index, RenderedView& view) {
  if (spec.depth_sensor.type == DepthSensorType::none) return {};
  const auto& normals =
      std::get<std::vector<float>>(view.truth(*find_image_stream("normals")));
  std::vector<std::uint8_t> projected;
  if (spec.depth_sensor.type == DepthSensorType::structured_light)
    projected = view.line_of_sight_mask(depth_sensor.projector());
  std::vector<float> albedos;
  if (spec.depth_sensor.reflectance <= 0) albedos = view.albedos();
  return depth_sensor.measure(
      {view.rays(), view.distances(), normals, projected, albedos, view.air(), index});
}

Frame Camera::State::take_ideal(int index) {
  RenderedView view = open_begun_view(index);
  view.begin();
  const bool stereo = spec.baseline > 0;  // the right image needs the exposure of the left
  if (!stereo) begin_next(index, RenderedView::Begun::rgb);
  std::vector<float> measured = measure_depth(index, view);
  const ViewRays right = right_of(view.rays());
  const float exposed = view.exposure();
  Frame frame = std::move(view).into_frame(index, spec.channels);
  frame.measured_depth = std::move(measured);
  if (stereo) frame.rgb_right = renderer.view(right).rgb_at(exposed), begin_next(index, RenderedView::Begun::rgb);
  return frame;
}

// Where the camera and the surfaces of a view are on the way. at_frame: the pose of a frame at its stamp.
std::vector<MomentNearby> Camera::State::way_between(std::int64_t from, std::int64_t to, std::int64_t frame_ns, const Pose& at_frame,
                                                     RenderedView& view) const {
  std::vector<MomentNearby> out;
  for (const std::int64_t stamp : cut_way(flight, from, to))
    out.push_back({pose_at(stamp, frame_ns, at_frame), view.shifts(stamp)});
  return out;
}

// One more than the pixels of motion, and odd, so that the middle one is the frame's own instant.
int Camera::State::count_samples(int index, RenderedView& view, const ExposureSettings& settings) const {
  if (!spec.shutter.motion_blur) return 1;
  const std::int64_t stamp = flight.stamps_ns[std::size_t(index)], half = std::llround(0.5 * settings.time * 1e9);
  const double motion = longest_way(view.rays(), view.distances(),
                                    way_between(stamp - half, stamp + half, stamp, flight.world_from_camera[std::size_t(index)], view));
  if (motion < kSharp) return 1;
  const int wanted = int(std::min(std::ceil(motion), 1000.0)) + 1;
  const int most = spec.shutter.most_samples - (spec.shutter.most_samples % 2 ? 0 : 1);
  return std::clamp(wanted | 1, 3, most);
}

// The light of one instant; what is the same at all distances comes after the mean.
std::vector<float> Camera::State::defocus(const LinearFrame& image) const {
  const bool flat = spec.intrinsics.lens == LensModel::plumb_bob;
  return optics->defocus(image.rgb, flat ? image.depth : image.distance);
}

// The mean light over the exposure, and over the parts of a pixel: images at the middles of equal parts
// of both. middle: that of the whole pixel in the middle of the exposure, if it is there already.
std::vector<float> Camera::State::gather_light(int index, const LinearFrame* middle, int samples,
                                               double time, bool right) {
  std::vector<float> sum;
  const int count = int(std::max<std::size_t>(1, pixel_parts.size()));
  const auto is_middle = [&](int i) { return middle && count == 1 && i == samples / 2; };
  const auto begin = [&](int i) -> std::optional<RenderedView> {
    if (i == samples * count || is_middle(i)) return std::nullopt;
    const double seconds_off = time * ((i / count + 0.5) / samples - 0.5);
    const ViewRays view = view_beside(view_at(index, seconds_off), i % count);
    RenderedView begun = renderer.view(right ? right_of(view) : view);
    begun.begin(RenderedView::Begun::radiance);
    return begun;
  };
  const float share = 1.0f / float(samples * count);
  std::optional<RenderedView> next = begin(0);
  for (int i = 0; i < samples * count; ++i) {
    std::optional<RenderedView> now = std::exchange(next, begin(i + 1));
    LinearFrame drawn;
    if (now) drawn = std::move(*now).into_linear_frame();
    const LinearFrame& image = now ? drawn : *middle;
    const bool sharp = !optics || !optics->defocuses();
    if (now && sharp && share == 1) {
      sum = std::move(drawn.rgb);
      continue;
    }
    if (sum.empty()) sum.assign(image.rgb.size(), 0);
    if (sharp)
      add_scaled(sum, image.rgb, share, spec.threads);
    else
      add_scaled(sum, defocus(image), share, spec.threads);
  }
  if (!renderer.medium().falling().empty()) add_drops(index, middle, time, right, sum);
  return optics ? optics->spread(std::move(sum), right ? 1 : 0) : sum;
}

// Once over the whole exposure: streaks are mean light already.
void Camera::State::add_drops(int index, const LinearFrame* middle, double time, bool right, std::vector<float>& light) {
  const auto view_then = [&](double seconds_off) {
    const ViewRays view = view_at(index, seconds_off);
    return right ? right_of(view) : view;
  };
  const ViewRays view = view_then(0);
  std::vector<float> distances;
  if (right || !middle) distances = renderer.view(view).distances();
  const OpticsSpec& o = spec.optics;
  renderer.add_drops({view, view_then(-0.5 * time).world_from_camera, view_then(0.5 * time).world_from_camera, time,
                      distances.empty() ? middle->distance : distances, o.focus_distance,
                      o.focal_length / spec.exposure.f_number},
                     light);
}

// The settings of this frame, from what the one before measured.
ExposureSettings Camera::State::expose(int index, RenderedView& view) {
  if (index > 0) {
    const std::int64_t elapsed = view.rays().stamp_ns - flight.stamps_ns[std::size_t(index) - 1];
    exposure.follow(last_mean, double(elapsed) * 1e-9);
  }
  if (!settled) {
    const double share = saturation_share(exposure.settings(), spec.exposure.f_number);
    exposure.settle([&](double factor) { return sensor->mean_of(view.radiance(), share * factor); });
    settled = true;
  }
  return exposure.settings();
}

Frame Camera::State::take_exposed(int index) {
  RenderedView view = open_begun_view(index);
  view.begin(RenderedView::Begun::radiance);
  begin_next(index, RenderedView::Begun::radiance);
  const ExposureSettings settings = expose(index, view);
  const int samples = count_samples(index, view, settings);
  Frame frame;
  frame.index = index;
  frame.stamp_ns = view.rays().stamp_ns;
  frame.intrinsics = spec.intrinsics;
  frame.world_from_camera = view.rays().world_from_camera;
  frame.row_poses = view.rays().row_poses;
  frame.exposure_s = settings.time;
  view.make_truth(spec.channels);
  for (const ImageStream* stream : spec.channels) frame.truth[stream->name] = view.truth(*stream);
  frame.measured_depth = measure_depth(index, view);
  LinearFrame middle = std::move(view).into_linear_frame();
  const auto counts =
      sensor->count(gather_light(index, &middle, samples, settings.time, false), settings, index, 0);
  frame.depth = std::move(middle.depth);
  frame.rgb = sensor->develop(counts);
  if (spec.baseline > 0)
    frame.rgb_right = sensor->develop(sensor->count(
        gather_light(index, nullptr, samples, settings.time, true), settings, index, 1));
  last_mean = sensor->mean_of(counts);
  return frame;
}

// Images from the frame before to this one, so close that nothing moves farther than most_motion
// between two of them.
void Camera::State::watch(int index, Frame& frame) {
  const std::int64_t end = flight.stamps_ns[std::size_t(index)];
  std::int64_t now = index > 0 ? flight.stamps_ns[std::size_t(index) - 1] : end;
  const auto look = [&](std::int64_t stamp) {
    ViewRays view;
    view.stamp_ns = stamp;
    view.intrinsics = spec.intrinsics;
    view.directions = directions;
    view.world_from_camera = pose_at(stamp, end, flight.world_from_camera[std::size_t(index)]);
    view.world_from_rig = rig_of(view.world_from_camera);
    const std::size_t next = std::size_t(index) + (stamp == end ? 1 : 0);
    const std::size_t goal = std::min(next, flight.stamps_ns.size() - 1);
    RenderedView seen = renderer.view(view);
    std::vector<MomentNearby> way{{view.world_from_camera, {}}, {flight.world_from_camera[goal], seen.shifts(flight.stamps_ns[goal])}};
    if (flight.stamps_ns[goal] > stamp)
      way = way_between(stamp, flight.stamps_ns[goal], flight.stamps_ns[goal], flight.world_from_camera[goal], seen);
    way.front() = {view.world_from_camera, {}};
    if (light_watch)
      events->see_changes(stamp, seen.light_changes(*light_watch), frame.events);
    else
      events->see(stamp, luminance_of(seen.radiance()), frame.events);
    return Watched{view, seen.distances(), std::move(way)};
  };
  if (index == 0) {
    watched = look(end);
    return;
  }
  // From the depths of the last look: how many parts the rest of the way is to be cut into.
  for (int left = kMostEventImages; now < end; --left) {
    watched.way.back().world_from_camera = flight.world_from_camera[std::size_t(index)];
    const double motion = longest_way(watched.view, watched.distances, watched.way);
    const double parts = std::clamp(std::ceil(motion / spec.event_camera.most_motion), 1.0, double(std::max(left, 1)));
    now = std::min(end, now + std::int64_t(std::ceil(double(end - now) / parts)));
    watched = look(now);
  }
}

Camera::Camera(Renderer& renderer, const CameraSpec& spec, Flight flight)
    : state_(std::make_unique<State>(renderer, spec, std::move(flight))) {}

Camera::~Camera() = default;

int Camera::frames() const { return int(state_->flight.stamps_ns.size()); }

void Camera::fly_on(std::int64_t stamp_ns, const Pose& world_from_camera) {
  state_->flight.stamps_ns.push_back(stamp_ns);
  state_->flight.world_from_camera.push_back(world_from_camera);
}

Frame Camera::take(int index) {
  State& s = *state_;
  Frame frame = s.sensor ? s.take_exposed(index) : s.take_ideal(index);
  frame.baseline = s.spec.baseline;
  frame.world_from_rig = s.rig_of(frame.world_from_camera).value_or(frame.world_from_camera);
  if (s.events) s.watch(index, frame);
  return frame;
}

}  // namespace rubble
