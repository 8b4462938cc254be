#include "app/drive/inspect/inspector.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <thread>
#include <utility>

#include "app/control/robot_control.h"
#include "app/drive/drive_window.h"
#include "app/drive/inspect/snapshot.h"
#include "app/pipeline/stages.h"
#include "app/scene/moving_scene.h"
#include "app/sensors/build_camera.h"
#include "app/support/drawing_device.h"
#include "app/support/print.h"
#include "app/support/stop.h"
#include "app/surroundings/pile_surroundings.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/system/disk_cache.h"
#include "kernel/base/system/file_sandbox.h"
#include "kernel/base/system/output_files.h"
#include "kernel/base/system/thread_count.h"
#include "render/camera/lens.h"

namespace rubble {
namespace {

constexpr double kPictureRate = 30;        // unit: 1/s
constexpr double kFieldOfView = 70;        // horizontal; unit: degree

std::string choose_inspection_folder(const DriveRequest& request) {
  if (!request.of.out.empty()) return request.of.out;
  return "out/" + std::filesystem::path(request.of.mission).stem().string() + "_inspect";
}

// Files of an earlier inspection, which --force removes.
bool is_of_an_inspection(const std::filesystem::path& path) {
  const std::string name = path.stem().string(), end = path.extension().string();
  for (const auto& [start, ends] : {std::pair<std::string, std::string>{"moment_", ".lua .state"}, {"picture_", ".png"}})
    if (name.rfind(start, 0) == 0 && name.find_first_not_of("0123456789", start.size()) == std::string::npos && !end.empty() &&
        ends.find(end) != std::string::npos)
      return true;
  return false;
}

void prepare_inspection_folder(const std::string& folder, bool force) {
  allow_output(folder);
  make_output_folder(folder);
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (!is_of_an_inspection(entry.path())) continue;
    if (!force)
      throw InputError({folder, 0, "--out", "an earlier inspection is in it", "", entry.path().filename().string(),
                        "choose another folder, or --force to replace it"});
    remove_output_file(entry.path().string());
  }
}

// What is drawn: a plain camera, and quickly, since all that can move is lit anew for every picture.
Scenario choose_drawn(const Scenario& of, int width, int height) {
  Scenario drawn = of;
  drawn.cameras = {MountedCamera{}};
  CameraScenario& camera = drawn.cameras.front().camera;
  camera.width = width, camera.height = height, camera.fov_deg = kFieldOfView;
  camera.channels = {"instance"};
  camera.colour.quality = RenderQuality::draft;
  drawn.lamp.on = false;
  return drawn;
}

// From a corner, so that all of it is in view but for terrain.
DrivenPose look_over(const PileState& pile, const std::vector<PieceType>& types) {
  Aabb box;
  box.include({-0.5, -0.5, 0}), box.include({0.5, 0.5, 0.5});
  for (const PieceState& piece : pile.pieces)
    if (!types[std::size_t(piece.type)].surface && piece.status != PieceStatus::lost) box.include(piece.world_from_body.translation);
  const Vec3 extent = box.max - box.min, middle = (box.max + box.min) * 0.5;
  const double reach = std::max({extent.x, extent.y, extent.z}), away = 0.8 * reach + 1.2;
  const Vec3 target{middle.x, middle.y, 0.25 * box.max.z};
  const Vec3 from{target.x - 0.8 * away, target.y - 0.6 * away, target.z + 0.45 * away};
  const Vec3 d = target - from;
  constexpr double kDegrees = 180 / portable::kPi;
  return {from, {0, portable::atan2(-d.z, std::sqrt(d.x * d.x + d.y * d.y)) * kDegrees, portable::atan2(d.y, d.x) * kDegrees}};
}

// Whether the flight is another one on another pile.
const PileQueries& nothing() {
  static const PileQueries queries(PileState(), {});
  return queries;
}

}  // namespace

