// A mission's robots in its settled pile, stepped for programs on a network, and the entities that these know by name.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/control/teleop_robot.h"
#include "app/mission/resolved_mission.h"
#include "app/session/session.h"

namespace rubble {

// A robot or a piece. Pieces are piece_0, piece_1, ...
struct Entity {
  std::string name;
  std::string asset;      // "crawler", "brick"
  bool robot = false, human = false;
  std::size_t number = 0; // of the robot, or of the piece
};

class ServedWorld {
 public:
  // The context must outlive this. Throws InputError as Session does.
  ServedWorld(ResolvedMission mission, PileState pile, RunContext& context);

  // To the start. spawned: also without the robots that were spawned and with those that were deleted.
  void restart(bool spawned);
  void step() { session_->step(); }

  Session& session() { return *session_; }
  const ResolvedMission& mission() const { return mission_; }
  const PileState& pile() const { return pile_; }
  double time() const { return double(session_->steps()) * session_->step_time(); }
  std::int64_t stamp_ns() const;
  // What drives the robot; null: a function of the script does.
  TeleopRobot* teleop(std::size_t robot) { return teleops_[robot].get(); }

  const std::vector<Entity>& entities() const { return entities_; }  // without pieces that left the world at the start
  const Entity* find(const std::string& name) const;
  // Of its origin, in the world; unit: m, m/s, rad/s. nullopt: it has left the world.
  struct State {
    Pose pose;
    Vec3 linear, angular;
  };
  std::optional<State> state_of(const Entity& entity) const;
  bool movable(const Entity& entity) const;
  // No effect on what is not movable.
  void set_state(const Entity& entity, const State& state, bool pose, bool twist);

  // Before the first step alone. Throw InputError, and change nothing: no room at that place, a sensor that rode on it.
  void spawn(RobotItem item, const Pose& world_from_robot);
  void remove(std::size_t robot);

 private:
  struct Spawned {
    std::string name;
    Pose pose;
  };
  // With the robots of the mission as it now is. Throws InputError, and changes nothing.
  void make_session();
  void list_entities();
  int piece_of(const Entity& entity) const;

  ResolvedMission mission_;
  const std::vector<RobotItem> own_;  // robots of the mission
  PileState pile_;
  RunContext& context_;
  std::vector<Spawned> spawned_;
  std::vector<std::unique_ptr<TeleopRobot>> teleops_;
  std::unique_ptr<Session> session_;
  std::vector<Entity> entities_;
};

}  // namespace rubble
