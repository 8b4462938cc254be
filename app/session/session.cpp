#include "app/session/session.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "app/control/robot_control.h"
#include "app/control/robot_senses.h"
#include "app/control/script_control.h"
#include "app/sensors/camera_renderers.h"
#include "app/sensors/camera_sensor.h"
#include "app/support/drawing_device.h"
#include "kernel/world/world_robots.h"

namespace rubble {

struct LiveColoursOptions {
  int threads = 1;
  Renderer::Progress progress;  // of the light
};

// What cameras on robots show while the robots are driven: renderers of their own, of the scene that goes on.
//
// Its pictures have the bits of the recorded ones, which are drawn by such renderers of a scene that is lit in the same way
// then: build_live_scene().
class LiveColours {
 public:
  // scene: shows everything where the history of the sensors has it. drawn: numbers of the cameras. Throws RunError as
  // Renderer does.
  LiveColours(std::unique_ptr<Device> device, const Scene& scene, const std::vector<MountedCamera>& cameras,
              const std::vector<std::size_t>& drawn, const LiveColoursOptions& options)
      : device_(std::move(device)),
        renderers_(scene, cameras, drawn, *device_, {options.threads, options.progress, {}}) {}

  Renderer& renderer_of(std::size_t camera) { return renderers_.of(camera); }

 private:
  std::unique_ptr<Device> device_;
  CameraRenderers renderers_;
};

namespace {

// Numbers of the sensors on robots.
template <typename Item>
std::vector<std::size_t> find_carried(const std::vector<Item>& sensors, const RobotReadings& ways) {
  std::vector<std::size_t> carried;
  for (std::size_t i = 0; i < sensors.size(); ++i)
    if (ways.path_of(sensors[i].ride, ways.ride)) carried.push_back(i);
  return carried;
}

}  // namespace

Session::Session(const ResolvedMission& mission, const PileState& pile, std::vector<MissionRobot> robots,
                 RunContext& context, const SessionOptions& options)
    : mission_(mission),
      scenario_(mission.scenario),
      pile_(pile),
      context_(context),
      options_(options),
      start_ns_(options.start_ns.value_or(scenario_.start_ns)),
      run_options_(robot_run_options(scenario_, context.threads())),
      laid_(make_laid_pile(mission, pile)),
      names_(robot_names(scenario_.robots)),
      robots_(std::move(robots)),
      records_(describe_robots(scenario_, robots_)),
      history_(scenario_, robots_, run_options_.step, start_ns_),
      own_(robots_.size()),
      bases_(robots_.size()) {
  run_options_.restarts = options.restarts;
  for (const MissionRobot& robot : robots_) seen_.models.push_back(robot.model);
}

Session::~Session() = default;

std::int64_t Session::steps_of_mission() const {
  return std::int64_t(run_options_.duration / run_options_.step + 0.5);
}

void Session::set_controller(std::size_t robot, RobotController controller) { own_[robot] = std::move(controller); }

// Legs, or a function of the script, unless somebody else drives it.
RobotController Session::make_controller(std::size_t robot) {
  const RobotItem& item = scenario_.robots[robot];
  const RobotModel& model = robots_[robot].model;
  if (own_[robot]) return own_[robot];
  if (item.control == 0) return make_leg_controller(item, model);
  if (!script_)
    script_ = std::make_unique<ScriptControl>(mission_, [this](std::size_t told, Value& table) {
      measure();
      senses_->tell(told, table);
    });
  return script_->controller_of(robot, model);
}

void Session::start() {
  script_ = nullptr;
  senses_ = std::make_unique<RobotSenses>(scenario_, start_ns_);
  commands_.assign(robots_.size(), std::nullopt);
  sensors_.clear(), measured_.clear(), logs_.clear(), seen_.first_piece.clear();
  if (run_ && options_.restarts) run_->restart();
  else run_ = std::make_unique<RobotRun>(laid_, pile_, run_options_);
  for (std::size_t i = 0; i < robots_.size(); ++i)
    logs_.emplace_back(robots_[i].model, start_ns_, odometry_noise(scenario_, i));
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    const RobotController own = make_controller(i);
    const RobotController control = with_mimics(
        [this, i, own](const RobotSense& sense) { return commands_[i] ? *commands_[i] : own(sense); }, robots_[i].model.mimics);
    run_->add(robots_[i].model, bases_[i] ? *bases_[i] : calc_base_pose(scenario_.robots[i], robots_[i]),
              [this, control, &log = logs_[i]](const RobotSense& sense) {
                if (options_.observed || options_.recorded) log.note(sense);
                return control(sense);
              });
    seen_.first_piece.push_back(run_->world().robots().first_piece(int(i)));
  }
  run_->begin();
  history_.restart(*run_);
  make_sensors();
}

