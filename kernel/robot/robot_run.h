// Drives robots through a settled pile and its surroundings. Control has its own rate; motion is kept as a track.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "kernel/base/error.h"
#include "kernel/model/pile.h"
#include "kernel/model/pile_state.h"
#include "kernel/model/robot.h"
#include "kernel/model/track.h"
#include "kernel/robot/step_rate.h"
#include "kernel/settling/track_recorder.h"
#include "kernel/world/world.h"

namespace rubble {

// Input of a controller.
struct RobotSense {
  double time = 0;                     // since the start; unit: s
  RobotState state;                    // after the step
  std::vector<RobotContact> contacts;  // of its links, in this step
};
using RobotController = std::function<RobotCommand(const RobotSense&)>;

struct RobotRunOptions {
  double duration = 10;         // unit: s; range: above 0
  double step = kUsualRobotStep;  // unit: s; range: 1/1000 to 1/30
  int substeps = 4;             // of the contact solver in a step; range: 1 to 64
  double control_hz = 60;       // rounded to whole steps; range: 1 to 1000
  double track_hz = 60;         // samples of the track; rounded to whole steps; range: 1 to 1000; 0: none
  bool fixed_debris = false;    // true: the pile never moves
  double gravity = 9.81;        // unit: m/s2, downwards
  double lost_below = -0.5;     // unit: m
  double lost_beyond = 100;     // from the Z axis; unit: m
  int threads = 0;              // 0: all processors; the result does not depend on it
  bool restarts = false;        // whether restart() may be called; keeps a copy of the laid pile
};

// Result for one robot.
struct RobotSummary {
  double distance = 0;    // of its lead (RobotModel::lead) from start to end, straight; unit: m
  double path = 0;        // length of the path of the lead; unit: m
  double work = 0;        // of the motors; negative work counts by its amount, too; unit: J
  double lowest = 0;      // of the lead's origin; unit: m
  double stuck_time = 0;  // time in which the lead moved by less than 2 cm within a second; unit: s
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

  // Throws InputError if a robot overlaps a piece, the ground or another robot at its start. The error names the
  // obstacle, the depth and a free place. on_step: progress from 0 to 1; return false to stop.
  RobotRunResult run(const std::function<bool(double)>& on_step = {});

  // The same in single steps, for any duration: call begin() once, step() repeatedly, finish() once. The duration
  // of the options is ignored.
  void begin();
  void step();
  RobotRunResult finish();

  // Back to before the first add(), with the bits of a new run of the same pile: it is not laid again. What was added
  // is gone. Throws RunError without the option `restarts`.
  void restart();

  // Before the next step: see World::apply_impulse().
  void apply_impulse(int piece, const Vec3& point, const Vec3& impulse) { world_.apply_impulse(piece, point, impulse); }

  // Likewise, see World::set_pose() and World::set_velocity(). The room at that place is not checked.
  void set_pose(int piece, const Pose& world_from_body) { world_.set_pose(piece, world_from_body); }
  void set_velocity(int piece, const Vec3& linear, const Vec3& angular) { world_.set_velocity(piece, linear, angular); }

  const World& world() const { return world_; }
  std::int64_t steps() const { return steps_; }  // since begin()
  // So far: final up to its last sample. Until finish().
  const Track& track() const { return recorder_.track(); }

 private:
  struct Driven {
    Pose base;  // at the start
    RobotController controller;
    RobotSummary summary;
    Vec3 start, last, second_ago;
    std::vector<double> work;  // by joint, at the last step
  };
  void control();
  Diagnostic describe_lost(std::size_t robot) const;
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
  std::shared_ptr<const World::Snapshot> laid_world_;  // without robots; none: no restarts
  std::vector<Driven> robots_;
  TrackRecorder recorder_;
  std::int64_t steps_ = 0;
};

}  // namespace rubble
