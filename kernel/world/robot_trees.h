// Robots as trees with motors and belts. Not for use outside kernel/.
#pragma once

#include <vector>

#include "kernel/world/tubes.h"

namespace rubble {

class RobotTrees {
 public:
  RobotTrees(WorldTypes& types, WorldData& data, const WorldSettings& settings, Pairs& pairs, Waking& waking,
              WorldTrees& trees, Tubes& tubes, const SimbodyTrees& simbody)
      : types_(types),
        data_(data),
        settings_(settings),
        pairs_(pairs),
        waking_(waking),
        trees_(trees),
        tubes_(tubes),
        simbody_(simbody) {}

  // As the functions of World::Robots with these names.
  int add(const RobotModel& model, const Pose& world_from_base);
  void set_command(int robot, const RobotCommand& command);
  RobotState state(int robot) const;
  std::vector<RobotContact> contacts(int robot) const;

 private:
  const TreeLink* find_link(const WorldRobot& robot, int link) const;
  bool is_of_robot(const Contact& contact, const WorldRobot& robot) const;
  void wake_neighbours(std::int32_t body);

  WorldTypes& types_;
  WorldData& data_;
  const WorldSettings& settings_;
  Pairs& pairs_;
  Waking& waking_;
  WorldTrees& trees_;
  Tubes& tubes_;
  const SimbodyTrees& simbody_;
};

}  // namespace rubble
