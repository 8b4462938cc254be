#include "app/drive/robots/robot_wish.h"

#include <algorithm>
#include <cmath>

namespace rubble {
namespace {

constexpr double kTurn = 1;           // of a full axis; unit: rad/s
constexpr double kFlipperRate = 45;   // unit: degree/s
constexpr double kMostFlipper = 180;  // unit: degree
constexpr double kGaitRate = 4;       // of a snake's waves at full axis; unit: rad/s
constexpr double kSteering = 20;      // of a snake; unit: degree
constexpr double kCurvature = 1.5;    // of a vine; unit: 1/m
constexpr double kFlipperStart = 57.29577951308232;  // where a crawler's stand at the start; unit: degree

double within(double value, double most) { return std::clamp(value, -most, most); }

}  // namespace

RobotLeg make_leg(const RobotWish& wish, const RobotItem& robot, const RobotLeg& last, double time, double seconds) {
  RobotLeg leg = last;
  leg.t = time;
  leg.joints = wish.joints, leg.joint_names = wish.joint_names;
  leg.linear = within(wish.forward * wish.speed + wish.linear.x, 5);
  leg.angular = within(wish.yaw * kTurn + wish.angular.z, 10);
  // What steers without a rate of its own takes a rate as a share of a full axis.
  const double yaw = wish.yaw + wish.angular.z / kTurn, pitch = wish.pitch - wish.angular.y / kTurn;
  if (!robot.urdf.empty()) return leg;
  if (robot.model == RobotKind::crawler && robot.flippers) {
    if (leg.flippers_deg.empty()) leg.flippers_deg.assign(4, kFlipperStart);
    for (std::size_t i = 0; i < 4; ++i) {
      const double by = (i < 2 ? wish.pitch : wish.roll) * kFlipperRate * seconds;
      leg.flippers_deg[i] = within(leg.flippers_deg[i] + by, kMostFlipper);
    }
  }
  if (robot.model == RobotKind::snake) {
    const double forwards = within(wish.forward + (wish.speed > 0 ? wish.linear.x / wish.speed : 0), 1);
    const bool moves = std::abs(forwards) > 0.01;
    leg.rate = moves ? kGaitRate * forwards : 0;
    leg.phase = last.phase + (last.rate - leg.rate) * time;  // the waves go on from where they are
    leg.amplitude = 1;
    leg.steering_deg = kSteering * within(yaw, 1);
  }
  if (robot.model == RobotKind::vine) {
    leg.growth = within(leg.linear, 1);
    leg.curvature = kCurvature * within(yaw, 1);
    leg.curvature_up = kCurvature * within(pitch, 1);
  }
  return leg;
}

bool same_command(const RobotLeg& a, const RobotLeg& b) {
  return a.linear == b.linear && a.angular == b.angular && a.flippers_deg == b.flippers_deg && a.gait == b.gait &&
         a.rate == b.rate && a.phase == b.phase && a.amplitude == b.amplitude && a.steering_deg == b.steering_deg &&
         a.growth == b.growth && a.curvature == b.curvature && a.curvature_up == b.curvature_up &&
         a.joints == b.joints && a.joint_names == b.joint_names;
}

}  // namespace rubble
