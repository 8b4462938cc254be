#include "app/serve/served_world.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/control/robot_control.h"
#include "app/victims/place_victims.h"
#include "kernel/world/world_robots.h"
#include "scripting/robots/robot_kind.h"

namespace rubble {

ServedWorld::ServedWorld(ResolvedMission mission, PileState pile, RunContext& context)
    : mission_(std::move(mission)), own_(mission_.scenario.robots), pile_(std::move(pile)), context_(context) {
  make_session();
}

void ServedWorld::make_session() {
  const std::vector<RobotItem>& robots = mission_.scenario.robots;
  std::vector<MissionRobot> made = make_robots(mission_, context_);
  SessionOptions options;
  options.observed = true, options.restarts = true;
  std::vector<std::optional<Pose>> places(robots.size());
  const std::vector<std::string> names = robot_names(robots);
  for (const Spawned& spawned : spawned_)
    for (std::size_t i = 0; i < robots.size(); ++i)
      if (names[i] == spawned.name) places[i] = spawned.pose * made[i].placed_from_base;
  auto session = std::make_unique<Session>(mission_, pile_, std::move(made), context_, options);
  std::vector<std::unique_ptr<TeleopRobot>> teleops;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    session->place(i, places[i]);
    TeleopRobot* const teleop =
        teleops.emplace_back(robots[i].control == 0 ? std::make_unique<TeleopRobot>(robots[i], false) : nullptr).get();
    if (!teleop) continue;
    session->set_controller(i, [teleop, &model = session->robots()[i].model](const RobotSense& sense) {
      return teleop->control(sense, model);
    });
  }
  session->start();
  session->step();  // which finds what stands in a piece
  session->start();
  for (const auto& teleop : teleops)
    if (teleop) teleop->restart();
  session_ = std::move(session);
  teleops_ = std::move(teleops);
  list_entities();
}

void ServedWorld::list_entities() {
  entities_.clear();
  const std::vector<std::string>& names = session_->names();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const RobotItem& item = mission_.scenario.robots[i];
    entities_.push_back({names[i], item.urdf.empty() ? kind_of(item).name() : item.urdf, true, false, i});
  }
  const std::vector<Victim> victims = find_victims(pile_);
  for (std::size_t i = 0; i < pile_.pieces.size(); ++i) {
    const PieceState& piece = pile_.pieces[i];
    if (piece.status == PieceStatus::lost) continue;
    const bool human = std::any_of(victims.begin(), victims.end(), [i](const Victim& victim) { return victim.piece == int(i); });
    entities_.push_back({"piece_" + std::to_string(i), pile_.types[std::size_t(piece.type)], false, human, i});
  }
}

void ServedWorld::restart(bool spawned) {
  if (spawned && (!spawned_.empty() || mission_.scenario.robots.size() != own_.size())) {
    spawned_.clear();
    mission_.scenario.robots = own_;
    return make_session();
  }
  for (const auto& teleop : teleops_)
    if (teleop) teleop->restart();
  session_->start();
}

std::int64_t ServedWorld::stamp_ns() const {
  return mission_.scenario.start_ns + std::int64_t(std::floor(time() * 1e9 + 0.5));
}

const Entity* ServedWorld::find(const std::string& name) const {
  const auto at = std::find_if(entities_.begin(), entities_.end(), [&](const Entity& entity) { return entity.name == name; });
  return at == entities_.end() ? nullptr : &*at;
}

int ServedWorld::piece_of(const Entity& entity) const {
  return entity.robot ? session_->world().robots().first_piece(int(entity.number)) : int(entity.number);
}

std::optional<ServedWorld::State> ServedWorld::state_of(const Entity& entity) const {
  const World& world = session_->world();
  if (entity.robot) {
    const RobotState state = world.robots().state(int(entity.number));
    if (state.lost) return std::nullopt;
    const RobotState::Link& base = state.links.front();
    return State{base.world_from_link, base.linear, base.angular};
  }
  const PieceState piece = world.piece(int(entity.number));
  if (piece.status == PieceStatus::lost) return std::nullopt;
  const Vec3 arm = piece.world_from_body.rotation.rotate(world.centre_of_mass(int(entity.number)));
  return State{piece.world_from_body, piece.linear_velocity - cross(piece.angular_velocity, arm), piece.angular_velocity};
}

bool ServedWorld::movable(const Entity& entity) const { return session_->world().mass(piece_of(entity)) > 0; }

void ServedWorld::set_state(const Entity& entity, const State& state, bool pose, bool twist) {
  const int piece = piece_of(entity);
  if (pose) session_->set_pose(piece, state.pose);
  if (!twist) return;
  const World& world = session_->world();
  const Vec3 arm = world.piece(piece).world_from_body.rotation.rotate(world.centre_of_mass(piece));
  session_->set_velocity(piece, state.linear + cross(state.angular, arm), state.angular);
}

void ServedWorld::spawn(RobotItem item, const Pose& world_from_robot) {
  std::vector<RobotItem>& robots = mission_.scenario.robots;
  // Names that follow from the others' places must not change.
  const std::vector<RobotItem> before = robots;
  const std::vector<std::string> names = robot_names(robots);
  for (std::size_t i = 0; i < robots.size(); ++i) robots[i].name = names[i];
  spawned_.push_back({item.name, world_from_robot});
  robots.push_back(std::move(item));
  try {
    make_session();
  } catch (...) {
    robots = before;
    spawned_.pop_back();
    throw;
  }
}

void ServedWorld::remove(std::size_t robot) {
  std::vector<RobotItem>& robots = mission_.scenario.robots;
  const std::vector<RobotItem> before = robots;
  const std::vector<std::string> names = robot_names(robots);
  for (std::size_t i = 0; i < robots.size(); ++i) robots[i].name = names[i];
  robots.erase(robots.begin() + long(robot));
  try {
    make_session();
  } catch (...) {
    robots = before;
    throw;
  }
  spawned_.erase(std::remove_if(spawned_.begin(), spawned_.end(), [&](const Spawned& s) { return s.name == names[robot]; }),
                 spawned_.end());
}

}  // namespace rubble
