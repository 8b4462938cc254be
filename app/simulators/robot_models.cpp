#include "app/simulators/build_sim_scene.h"

#include <algorithm>

#include "kernel/robot/parts.h"
#include "scripting/trajectory/trajectory.h"

namespace rubble {
namespace {

SimLink make_link(const RobotModel& robot, std::size_t index, const std::string& name, const Pose& world_from_link, SimScene& scene) {
  const RobotLink& from = robot.links[index];
  SimLink link;
  link.name = from.name, link.label = "robot";
  link.world_from_link = world_from_link;
  link.mass = from.mass, link.centre_of_mass = from.centre_of_mass, link.inertia = from.inertia;
  if (from.parts.empty() && from.looks.triangles.empty()) return link;
  SimPart part;
  part.friction = from.friction;
  const auto mesh = std::make_shared<const TriangleMesh>(make_link_mesh(from, choose_link_surface(robot, index)));
  scene.kept.push_back(mesh);
  part.mesh = int(scene.meshes.size());
  scene.meshes.push_back({name + "_" + from.name, mesh.get()});
  if (!from.parts.empty()) {
    part.shape = int(scene.shapes.size());
    SimShape shape{name + "_" + from.name, {}};
    for (const ConvexPart& p : from.parts) shape.hulls.push_back(calc_hull(p.points));
    scene.shapes.push_back(std::move(shape));
  }
  link.parts = {part};
  return link;
}

// Wheels are driven by speed, other motors as their gains ask for.
SimDrive choose_drive(const RobotModel& robot, int index) {
  const RobotMotor& motor = robot.joints[std::size_t(index)].motor;
  const auto drives = [&](const std::vector<int>& side) { return !robot.sides.belts && std::count(side.begin(), side.end(), index) > 0; };
  if (motor.effort <= 0) return SimDrive::none;
  if (motor.damping > 0 && (drives(robot.sides.left) || drives(robot.sides.right))) return SimDrive::velocity;
  return motor.stiffness > 0 ? SimDrive::position : motor.damping > 0 ? SimDrive::velocity : SimDrive::torque;
}

SimJoint make_joint(const RobotModel& robot, int index) {
  const RobotJoint& from = robot.joints[std::size_t(index)];
  SimJoint joint;
  joint.name = from.name;
  joint.parent = from.parent, joint.child = from.child;
  joint.kind = from.kind;
  joint.parent_from_joint = from.parent_from_child;
  joint.axis = from.axis;
  joint.position = from.start;
  joint.lower = from.lower, joint.upper = from.upper;
  joint.damping = from.damping, joint.friction = from.friction;
  joint.drive = choose_drive(robot, index);
  joint.effort = from.motor.effort, joint.speed = from.motor.speed;
  joint.drive_stiffness = from.motor.stiffness, joint.drive_damping = from.motor.damping;
  for (const MimicJoint& mimic : robot.mimics)
    if (mimic.joint == index) joint.mimics = mimic.of, joint.multiplier = mimic.multiplier, joint.offset = mimic.offset;
  return joint;
}

int find_robot(const SimScene& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.models.size(); ++i)
    if (scene.models[i].robot && scene.models[i].name == name) return int(i);
  return -1;
}

// Where the flight begins; nothing where that is in a void, which is not known before the flight is planned.
std::optional<Pose> find_start(const TrajectorySpec& trajectory) {
  if (trajectory.waypoints.empty()) return std::nullopt;
  const Waypoint& first = trajectory.waypoints.front();
  if (first.position_in_void || first.look_at_in_void) return std::nullopt;
  TrajectorySpec stands;
  stands.waypoints = {first};
  return CameraPath(stands).at(0);
}

}  // namespace

void add_robots(const Scenario& scenario, const std::vector<MissionRobot>& robots, SimScene& scene, std::vector<std::string>& notes) {
  const std::vector<std::string> names = robot_names(scenario.robots);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const RobotModel& robot = robots[i].model;
    if (robot.tube) {
      notes.push_back("robot " + names[i] + " is left out: no simulator has a tube that grows from its tip");
      continue;
    }
    SimModel model;
    model.name = names[i];
    model.fixed = robot.fixed_base;
    model.robot = std::make_shared<const RobotModel>(robot);
    const Pose world_from_base = calc_base_pose(scenario.robots[i], robots[i]);
    const std::vector<Pose> base_from_links = calc_base_from_links(robot);
    std::size_t belts = 0;
    for (std::size_t k = 0; k < robot.links.size(); ++k) {
      model.links.push_back(make_link(robot, k, names[i], world_from_base * base_from_links[k], scene));
      belts += norm(robot.links[k].belt_axis) > 0 ? 1 : 0;
    }
    for (std::size_t k = 0; k < robot.joints.size(); ++k) model.joints.push_back(make_joint(robot, int(k)));
    if (belts > 0)
      notes.push_back("robot " + names[i] + ": the belts of " + std::to_string(belts) +
                      " links stand still, since no format has surfaces that move; its motors at joints are kept");
    scene.models.push_back(std::move(model));
  }
}

void add_cameras(const Scenario& scenario, const std::vector<MissionRobot>& robots, SimScene& scene, std::vector<std::string>& notes) {
  const std::vector<std::string> names = robot_names(scenario.robots);
  for (const MountedCamera& mounted : scenario.cameras) {
    SimCamera camera;
    camera.name = mounted.name;
    const Intrinsics k = mounted.camera.intrinsics();
    camera.width = mounted.camera.width, camera.height = mounted.camera.height;
    camera.fx = k.fx, camera.fy = k.fy, camera.cx = k.cx, camera.cy = k.cy;
    if (mounted.camera.lens.model != LensKind::pinhole)
      notes.push_back("camera " + mounted.name + ": its lens is written as a pinhole of the same focal length");
    const Ride& rig = scenario.trajectory.ride;
    const Carrier& carrier = mounted.ride.on() ? mounted.ride : static_cast<const Carrier&>(rig);
    camera.carrier_from_camera = mounted.rig_from_camera();
    if (!mounted.ride.on() && rig.on()) camera.carrier_from_camera = rig.link_from_rig() * camera.carrier_from_camera;
    if (carrier.on()) {
      const std::size_t at = std::size_t(std::find(names.begin(), names.end(), carrier.robot) - names.begin());
      camera.model = find_robot(scene, carrier.robot);
      if (camera.model < 0 || at >= robots.size()) {
        notes.push_back("camera " + mounted.name + " is left out with the robot that carries it");
        continue;
      }
      const RiddenLink ridden = find_link(robots[at], carrier.link, "trajectory.ride");
      camera.link = int(ridden.link);
      camera.carrier_from_camera = ridden.link_from_rider * camera.carrier_from_camera;
    } else if (const auto start = find_start(scenario.trajectory)) {
      camera.carrier_from_camera = *start * camera.carrier_from_camera;
    } else {
      notes.push_back("camera " + mounted.name + " is left out: its flight begins in a void, which is found after the pile has settled");
      continue;
    }
    scene.cameras.push_back(camera);
  }
}

}  // namespace rubble