const std::vector<KeyHelp>& all_inspector_help() {
  static const std::vector<KeyHelp> help{
      {"forward, back", "W, S", "left stick, up and down"},
      {"turn", "arrows, A, D, right mouse", "right stick"},
      {"roll", "Q, E", "left stick, left and right"},
      {"slower, faster", "Z, X or the wheel", "shoulder buttons"},
      {"pull a piece", "left mouse button", ""},
      {"pause", "space", "start"},
      {"one step; slow motion", "period; comma", ""},
      {"from the start; next seed", "R; N", "Y; press the right stick"},
      {"save this moment", "K", ""},
      {"hulls, contacts", "V, C", ""},
      {"views of cameras", "O", ""},
      {"map of voids", "M", ""},
      {"links, echoes of scans", "G, B", ""},
      {"lamp", "L", "A"},
      {"save a picture", "P", "press the left stick"},
      {"this help", "H or F1", "X"},
      {"quit", "escape", "back"},
  };
  return help;
}

Inspector::Inspector(const DriveRequest& request)
    : request_(request),
      folder_(choose_inspection_folder(request)),
      controls_(LeftButton::pulls),
      screen_("inspect", inspect_picture_size(request.width, request.height)[0],
              inspect_picture_size(request.width, request.height)[1]) {
  prepare_inspection_folder(folder_, request_.of.force);
}

Inspector::~Inspector() = default;

bool Inspector::leaving() const {
  return quit_ || next_ || stop_requested() || (request_.steps > 0 && turns_ >= request_.steps);
}

double Inspector::step_time() const { return robots_ ? robots_->step_time() : mission_->scenario.settle.step; }

void Inspector::enter(std::optional<std::uint64_t> seed) {
  screen_.set_title("loading");
  eye_ = nullptr, renderer_ = nullptr, robots_ = nullptr, voids_ = nullptr, pile_ = nullptr;
  RunRequest of = request_.of;
  if (seed) of.seed = seed;
  run_ = std::make_unique<RunContext>(of.options);
  mission_ = std::make_unique<ResolvedMission>(resolve_mission(of, RunKind::run, *run_));
  check_robot_models(mission_->scenario, mission_->assets, mission_->provenance.script);
  pile_ = std::make_unique<InspectedPile>(*mission_, run_->threads());
  overlay_ = std::make_unique<Overlay>(mission_->assets.types);
  voids_ = std::make_unique<VoidSurvey>(mission_->scenario.voids, mission_->assets);
  spring_.release();
  flight_.clear(), scan_.reset(), touched_ = 0;
  screen_.set_title(of.mission + ", seed " + std::to_string(mission_->scenario.seed));
}

void Inspector::draw_scene(const Scene& scene) {
  eye_ = nullptr;
  RenderOptions options;
  options.cache_folder = DiskCache::usual_folder();
  options.threads = run_->threads();
  options.bake = false;
  options.colour.quality = RenderQuality::draft;
  if (!device_) device_ = open_device(mission_->scenario.device, run_->options.device, run_->threads());
  renderer_ = std::make_unique<Renderer>(*device_, scene, options);
  lamp_ = false;
  open_eye();
}

void Inspector::open_eye() {
  const Scenario drawn = choose_drawn(mission_->scenario, request_.width, request_.height);
  eye_ = std::make_unique<Camera>(*renderer_, build_camera(drawn.cameras.front(), drawn.seed, run_->threads()), Flight{});
  frames_ = 0;
}

void Inspector::run() {
  due_ = counted_ = Clock::now();
  for (std::optional<std::uint64_t> seed; !leaving(); seed = std::exchange(next_, std::nullopt)) {
    enter(seed);
    owed_ = step_time();
    pile_->settle([this] {
      if (!renderer_) {
        drawn_ = pile_->all_pieces();
        lay_surroundings(mission_->scenario, mission_->assets, drawn_);
        draw_scene(build_live_scene(choose_drawn(mission_->scenario, request_.width, request_.height), mission_->assets, drawn_,
                                    {}, mission_->scenario.start_ns, [this](int id, std::int64_t) -> std::optional<Pose> {
                                      if (id >= world().size()) return std::nullopt;  // it falls later
                                      const PieceState piece = world().piece(id);
                                      if (piece.status == PieceStatus::lost) return std::nullopt;
                                      return piece.world_from_body;
                                    }));
        if (!camera_) {
          DriveLimits limits;
          limits.speed = 2;
          camera_ = std::make_unique<DrivenCamera>(look_over(drawn_, mission_->assets.types), Plan::ghost, 0.1, nothing(), limits);
          print_err("inspect: ready, H for help\n");
        }
      }
      return between();
    });
    note_rest();
    if (!mission_->scenario.robots.empty() && !leaving()) {
      begin_robots();
      for (owed_ = 0; between(); robots_->step()) {
      }
    }
    while (!leaving()) {
      turn();
      // What is pulled or stepped is not at rest any more.
      const bool step = spring_.holds() ? !pace_.paused || pace_.one_step : pace_.one_step;
      if (!step || leaving()) continue;
      pace_.one_step = false;
      push_spring();
      owed_ = step_time();
      pile_->settle([this] { return between(); });
      note_rest();
    }
    if (request_.steps > 0 && turns_ >= request_.steps) break;
  }
}

