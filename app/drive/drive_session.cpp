#include "app/drive/drive_session.h"
#include "app/drive/drive_window.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <thread>
#include <utility>

#include "app/pipeline/live.h"
#include "app/support/print.h"
#include "app/support/stop.h"
#include "kernel/base/system/thread_count.h"

namespace rubble {
namespace {

constexpr int kLongestLeg = 9000;    // steps: five minutes; then a new leg goes on from there
constexpr double kLeastLamp = 1, kMostLamp = 100000;  // unit: cd
constexpr double kLeastFog = 0.005, kMostFog = 10;    // unit: 1/m

std::string choose_folder(const DriveRequest& request) {
  if (!request.of.out.empty()) return request.of.out;
  return "out/" + std::filesystem::path(request.of.mission).stem().string() + "_drive";
}

double changed(double value, bool up, double least, double most) {
  return std::clamp(value * (up ? 1.25 : 0.8), least, most);
}

std::array<int, 2> window_size(const DriveRequest& request) {
  return drive_picture_size(request.width, request.height);
}

}  // namespace

DriveSession::DriveSession(const DriveRequest& request)
    : request_(request),
      folder_(choose_folder(request)),
      screen_("drive", window_size(request)[0], window_size(request)[1]) {
  prepare_drive_folder(folder_, request_.of.force);
  link_ = DriveLink::connect(request_.of.options);
  enter(std::nullopt);
  print_err("drive: ready, H for help\n");
}

DriveSession::~DriveSession() = default;

bool DriveSession::stay() {
  screen_.poll(controls_);
  for (const DriveAction action : controls_.take().actions)
    if (action == DriveAction::quit) quit_ = true;
  return !quit_ && !stop_requested();
}

void DriveSession::enter(std::optional<std::uint64_t> seed) {
  screen_.set_title("the pile settles");
  camera_.reset();
  voids_.reset();
  choice_.voids = false;
  world_.reset();
  world_ = make_drive_world(request_, seed, [this] { return stay(); });
  if (!world_->pile.settled) screen_.say("some pieces still moved when the time limit came");
  camera_ = std::make_unique<DrivenCamera>(world_->entry, world_->plan,
                                           world_->scenario.trajectory.radius,
                                           world_->queries(), world_->limits);
  map_frame_ = frame_map(world_->pile, world_->entry.position, request_.height);
  map_ = draw_height_map(world_->queries(), map_frame_, world_->threads);
  overlay_ = std::make_unique<Overlay>(world_->assets.types);
  voids_ = std::make_unique<VoidSurvey>(world_->scenario.voids, world_->assets);
  scan_ = {};
  if (link_) link_->enter(*world_);
  picture_.track.clear();
  screen_.set_title(request_.of.mission + ", seed " + std::to_string(world_->scenario.seed));
}

void DriveSession::run() {
  const auto step_time = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(1 / world_->step_hz()));
  Clock::time_point due = Clock::now(), counted = due;
  while (!quit_ && !stop_requested() && (request_.steps == 0 || steps_ < request_.steps)) {
    screen_.poll(controls_);
    DriveInput input = controls_.take();
    if (link_) link_->add_to(input, 1 / world_->step_hz());
    for (const DriveAction action : input.actions) act(action);
    if (quit_) break;
    if (std::exchange(pace_.one_step, false) || (!pace_.paused && !waits(input))) {
      follow(input.trajectories);
      step(input);
    }
    show();
    // No faster than simulation time; slower where the machine cannot keep up.
    due = std::max(due + step_time * pace_.slowness, Clock::now() - step_time);
    std::this_thread::sleep_until(due);
    const Clock::time_point now = Clock::now();
    const double took = std::chrono::duration<double>(now - counted).count();
    rate_ += 0.1 * (1 / std::max(took, 1e-3) - rate_);
    counted = now;
  }
  end_leg();
  if (link_) link_->finish();
}

// Time begins with the first key: nobody wants what is before it. Programs that listen, and a number of steps, begin it at once.
bool DriveSession::waits(const DriveInput& input) {
  going_ = going_ || input.moves() || link_ || request_.steps > 0;
  return leg_ && !going_;
}

void DriveSession::follow(const std::vector<JointTrajectoryCommand>& trajectories) {
  for (const JointTrajectoryCommand& trajectory : trajectories) {
    try {
      if (!world_->robots)
        throw InputError({"", 0, "joint_names", "the camera has no joints", "a mission with robots",
                          std::to_string(trajectory.joints.size()) + " joints", ""});
      world_->robots->follow(trajectory);
    } catch (const InputError& error) {
      complaints_.note("/joint_trajectory", error.what());
    }
  }
}

