// Robots that grow: tubes whose next link is laid where the tip has just come from. What has been laid
// never slides along; the tree gets a link more, and the tip's slider starts anew at its end. Retraction is
// the inverse: the tip turns the wall back in, bends straighten by as much as they were bent there, and the
// link that it has passed is taken out of the tree. Not for use outside kernel/.
#pragma once

#include "kernel/world/phases/trees.h"
#include "kernel/world/state/pairs.h"

namespace rubble {

class Tubes {
 public:
  Tubes(WorldTypes& types, WorldData& data, Bodies& bodies, Pairs& pairs, WorldTrees& trees,
        SimbodyTrees& simbody)
      : types_(types), data_(data), bodies_(bodies), pairs_(pairs), trees_(trees), simbody_(simbody) {}

  // Takes the tree of all links of the last robot; keeps those of the start, and stows the others.
  Tree plant(const Tree& all, const EvertingTube& tube);
  // Last in a step.
  void grow();
  // Links that have not grown go along, folded up where the next one will be laid.
  void carry_stowed(const WorldRobot& robot, const RobotModel& model);
  // What the tip can push with now, and how far it may be pushed back. The reel pulls no harder than that.
  void set_tip(const WorldRobot& robot, const RobotModel& model);

 private:
  static void stow(Body& body);
  void steer_tip(WorldRobot& robot, const EvertingTube& tube);
  void wind_back(WorldRobot& robot, const EvertingTube& tube);
  void lay_link(WorldRobot& robot, const RobotModel& model, const Tree& grown);
  void take_link(WorldRobot& robot, const RobotModel& model, const Tree& grown);

  WorldTypes& types_;
  WorldData& data_;
  Bodies& bodies_;
  Pairs& pairs_;
  WorldTrees& trees_;
  SimbodyTrees& simbody_;
};

// How long a tube is, beyond its base; unit: m.
double calc_tube_length(const WorldRobot& robot, const RobotModel& model);

}  // namespace rubble
