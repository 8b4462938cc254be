#include "app/navigate_ros1/robot_kind.h"

namespace rubble {

const std::vector<RobotKindOfNavigator>& known_robots() {
  static const std::vector<RobotKindOfNavigator> kinds{
      {"crawler", {{0.2, 0.46, 0.33}, {0.3, 0.57, 0.33}}, 0.36, 0.4},
      {"rover", {{0.5, 0.26, 0.25}}, 0.3, 0.4},
  };
  return kinds;
}

}  // namespace rubble