// The world goes on to the time of the next frame; the first is of its start.
void DriveSession::step_robot(const DriveInput& input) {
  if (!leg_) {
    leg_ = std::make_unique<DriveLeg>(*world_, folder_, ++legs_, false, listener());
  } else {
    if (input.linear.y != 0) complaints_.note("/cmd_vel", "linear.y is left out: no robot moves sideways by it");
    TeleopCommand asked = input;
    asked.speed = camera_->speed();
    world_->robots->advance(asked, leg_->next_time());
  }
  camera_->put(make_driven_pose(world_->robots->world_from_rig()));
}

void DriveSession::step(const DriveInput& input) {
  if (world_->robots) {
    step_robot(input);
    leg_->step(camera_->pose());
    if (link_ && !leg_->at_frame()) link_->publish(take_sensed());
    const Vec3& p = camera_->pose().position;
    picture_.track.push_back({map_frame_.column(p), map_frame_.row(p)});
    ++steps_;
    return;
  }
  if (leg_ && leg_->steps() >= kLongestLeg) {
    end_leg();
    change_lamp_and_air();
  }
  if (!leg_)
    leg_ = std::make_unique<DriveLeg>(*world_, folder_, ++legs_, request_.record, listener());
  else
    camera_->step(input, 1 / world_->step_hz());
  leg_->step(camera_->pose());
  const Vec3& p = camera_->pose().position;
  picture_.track.push_back({map_frame_.column(p), map_frame_.row(p)});
  ++steps_;
}

FrameListener DriveSession::listener() {
  if (!link_) return {};
  return [this](const Frame& frame) { link_->publish(frame, take_sensed()); };
}

std::vector<Sample> DriveSession::take_sensed() {
  std::vector<Sample> sensed = world_->robots ? world_->robots->take_sensed() : std::vector<Sample>();
  for (const Sample& sample : sensed)
    if (const auto* reading = std::get_if<Reading>(&sample); reading && reading->scan) scan_ = reading->scan;
  return sensed;
}

void DriveSession::end_leg() {
  if (!leg_) return;
  leg_->finish();
  print_out("%s/%s.lua\n", folder_.c_str(), leg_->name().c_str());
  std::fflush(stdout);
  leg_.reset();
  going_ = false;
}

// A leg has one lamp and one air: what was driven so far is complete, and a new leg begins here.
void DriveSession::change_lamp_and_air() {
  end_leg();
  if (world_->robots) {
    world_->robots->set_air(world_->scenario.air);
    world_->robots->restart();  // a mission begins at its start
  }
  world_->renderer->restart(world_->scenario.lamp, world_->scenario.air);
}

void DriveSession::act(DriveAction action) {
  LampSpec& lamp = world_->scenario.lamp;
  double& fog = world_->scenario.air.fog_density;
  switch (action) {
    case DriveAction::lamp:
      lamp.on = !lamp.on;
      return change_lamp_and_air();
    case DriveAction::lamp_up:
    case DriveAction::lamp_down:
      lamp.intensity_cd =
          changed(lamp.intensity_cd, action == DriveAction::lamp_up, kLeastLamp, kMostLamp);
      return change_lamp_and_air();
    case DriveAction::fog:
      if (fog > 0) fog_ = fog;
      fog = fog > 0 ? 0 : fog_;
      return change_lamp_and_air();
    case DriveAction::fog_up:
    case DriveAction::fog_down:
      fog_ = changed(fog > 0 ? fog : fog_, action == DriveAction::fog_up, kLeastFog, kMostFog);
      if (fog <= 0) return;
      fog = fog_;
      return change_lamp_and_air();
    case DriveAction::faster:
    case DriveAction::slower:
      return camera_->change_speed(action == DriveAction::faster ? 1 : -1);
    case DriveAction::reset:
      camera_->put(world_->entry);
      picture_.track.clear();
      return change_lamp_and_air();
    case DriveAction::next_seed:
      end_leg();
      return enter(world_->scenario.seed + 1);
    case DriveAction::pause:
      if (leg_ && !going_ && !pace_.paused) return void(going_ = true);
      [[fallthrough]];
    case DriveAction::one_step:
    case DriveAction::slow:
      return void(pace_.act(action));
    case DriveAction::hulls:
      choice_.hulls = !choice_.hulls;
      return;
    case DriveAction::contacts:
    case DriveAction::frames:
      if (!world_->robots) return screen_.say("only robots have contacts and links in a drive");
      (action == DriveAction::contacts ? choice_.contacts : choice_.frames) ^= true;
      return;
    case DriveAction::scans:
      if (!world_->robots || !link_) return screen_.say("echoes are those of scans that are published: a robot with a sensor that scans, and --ros1 or --ros2");
      choice_.scans = !choice_.scans;
      return;
    case DriveAction::cameras:
      return screen_.say("views of cameras are shown by `rubble inspect`");
    case DriveAction::moment:
      return screen_.say("a drive is saved as a mission; `rubble inspect` saves moments");
    case DriveAction::voids:
      choice_.voids = !choice_.voids;
      return map_voids();
    case DriveAction::help:
      help_ = !help_;
      return;
    case DriveAction::picture:
      return screen_.save_picture(folder_);
    case DriveAction::quit:
      quit_ = true;
      return;
  }
}

