// Robots in a pile that has settled, and in its surroundings: control at a rate of its own, what moves kept as a track.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "kernel/model/pile.h"
#include "kernel/model/pile_state.h"
#include "kernel/model/robot.h"
#include "kernel/model/track.h"
#include "kernel/settling/track_recorder.h"
#include "kernel/world/world.h"

namespace rubble {

// What a controller is told.
struct RobotSense {
  double time = 0;                     // since the start; unit: s
  RobotState state;                    // after the step
  std::vector<RobotContact> contacts;  // of its links, in the step
};
using RobotController = std::function<RobotCommand(const RobotSense&)>;

struct RobotRunOptions {
  double duration = 10;         // unit: s; range: above 0
  double step = 1.0 / 240;      // unit: s; range: 1/1000 to 1/30
  int substeps = 4;             // of the contact solver in a step; range: 1 to 64
  double control_hz = 60;       // rounded to whole steps; range: 1 to 1000
  double track_hz = 60;         // likewise: samples of the track
  bool fixed_debris = false;    // true: nothing of the pile ever moves
  double gravity = 9.81;        // unit: m/s2, downwards
  double lost_below = -0.5;     // unit: m
  double lost_beyond = 100;     // from the Z axis; unit: m
  int threads = 0;              // 0: all processors; the result does not depend on it
};

// What became of one robot.
struct RobotSummary {
  double distance = 0;    // of its lead (RobotModel::lead), from start to end; unit: m
  double path = 0;        // along its way; unit: m
  double work = 0;        // of the motors, what they took and gave both counted; unit: J
  double lowest = 0;      // of the lead's origin; unit: m
  double stuck_time = 0;  // the lead moved less than 2 cm within a second; unit: s
  bool lost = false;      // it left the world
};

struct RobotRunResult {
  Track track;                       // ids: pieces of the pile, then links, robot by robot
  std::vector<int> first_piece;      // id of each robot's first link
  std::vector<RobotSummary> robots;  // in the order of add()
  int pieces_moved = 0;              // of the pile, by more than 1 cm
  std::uint64_t hash() const { return track.hash(); }
};

class RobotRun {
 public:
  // Throws InputError for options out of range and for a state of another pile.
  RobotRun(const Pile& pile, const PileState& state, const RobotRunOptions& options = {});

  // world_from_base: of the first link's frame.
  int add(const RobotModel& model, const Pose& world_from_base, RobotController controller);

  // Throws InputError where a robot stands in a piece, in the ground or in another robot: which, how deep
  // and where to. on_step: 0 to 1; return false to stop.
  RobotRunResult run(const std::function<bool(double)>& on_step = {});

  // The same one step after another, as long as wanted: begin() once, step() as often as there are steps,
  // finish() once. The duration of the options is not looked at.
  void begin();
  void step();
  RobotRunResult finish();

  const World& world() const { return world_; }
  std::int64_t steps() const { return steps_; }  // since begin()

 private:
  struct Driven {
    Pose base;  // at the start
    RobotController controller;
    RobotSummary summary;
    Vec3 start, last, second_ago;
    std::vector<double> work;  // by joint, at the last step
  };
  void control();
  void check_room() const;
  std::string name_of(int piece) const;
  std::vector<RobotContact> find_base_contacts(int robot) const;
  void measure();

  RobotRunOptions options_;
  Pile laid_;
  PileState pile_;
  std::shared_ptr<const TriangleMesh> surroundings_;  // what is solid of them; none: the plane alone
  int surface_ = -1;                                  // its number in the world; -1: none
  World world_;
  std::vector<Driven> robots_;
  TrackRecorder recorder_;
  std::int64_t steps_ = 0;
};

}  // namespace rubble
