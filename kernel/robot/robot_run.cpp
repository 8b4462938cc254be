#include "kernel/robot/robot_run.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/surroundings/make_surroundings.h"
#include "kernel/world/world_robots.h"

namespace rubble {
namespace {

// A robot that reaches deeper into something than this cannot be put there; unit: m.
constexpr double kMostDepth = 0.005;
constexpr double kStuckDistance = 0.02;  // in a second; unit: m
constexpr double kMovedDistance = 0.01;  // unit: m

WorldOptions world_options(const RobotRunOptions& options) {
  WorldOptions world;
  world.gravity = options.gravity;
  world.lost_below = options.lost_below;
  world.lost_beyond = options.lost_beyond;
  world.threads = options.threads;
  return world;
}

void check(const RobotRunOptions& options) {
  const auto expect = [](bool fine, const char* key, const char* expected, double found) {
    if (!fine) throw InputError({"", 0, key, "out of range", expected, plain_text(found), ""});
  };
  expect(options.duration > 0, "duration", "more than 0 s", options.duration);
  expect(options.control_hz >= 1 && options.control_hz <= 1000, "control_hz", "1 to 1000 Hz",
         options.control_hz);
  expect(options.track_hz == 0 || (options.track_hz >= 1 && options.track_hz <= 1000), "track_hz",
         "1 to 1000 Hz, or 0", options.track_hz);
}

std::shared_ptr<const TriangleMesh> find_surroundings(const PileState& state) {
  if (!state.surroundings) return nullptr;
  TriangleMesh surface = make_solid_surface(*state.surroundings, kFeltReach);
  return surface.triangles.empty() ? nullptr : std::make_shared<const TriangleMesh>(std::move(surface));
}

std::string text_of(const char* format, double a, double b, double c) {
  char text[96];
  std::snprintf(text, sizeof text, format, a, b, c);
  return text;
}

}  // namespace

RobotRun::RobotRun(const Pile& pile, const PileState& state, const RobotRunOptions& options)
    : options_(options),
      laid_(pile),
      pile_(state),
      surroundings_(find_surroundings(state)),
      world_(pile.types, world_options(options), pile.assemblies) {
  check(options);
  world_.lay(pile, state, options.fixed_debris);
  world_.set_step(options.step, options.substeps);
  if (options.restarts) laid_world_ = world_.snapshot();
}

void RobotRun::restart() {
  if (!laid_world_) throw RunError("a run of robots is started again without the option for it");
  world_.restore(*laid_world_);
  robots_.clear();
  recorder_ = TrackRecorder();
  surface_ = -1, steps_ = 0;
}

int RobotRun::add(const RobotModel& model, const Pose& world_from_base, RobotController controller) {
  const int robot = world_.robots().add(model, world_from_base);
  Driven driven;
  driven.base = world_from_base;
  driven.controller = std::move(controller);
  driven.start = driven.last = driven.second_ago =
      world_.robots().state(robot).links[model.lead()].world_from_link.translation;
  driven.summary.lowest = driven.start.z;
  driven.work.assign(model.joints.size(), 0);
  robots_.push_back(driven);
  return robot;
}

void RobotRun::control() {
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    const int robot = int(i);
    RobotSense sense{world_.time(), world_.robots().state(robot), world_.robots().contacts(robot)};
    if (!sense.state.lost) world_.robots().set_command(robot, robots_[i].controller(sense));
  }
}

// What is staked has no contacts with what is fixed: the base alone, free to move, has them.
std::vector<RobotContact> RobotRun::find_base_contacts(int robot) const {
  RobotModel base;
  base.name = world_.robots().model(robot).name;
  base.links = {world_.robots().model(robot).links[0]};
  World probe(laid_.types, world_options(options_), laid_.assemblies);
  probe.lay(laid_, pile_, true);
  probe.set_step(options_.step, options_.substeps);
  probe.robots().add(base, robots_[std::size_t(robot)].base);
  if (surroundings_) probe.add_surface(surroundings_, kSurroundingsFriction);
  probe.step();
  std::vector<RobotContact> contacts = probe.robots().contacts(0);
  const int first = probe.robots().first_piece(0), own = world_.robots().first_piece(robot);
  for (RobotContact& c : contacts) {
    c.piece = c.piece == first ? own : c.piece == first + 1 ? surface_ : c.piece;
  }
  return contacts;
}

// Of what a robot touches.
std::string RobotRun::name_of(int piece) const {
  if (piece < 0) return "the ground";
  if (piece == surface_) return "the surroundings";
  if (piece >= int(pile_.pieces.size())) return "another robot";
  return pile_.types[std::size_t(pile_.pieces[std::size_t(piece)].type)] + " (piece " + std::to_string(piece) + ")";
}