// As they are now: robots push pieces.
void DriveSession::map_voids() {
  if (!choice_.voids) return voids_->forget();
  PileState now = world_->pile;
  if (world_->robots)
    for (std::size_t i = 0; i < now.pieces.size(); ++i) now.pieces[i] = world_->robots->world().piece(int(i));
  voids_->start(now, world_->robots ? world_->robots->world().steps() : 0, world_->threads);
}

std::vector<PictureLine> DriveSession::draw_overlay() {
  if (!choice_.any()) return {};
  std::vector<OverlayLine> lines;
  const World* const world = world_->robots ? &world_->robots->world() : nullptr;
  if (choice_.hulls) overlay_->add_hulls(world_->pile, world, camera_->pose().position, lines);
  if (choice_.contacts && world) Overlay::add_contacts(*world, lines);
  if (choice_.frames && world) Overlay::add_frames(*world, lines);
  if (choice_.scans && scan_) Overlay::add_scan(*scan_, lines);
  if (choice_.voids) {
    try {
      if (voids_->take_news()) screen_.say("the voids are mapped");
      if (const VoidMap* map = voids_->map()) add_voids(*map, lines);
    } catch (const std::exception& error) {
      choice_.voids = false;
      screen_.say(error.what());
    }
  }
  return project_overlay(lines, leg_->shown());
}

void DriveSession::show() {
  if (!leg_) return;  // paused before a first step: what was shown stays
  picture_.frame = &leg_->shown();
  picture_.lines = draw_overlay();
  picture_.map = &map_;
  const Vec3 ahead = camera_->pose().world_from_camera().rotation.rotate({1, 0, 0});
  const double level = std::sqrt(ahead.x * ahead.x + ahead.y * ahead.y);
  picture_.heading = {ahead.x / std::max(level, 1e-3), -ahead.y / std::max(level, 1e-3)};
  picture_.status = status();
  picture_.legend.clear();
  if (choice_.voids) picture_.legend.push_back(voids_->label());
  screen_.show(picture_, help_ ? &all_key_help() : nullptr);
}

std::vector<std::string> DriveSession::status() const {
  const Scenario& s = world_->scenario;
  const DrivenPose& pose = camera_->pose();
  const char* pace = pace_.paused || going_ ? pace_.describe() : "A KEY STARTS TIME";
  return {words("seed %llu   leg %d   frame %d   %.2f m/s   lamp %s   fog %s%s   %s",
                static_cast<unsigned long long>(s.seed), legs_, leg_->frames(), camera_->speed(),
                s.lamp.on ? words("%.0f cd", s.lamp.intensity_cd).c_str() : "off",
                s.air.fog_density > 0 ? words("%.3f 1/m", s.air.fog_density).c_str() : "off",
                camera_->held_back() ? "   TOUCHES" : "",
                pace),
          words("x %.2f  y %.2f  z %.2f m   roll %.0f  pitch %.0f  yaw %.0f deg   %.0f steps/s   %s"
                "   H: help",
                pose.position.x, pose.position.y, pose.position.z, pose.rpy_deg.x, pose.rpy_deg.y,
                pose.rpy_deg.z, rate_, controls_.gamepads() > 0 ? "gamepad" : "no gamepad")};
}

ExitCode drive_mission(const DriveRequest& request) {
  stop_on_signals();
  check_live(request.of.options);
  DriveSession session(request);
  session.run();
  return ExitCode::done;
}

}  // namespace rubble
