// What an inspector shows: the picture, what is drawn over it, and the lines beside it.
#include <algorithm>
#include <array>

#include "app/drive/inspect/inspector.h"
#include "app/pipeline/stages.h"
#include "app/planning/flight.h"
#include "app/sensors/build_camera.h"

namespace rubble {
namespace {

constexpr double kFrustumLength = 0.5;  // unit: m
constexpr std::size_t kShownPoses = 4;  // of the rig on its flight
constexpr double kHullReach = 40;       // unit: m
constexpr double kPathStep = 0.03;      // of its line; unit: m
constexpr std::array<std::uint8_t, 3> kSpringColour{120, 255, 90};

}  // namespace

// On robots where they are, on the flight at its frames.
void Inspector::add_cameras(std::vector<OverlayLine>& lines) {
  const Scenario& scenario = mission_->scenario;
  const bool rides = scenario.trajectory.ride.on();
  if (!rides && flight_.empty() && !(pile_->settling() && scenario.trajectory.needs_pile())) {
    const PileState now = robots_ ? rested_ : pile_->state();
    PileSurvey survey(mission_->assets, now, run_->threads());
    try {
      flight_ = with_lines_of_script(*mission_, [&] { return resolve_flight(scenario, survey).poses; });
    } catch (const InputError& error) {
      choice_.cameras = false;
      return screen_.say(error.what());
    }
  }
  std::vector<Vec3> path;
  for (const CameraPose& pose : flight_) path.push_back(pose.world_from_camera.translation);
  add_path(path, kPathStep, lines);
  // With robots at their time, else some from the first to the last.
  const std::size_t last = flight_.empty() ? 0 : flight_.size() - 1, shown = robots_ ? 1 : std::min(kShownPoses, last + 1);
  for (std::size_t i = 0; i < shown; ++i) {
    std::size_t frame = shown > 1 ? i * last / (shown - 1) : 0;
    if (robots_) frame = std::min(last, std::size_t(double(robots_->steps()) * step_time() * scenario.trajectory.rate_hz));
    const auto carrier_of = [&](const MountedCamera& camera) -> std::optional<Pose> {
      if (camera.ride.on() || rides) return robots_ ? robots_->world_from(camera.ride) : std::nullopt;
      if (flight_.empty()) return std::nullopt;
      return flight_[frame].world_from_camera;
    };
    for (const PlacedCamera& camera : place_cameras(scenario.cameras, carrier_of)) add_frustum(camera, kFrustumLength, lines);
  }
}

std::vector<PictureLine> Inspector::draw_overlay() {
  std::vector<OverlayLine> lines;
  if (choice_.hulls && robots_) overlay_->add_hulls(rested_, &world(), camera_->pose().position, lines, kHullReach);
  if (choice_.hulls && !robots_) overlay_->add_hulls(pile_->state(), nullptr, camera_->pose().position, lines, kHullReach);
  if (choice_.contacts) Overlay::add_all_contacts(world(), step_time(), camera_->pose().position, lines);
  if (choice_.frames) Overlay::add_frames(world(), lines);
  if (choice_.scans && scan_) Overlay::add_scan(*scan_, lines);
  if (choice_.cameras) add_cameras(lines);
  if (choice_.voids) {
    try {
      if (voids_->take_news()) screen_.say("the voids are mapped");
      if (const VoidMap* map = voids_->map()) add_voids(*map, lines);
    } catch (const std::exception& error) {
      choice_.voids = false;
      screen_.say(error.what());
    }
  }
  if (spring_.holds()) lines.push_back({spring_.point(world()), spring_.target(), kSpringColour, true});
  if (lines.empty()) return {};
  return project_overlay(lines, frame_);
}

std::vector<PictureLabel> Inspector::legend() const {
  std::vector<PictureLabel> rows;
  if (choice_.hulls) rows.push_back({"hulls", Overlay::kHullColour});
  if (choice_.contacts) rows.push_back({"contact forces, 0.1 mm/N", Overlay::kContactColour});
  if (choice_.cameras)
    for (const PlacedCamera& camera : place_cameras(mission_->scenario.cameras, [](const MountedCamera&) { return Pose(); }))
      rows.push_back({"view of " + camera.name, camera.colour});
  if (choice_.voids) rows.push_back(voids_->label());
  if (spring_.holds()) {
    const double newtons = norm(spring_.calc_impulse(world(), step_time())) / step_time();
    rows.push_back({words("pull on piece %d: %.0f N", spring_.piece(), newtons), kSpringColour});
  }
  return rows;
}

std::vector<std::string> Inspector::status() const {
  const Vec3& p = camera_->pose().position;
  const std::string state =
      robots_ ? words("t %.2f s   robots, %d of %d awake", world().time(), world().awake_count(), world().size()) : pile_->describe();
  return {words("seed %llu   %s   %s%s", static_cast<unsigned long long>(mission_->scenario.seed), state.c_str(),
                pace_.describe(),
                touched_ > 0 ? "   TOUCHED" : ""),
          words("x %.2f  y %.2f  z %.2f m   %.2f m/s   %.0f pictures/s   H: help", p.x, p.y, p.z, camera_->speed(), rate_)};
}

void Inspector::show() {
  picture_.frame = &frame_;
  picture_.lines = draw_overlay();
  picture_.legend = legend();
  picture_.status = status();
  screen_.show(picture_, help_ ? &all_inspector_help() : nullptr);
}

}  // namespace rubble