// Of a robot that has left the world with its first step.
Diagnostic RobotRun::describe_lost(std::size_t robot) const {
  const Vec3& at = robots_[robot].base.translation;
  const bool deep = robots_[robot].start.z < options_.lost_below;
  Diagnostic d;
  d.key = "robots[" + std::to_string(robot + 1) + "].position";
  d.message = deep ? "the robot stands below settle.lost_below, outside of the world"
                   : "the robot stands farther from the Z axis than settle.lost_beyond, outside of the world";
  d.expected = deep ? text_of("a place above %g m", options_.lost_below, 0, 0) : text_of("a place within %g m", options_.lost_beyond, 0, 0);
  d.found = text_of("{%g, %g, %g}", at.x, at.y, at.z);
  d.hint = deep ? "the ground is at z = 0 where there is no terrain" : "or a larger settle.lost_beyond";
  return d;
}

// After the first step: its contacts were found where everything stood before it.
void RobotRun::check_room() const {
  std::vector<Diagnostic> mistakes;
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    const int first = world_.robots().first_piece(int(i));
    const RobotModel& model = world_.robots().model(int(i));
    if (world_.robots().state(int(i)).lost) {
      mistakes.push_back(describe_lost(i));
      continue;
    }
    RobotContact worst;
    std::vector<RobotContact> contacts = world_.robots().contacts(int(i));
    if (model.tube) {
      const std::vector<RobotContact> of_base = find_base_contacts(int(i));
      contacts.insert(contacts.end(), of_base.begin(), of_base.end());
    }
    for (const RobotContact& c : contacts) {
      const bool own = c.piece >= first && c.piece < first + int(model.links.size());
      if (!own && c.separation < worst.separation) worst = c;
    }
    if (worst.separation > -kMostDepth) continue;
    const Vec3 out = worst.normal * -worst.separation;
    Diagnostic d;
    d.key = "robots[" + std::to_string(i + 1) + "].position";
    d.message = model.links[std::size_t(worst.link)].name + " stands " +
                text_of("%.3f m", -worst.separation, 0, 0) + " deep in " + name_of(worst.piece);
    d.expected = "a place that is free";
    // Downwards would be into the ground.
    d.hint = out.z < -1e-3 ? "a place above it, or beside it" : text_of("move it by {%.3f, %.3f, %.3f} at least", out.x, out.y, out.z);
    mistakes.push_back(d);
  }
  if (!mistakes.empty()) throw InputError(mistakes);
}

void RobotRun::measure() {
  const std::int64_t second = steps_between(1, options_.step);
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    Driven& r = robots_[i];
    const RobotState state = world_.robots().state(int(i));
    r.summary.lost = state.lost;
    if (state.lost) continue;
    const Vec3 at = state.links[world_.robots().model(int(i)).lead()].world_from_link.translation;
    r.summary.path += distance(at, r.last);
    r.summary.distance = distance(at, r.start);
    r.summary.lowest = std::min(r.summary.lowest, at.z);
    r.last = at;
    for (std::size_t k = 0; k < state.joints.size(); ++k) {
      r.summary.work += std::abs(state.joints[k].work - r.work[k]);
      r.work[k] = state.joints[k].work;
    }
    if (world_.steps() % second != 0) continue;
    if (distance(at, r.second_ago) < kStuckDistance) r.summary.stuck_time += 1;
    r.second_ago = at;
  }
}

void RobotRun::begin() {
  // After all robots: the numbers of their links go on from those of the pieces.
  if (surroundings_) surface_ = world_.add_surface(surroundings_, kSurroundingsFriction);
  if (options_.track_hz > 0) recorder_.observe(world_);
}

void RobotRun::step() {
  if (steps_ % steps_between(options_.control_hz, options_.step) == 0) control();
  world_.step();
  if (steps_++ == 0) check_room();
  measure();
  if (options_.track_hz > 0 && steps_ % steps_between(options_.track_hz, options_.step) == 0) recorder_.observe(world_);
}

RobotRunResult RobotRun::finish() {
  RobotRunResult result;
  result.track = recorder_.take();
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    result.first_piece.push_back(world_.robots().first_piece(int(i)));
    result.robots.push_back(robots_[i].summary);
  }
  for (std::size_t i = 0; i < pile_.pieces.size(); ++i) {
    if (pile_.pieces[i].status == PieceStatus::lost) continue;
    const Vec3 now = world_.piece(int(i)).world_from_body.translation;
    if (distance(now, pile_.pieces[i].world_from_body.translation) > kMovedDistance) {
      ++result.pieces_moved;
    }
  }
  return result;
}

RobotRunResult RobotRun::run(const std::function<bool(double)>& on_step) {
  const std::int64_t steps = std::int64_t(options_.duration / options_.step + 0.5);
  begin();
  for (std::int64_t i = 0; i < steps; ++i) {
    step();
    if (on_step && !on_step(double(i + 1) / double(steps))) break;
  }
  return finish();
}

}  // namespace rubble
