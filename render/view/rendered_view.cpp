#include "render/view/rendered_view.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/error.h"
#include "render/view/stopwatch.h"
#include "render/view/view_source.h"

namespace rubble {

namespace {

void check_view(const ViewRays& view) {
  const Intrinsics& k = view.intrinsics;
  const bool whole = k.width > 0 && k.height > 0 && k.width <= 16384 && k.height <= 16384;
  const bool finite = std::isfinite(k.fx) && std::isfinite(k.fy) && std::isfinite(k.cx) &&
                      std::isfinite(k.cy) && k.fx > 0 && k.fy > 0;
  if (!whole || !finite)
    throw RunError(
        "cannot draw with these intrinsics: width and height must be 1 to 16384, fx and "
        "fy positive, cx and cy finite");
  if (!view.directions && !Lens(k).is_pinhole())
    throw RunError("without a table of directions the lens must be a pinhole: distortion zero");
}

}  // namespace

struct RenderedView::State {
  ViewSource& source;
  ViewRays rays;
  std::optional<ViewRays> next;
  RenderTimes times;
  std::unique_ptr<DrawnSurfaces> surfaces;  // none: not drawn yet
  std::optional<StartedColours> started;  // colour, by begin()
  std::optional<StartedRadiance> started_radiance;
  std::optional<ColourImage> colour;
  std::optional<std::vector<float>> radiance;
  TruthImages truth;

  ~State() {
    if (!surfaces) return;
    try {
      source.scene.device.make_current();  // for what it has on the device
    } catch (const RunError&) {
      // The driver frees it with the context.
    }
  }