void Inspector::note_rest() {
  if (leaving()) return;
  screen_.say(words(pile_->settled() ? "the pile rests after %.2f s" : "the pile does not rest: the time limit came after %.2f s", world().time()));
}

// Victims, fines and robots come when the pile rests, as in a run.
void Inspector::begin_robots() {
  spring_.release();
  screen_.say("the robots go on by the mission");
  rested_ = pile_->rested();
  with_lines_of_script(*mission_, [&] {
    complete_pile(*mission_, *run_, rested_);
    SessionOptions options;
    options.observed = true;
    robots_ = std::make_unique<Session>(*mission_, rested_, make_robots(*mission_, *run_), *run_, options);
    robots_->start();
    return 0;
  });
  voids_->forget();
  draw_scene(robots_->build_scene(choose_drawn(mission_->scenario, request_.width, request_.height)));
}

bool Inspector::between() {
  if (robots_ && robots_->steps() == robots_->steps_of_mission() && robots_->steps() > 0) {
    pace_.paused = true;
    screen_.say("the mission ends here; space goes on");
  }
  owed_ -= step_time();
  while (!leaving() && (pace_.paused ? !pace_.one_step : owed_ < 0.5 * step_time())) turn();
  if (pace_.paused) owed_ = 0;
  pace_.one_step = false;
  push_spring();
  return !leaving();
}

void Inspector::push_spring() {
  if (!spring_.holds()) return;
  if (world().piece(spring_.piece()).status == PieceStatus::lost) return spring_.release();
  const Vec3 impulse = spring_.calc_impulse(world(), step_time());
  if (robots_)
    robots_->apply_impulse(spring_.piece(), spring_.point(world()), impulse);
  else
    pile_->world().apply_impulse(spring_.piece(), spring_.point(world()), impulse);
  ++touched_;
}

void Inspector::turn() {
  screen_.poll(controls_);
  const DriveInput input = controls_.take();
  for (const DriveAction action : input.actions) act(action);
  if (leaving()) return;
  camera_->step(input, 1 / kPictureRate);
  if (robots_)
    for (const Sample& sample : robots_->observe())
      if (const auto* reading = std::get_if<Reading>(&sample); reading && reading->scan) scan_ = reading->scan;
  const std::int64_t stamp = mission_->scenario.start_ns + std::int64_t(double(frames_) * 1e9 / kPictureRate);
  eye_->fly_on(stamp, camera_->pose().world_from_camera());
  frame_ = eye_->take(frames_++);
  pull(controls_.pointer());
  show();
  ++turns_;
  if (!pace_.paused) owed_ += 1 / (kPictureRate * pace_.slowness);
  const auto picture_time = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / kPictureRate));
  due_ = std::max(due_ + picture_time, Clock::now() - picture_time);
  std::this_thread::sleep_until(due_);
  const Clock::time_point now = Clock::now();
  rate_ += 0.1 * (1 / std::max(std::chrono::duration<double>(now - counted_).count(), 1e-3) - rate_);
  counted_ = now;
}

// Takes hold of what is under the mouse where its button goes down, and draws it along in the plane of that depth.
void Inspector::pull(const Pointer& pointer) {
  if (!pointer.pressed) pressed_ = false;
  if (!pointer.pressed) return spring_.release();
  const Intrinsics& image = frame_.intrinsics;
  const auto at_depth = [&](double u, double v, double depth) {
    const Vec3 ray = *Lens(image).direction(u, v);  // of a pinhole, which sees everywhere
    return frame_.world_from_camera * Pose{camera_from_optical.rotation, {}} * (ray * (depth / ray.z));
  };
  if (!std::exchange(pressed_, true)) {
    const int u = int(std::lround(pointer.press_x)), v = int(std::lround(pointer.press_y));
    if (u < 0 || v < 0 || u >= image.width || v >= image.height) return;
    const std::size_t pixel = std::size_t(v) * std::size_t(image.width) + std::size_t(u);
    const std::uint32_t id = frame_.get<std::uint32_t>("instance").at(pixel);
    if (id >= std::uint32_t(world().size())) return;
    held_depth_ = double(frame_.depth[pixel]);
    if (!spring_.grab(world(), int(id), at_depth(u, v, held_depth_))) screen_.say("this piece is fixed");
  }
  if (spring_.holds()) spring_.pull_to(at_depth(pointer.x, pointer.y, held_depth_));
}

