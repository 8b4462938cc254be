// MuJoCo as the judge of robots: the same links, hulls, joints and motors in its own equations of motion
// and its own contact solver.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kernel/model/robot.h"

namespace rubble::testing {

struct JudgeOptions {
  double step = 1.0 / 960;  // unit: s
  bool ground = true;
  double ground_friction = 0.5;
  bool fixed_base = false;  // the first link hangs in the world
  std::vector<std::pair<Vec3, Vec3>> boxes;  // fixed ones: centre, full edge lengths; unit: m
};

class MujocoJudge {
 public:
  MujocoJudge(const RobotModel& model, const Pose& world_from_base, const JudgeOptions& options = {});
  ~MujocoJudge();

  // As World::set_command; the servo's gains are the model's.
  void set_positions(const std::vector<double>& targets);
  void step();
  double time() const;
  Vec3 centre_of_mass() const;                // unit: m
  Vec3 link_origin(std::size_t link) const;   // unit: m
  int contacts() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rubble::testing