  DrawnSurfaces& drawn();
  ColourImage draw_colour(std::optional<float> exposure);
  void note(const ColourImage& image);  // its times
  // With the scene at the view's moment.
  DrawnView view_of_truth(const ViewRays* following);
};

DrawnSurfaces& RenderedView::State::drawn() {
  source.scene.device.make_current();
  if (!surfaces) {
    const Stopwatch start;
    surfaces = std::make_unique<DrawnSurfaces>(source.surfaces, rays);
    times.visibility = start.time();
  }
  return *surfaces;
}

ColourImage RenderedView::State::draw_colour(std::optional<float> exposure) {
  ColourImage image = ColourDrawer::collect(source.colours.start(rays, drawn(), exposure));
  note(image);
  return image;
}

void RenderedView::State::note(const ColourImage& image) {
  times.resolve = image.resolve, times.read = image.read, times.finish = image.finish;
}

DrawnView RenderedView::State::view_of_truth(const ViewRays* following) {
  DrawnSurfaces& now = drawn();
  source.scene.move_to(rays.stamp_ns);
  return {rays, now.ids(), now.distances(), following};
}

RenderedView::RenderedView(ViewSource& source, const ViewRays& rays, const ViewRays* next) {
  check_view(rays);
  state_.reset(new State{source, rays, {}, {}, nullptr, {}, {}, {}, {}, {}});
  if (next) state_->next = *next;
}

RenderedView::~RenderedView() = default;
RenderedView::RenderedView(RenderedView&&) noexcept = default;
RenderedView& RenderedView::operator=(RenderedView&&) noexcept = default;

const ViewRays& RenderedView::rays() const { return state_->rays; }

void RenderedView::begin(Begun what) {
  State& s = *state_;
  const LitScene& scene = s.source.scene;
  if (!scene.device.runs_ahead() || scene.is_traced()) return;
  if (what == Begun::radiance) {
    if (!s.radiance && !s.started_radiance) s.started_radiance = s.source.colours.start_radiance(s.rays, s.drawn());
  } else if (!s.colour && !s.started) {
    s.started = s.source.colours.start(s.rays, s.drawn(), std::nullopt);
  }
}

const std::vector<float>& RenderedView::depth() { return state_->drawn().planar_depth(); }

const std::vector<float>& RenderedView::distances() { return state_->drawn().distances(); }

std::vector<std::uint32_t> RenderedView::instances() {
  const std::vector<std::uint32_t>& ids = state_->drawn().ids();
  std::vector<std::uint32_t> out(ids.size() / 2);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = ids[i * 2] ? state_->source.scene.scene.placed[ids[i * 2] - 1].id : kNoInstance;
  return out;
}

const std::vector<std::uint8_t>& RenderedView::rgb() {
  State& s = *state_;
  if (!s.colour && s.started) {
    s.source.scene.device.make_current();
    s.colour = ColourDrawer::collect(std::move(*s.started));
    s.started.reset();
    s.note(*s.colour);
  }
  if (!s.colour) s.colour = s.draw_colour(std::nullopt);
  return s.colour->rgb;
}

float RenderedView::exposure() {
  rgb();
  return state_->colour->exposure;
}

std::vector<std::uint8_t> RenderedView::rgb_at(float exposure) {
  return state_->draw_colour(exposure).rgb;
}

const std::vector<float>& RenderedView::radiance() {
  State& s = *state_;
  if (s.radiance) return *s.radiance;
  if (!s.started_radiance) s.started_radiance = s.source.colours.start_radiance(s.rays, s.drawn());
  s.source.scene.device.make_current();
  s.radiance = ColourDrawer::collect(std::move(*s.started_radiance));
  s.started_radiance.reset();
  return *s.radiance;
}

std::vector<LightChange> RenderedView::light_changes(LightWatch& watch) {
  return state_->source.colours.draw_changes(state_->rays, state_->drawn(), watch);
}

const ImageValues& RenderedView::truth(const ImageStream& stream) {
  make_truth({&stream});
  return state_->truth.find(stream.name)->second;
}

void RenderedView::make_truth(const StreamSet& streams) {
  State& s = *state_;
  StreamSet missing;
  for (const ImageStream* stream : streams)
    if (s.truth.find(stream->name) == s.truth.end()) missing.push_back(stream);
  if (missing.empty()) return;
  DrawnView view = s.view_of_truth(s.next ? &*s.next : nullptr);
  const bool follows = std::any_of(missing.begin(), missing.end(),
                                   [](const ImageStream* stream) { return stream->needs_next; });
  if (s.next && follows) view.shift = s.source.scene.moving.shift_to(s.next->stamp_ns);
  s.source.truth.fill(missing, view, s.truth);
}

std::vector<std::uint8_t> RenderedView::line_of_sight_mask(const Vec3& place_in_camera) {
  return state_->source.truth.line_of_sight_mask(state_->view_of_truth(nullptr), place_in_camera);
}

std::vector<float> RenderedView::albedos() {
  return state_->source.truth.albedos(state_->view_of_truth(nullptr));
}

std::vector<Vec3f> RenderedView::shifts(std::int64_t stamp_ns) {
  State& s = *state_;
  if (!s.source.scene.moving.any()) return {};
  DrawnView view = s.view_of_truth(nullptr);
  view.shift = s.source.scene.moving.shift_to(stamp_ns);
  return s.source.truth.shifts(view);
}

Air RenderedView::air() const { return state_->source.scene.air_at(state_->rays.stamp_ns); }

const RenderTimes& RenderedView::times() const {
  if (state_->surfaces) state_->times.triangles = state_->surfaces->triangles();
  return state_->times;
}

Frame RenderedView::into_frame(int index, const StreamSet& streams) && {
  rgb(), depth();
  make_truth(streams);
  State& s = *state_;
  Frame frame;
  frame.index = index;
  frame.stamp_ns = s.rays.stamp_ns;
  frame.intrinsics = s.rays.intrinsics;
  frame.world_from_camera = s.rays.world_from_camera;
  frame.row_poses = s.rays.row_poses;
  frame.rgb = std::move(s.colour->rgb);
  frame.depth = s.surfaces->take_planar_depth();
  for (const ImageStream* stream : streams)
    frame.truth[stream->name] = std::move(s.truth[stream->name]);
  state_.reset();
  return frame;
}

LinearFrame RenderedView::into_linear_frame() && {
  radiance(), depth(), distances();
  State& s = *state_;
  LinearFrame frame;
  frame.width = s.rays.intrinsics.width, frame.height = s.rays.intrinsics.height;
  frame.rgb = std::move(*s.radiance);
  frame.depth = s.surfaces->take_planar_depth();
  frame.distance = s.surfaces->take_distances();
  frame.instance = instances();
  state_.reset();
  return frame;
}

}  // namespace rubble