void Inspector::act(DriveAction action) {
  switch (action) {
    case DriveAction::lamp: {
      LampSpec lamp = mission_->scenario.lamp;
      lamp.on = lamp_ = !lamp_;
      renderer_->restart(lamp, mission_->scenario.air);
      return open_eye();
    }
    case DriveAction::faster:
    case DriveAction::slower:
      return camera_->change_speed(action == DriveAction::faster ? 1 : -1);
    case DriveAction::reset:
      next_ = mission_->scenario.seed;
      return;
    case DriveAction::next_seed:
      next_ = mission_->scenario.seed + 1;
      return;
    case DriveAction::pause:
    case DriveAction::one_step:
    case DriveAction::slow:
      return void(pace_.act(action));
    case DriveAction::hulls:
      choice_.hulls = !choice_.hulls;
      return;
    case DriveAction::contacts:
      choice_.contacts = !choice_.contacts;
      return;
    case DriveAction::frames:
      choice_.frames = !choice_.frames;
      if (choice_.frames && !robots_) screen_.say("links are those of robots, which come when the pile rests");
      return;
    case DriveAction::scans:
      choice_.scans = !choice_.scans;
      if (choice_.scans && !robots_) screen_.say("echoes are those of scans on robots, which come when the pile rests");
      return;
    case DriveAction::cameras:
      choice_.cameras = !choice_.cameras;
      if (choice_.cameras && pile_->settling() && !mission_->scenario.trajectory.ride.on() &&
          mission_->scenario.trajectory.needs_pile())
        screen_.say("the flight depends on the pile: views are shown when it rests");
      if (choice_.cameras && mission_->scenario.trajectory.ride.on() && !robots_)
        screen_.say("the cameras ride on a robot, which comes when the pile rests");
      return;
    case DriveAction::voids:
      choice_.voids = !choice_.voids;
      return map_voids();
    case DriveAction::moment:
      return save_moment();
    case DriveAction::help:
      help_ = !help_;
      return;
    case DriveAction::picture:
      return screen_.save_picture(folder_);
    case DriveAction::quit:
      quit_ = true;
      return;
    case DriveAction::lamp_up:
    case DriveAction::lamp_down:
    case DriveAction::fog:
    case DriveAction::fog_up:
    case DriveAction::fog_down:
      return;
  }
}

void Inspector::save_moment() {
  if (robots_) return screen_.say("a moment with robots cannot be saved");
  if (!pile_->can_save()) return screen_.say("a building that collapses cannot be saved: its stresses are not; wait until it rests");
  std::string comment = words("%s, seed %llu, after %.4f s of settling.", request_.of.mission.c_str(),
                              static_cast<unsigned long long>(mission_->scenario.seed), world().time());
  comment += touched_ > 0 ? "\n" + words("By hand: pieces were pulled during %lld steps.", static_cast<long long>(touched_))
                          : "\nNothing was touched.";
  comment += "\n`rubble run` on this settles on from there, with the same bits.";
  const std::string path = save_snapshot(*mission_, pile_->checkpoint(), folder_, words("moment_%03d", ++moments_), comment,
                                         !request_.of.asset_packs.empty());
  print_out("%s\n", path.c_str());
  std::fflush(stdout);
  screen_.say(path);
}

void Inspector::map_voids() {
  if (!choice_.voids) return voids_->forget();
  PileState now = pile_->state();
  if (robots_) {
    now = rested_;
    for (std::size_t i = 0; i < now.pieces.size(); ++i) now.pieces[i] = world().piece(int(i));
  }
  voids_->start(now, world().steps(), run_->threads());
}

ExitCode inspect_mission(const DriveRequest& request) {
  stop_on_signals();
  Inspector inspector(request);
  inspector.run();
  return ExitCode::done;
}

}  // namespace rubble