// Units of inertia, other kinds, depth and colours: the order of samples whose stamps are equal.
void Session::make_sensors() {
  auto [readings, depths, colours, imus] = script_ ? senses_->sensed() : RobotSenses::Sensed();
  const auto add = [](std::vector<std::size_t>& list, const std::vector<std::size_t>& more) {
    for (const std::size_t i : more)
      if (std::find(list.begin(), list.end(), i) == list.end()) list.push_back(i);
    std::sort(list.begin(), list.end());
  };
  if (options_.observed) {
    add(imus, find_carried(scenario_.imus, history_.ways()));
    add(readings, find_carried(scenario_.sensors, history_.ways()));
  }
  if (options_.depth) add(depths, find_carried(scenario_.cameras, history_.ways()));
  const bool rays = !depths.empty() || (!readings.empty() && casts_rays(scenario_.sensors));
  if (imus.empty() && readings.empty() && !rays && colours.empty()) return;
  Scene scene;
  if ((rays && !world_of_rays_) || (!colours.empty() && !colours_))
    scene = build_live_scene(scenario_, mission_.assets, pile_, seen_, start_ns_,
                             [this](int id, std::int64_t stamp_ns) { return history_.pose_of(id, stamp_ns); });
  if (rays && !world_of_rays_) world_of_rays_ = std::make_shared<RayWorld>(scene);
  const SensorParts parts{scenario_, scenario_.seed, start_ns_, history_.ways(), history_.ways().ride, world_of_rays_,
                          std::make_shared<const Medium>(scenario_.air, scenario_.seed), context_.threads()};
  for (const std::size_t i : imus) sensors_.push_back({make_imu(parts, i), scenario_.imus[i].ride});
  for (const std::size_t i : readings) sensors_.push_back({make_sensor(parts, i), scenario_.sensors[i].ride});
  for (const std::size_t i : depths) sensors_.push_back({make_depth_sensor(parts, i), scenario_.cameras[i].ride});
  if (!colours.empty() && !colours_)
    colours_ = std::make_unique<LiveColours>(
        open_device(scenario_.device, context_.options.device, context_.threads()), scene, scenario_.cameras, colours,
        LiveColoursOptions{context_.threads(), [this](double done) {
                             context_.progress.update(0, "light " + std::to_string(int(100 * done)) + " %");
                           }});
  for (const std::size_t i : colours)
    sensors_.push_back({make_riding_camera(parts, i, colours_->renderer_of(i)), scenario_.cameras[i].ride});
}

void Session::step() {
  run_->step();
  history_.note_step();
  if (sensors_.empty() && !options_.recorded) history_.forget_before(history_.ways_known_until());
}

void Session::measure() {
  const std::int64_t way = history_.ways_known_until(), track = history_.track_known_until();
  std::int64_t needed = way;
  for (Carried& carried : sensors_) {
    const std::int64_t end = history_.end_of(carried.carrier).value_or(INT64_MAX);
    Sensor::Needs needs = carried.sensor->needs();
    for (; needs.way_until <= way && needs.scene_until <= track; needs = carried.sensor->needs()) {
      if (is_over(needs, end, carried.taken)) break;
      carried.taken = true;
      Sample sample = carried.sensor->take();
      senses_->hear(sample);
      if (options_.observed || options_.depth) measured_.push_back(std::move(sample));
    }
    needed = std::min(needed, needs.from);
  }
  if (!options_.recorded) history_.forget_before(needed);
}

std::vector<Sample> Session::observe() {
  measure();
  std::vector<Sample> samples;
  for (RobotLog& log : logs_)
    for (RobotSample& sample : log.take_samples()) samples.emplace_back(std::move(sample));
  std::move(measured_.begin(), measured_.end(), std::back_inserter(samples));
  measured_.clear();
  std::stable_sort(samples.begin(), samples.end(),
                   [](const Sample& a, const Sample& b) { return stamp_of(a) < stamp_of(b); });
  return samples;
}

DrivenRobots Session::finish() {
  DrivenRobots driven;
  driven.start_ns = start_ns_;
  driven.readings = history_.ways();
  const World& world = run_->world();
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    const RobotSense last{world.time(), world.robots().state(int(i)), world.robots().contacts(int(i))};
    if (!last.state.lost) logs_[i].note(last);
    driven.readings.samples.push_back(logs_[i].samples());
  }
  driven.records = records_;
  driven.mount = mount();
  RobotRunResult result = run_->finish();
  driven.moved.track = std::move(result.track);
  driven.moved.models = seen_.models;
  driven.moved.first_piece = std::move(result.first_piece);
  driven.summaries = std::move(result.robots);
  driven.pieces_moved = result.pieces_moved;
  return driven;
}

Scene Session::build_scene(const Scenario& drawn) const {
  return build_live_scene(drawn, mission_.assets, pile_, seen_, start_ns_, [this](int id, std::int64_t) -> std::optional<Pose> {
    const PieceState piece = run_->world().piece(id);
    if (piece.status == PieceStatus::lost) return std::nullopt;
    return piece.world_from_body;
  });
}

}  // namespace rubble
