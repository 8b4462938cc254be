#include "tests/io/sim_scenes.h"

#include "kernel/base/portable_math.h"
#include "kernel/robot/parts.h"
#include "scripting/robots/rover.h"

namespace rubble {
namespace sim_scene_test {
namespace {

TriangleMesh make_box_mesh(const Vec3& size) {
  RobotLink link;
  link.parts = {make_box(size)};
  return make_link_mesh(link, "concrete_cast");
}

// Two pieces that hang together; x: the joint's position.
SimModel make_pair(const ExportModel& model, JointKind kind, double x, const Pose& world_from_parent) {
  SimModel pair;
  pair.name = kind == JointKind::ball ? "chain" : "door";
  SimJoint joint;
  joint.name = "hold";
  joint.kind = kind;
  joint.parent_from_joint = {portable::quat_from_rpy(0.1, 0.2, 0.3), {0.5, 0, 0}};
  joint.child_from_joint = {portable::quat_from_rpy(0, 0.4, 0), {-0.5, 0, 0}};
  joint.position = x;
  joint.lower = -1, joint.upper = 2;
  joint.stiffness = 3, joint.rest = 0.25, joint.damping = 4, joint.friction = 5;
  const Pose moved{portable::quat_from_rpy(0, 0, x), {}};
  for (int i = 0; i < 2; ++i) {
    SimLink link = model.sim.models[0].links[0];
    link.name = pair.name + (i == 0 ? "_frame" : "_leaf");
    link.world_from_link =
        i == 0 ? world_from_parent : world_from_parent * joint.parent_from_joint * moved * joint.child_from_joint.inverse();
    pair.links.push_back(link);
  }
  pair.joints = {joint};
  return pair;
}

SimModel make_robot(const std::string& name, const RobotModel& robot, const Pose& world_from_base, SimScene& scene) {
  SimModel model;
  model.name = name;
  model.robot = std::make_shared<const RobotModel>(robot);
  const std::vector<Pose> base_from_links = calc_base_from_links(robot);
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const RobotLink& from = robot.links[i];
    const auto mesh = std::make_shared<const TriangleMesh>(make_link_mesh(from, "steel"));
    scene.kept.push_back(mesh);
    SimLink link;
    link.name = from.name, link.label = "robot", link.world_from_link = world_from_base * base_from_links[i];
    link.mass = from.mass, link.centre_of_mass = from.centre_of_mass, link.inertia = from.inertia;
    SimPart part;
    part.mesh = int(scene.meshes.size()), part.shape = int(scene.shapes.size());
    scene.meshes.push_back({name + "_" + from.name, mesh.get()});
    scene.shapes.push_back({name + "_" + from.name, {}});
    for (const ConvexPart& p : from.parts) scene.shapes.back().hulls.push_back(calc_hull(p.points));
    link.parts = {part};
    model.links.push_back(link);
  }
  for (const RobotJoint& from : robot.joints) {
    SimJoint joint;
    joint.name = from.name, joint.parent = from.parent, joint.child = from.child, joint.kind = from.kind;
    joint.parent_from_joint = from.parent_from_child, joint.axis = from.axis;
    joint.drive = SimDrive::velocity, joint.effort = from.motor.effort, joint.speed = from.motor.speed;
    joint.drive_damping = from.motor.damping;
    model.joints.push_back(joint);
  }
  return model;
}

}  // namespace

SimScenes::SimScenes() : slab_(make_box_mesh({1, 2, 0.2})), spike_(test::make_flat_tetrahedron()) {
  PileModel pile;
  pile.types = {{"slab", &slab_}, {"spike", &spike_}};
  pile.pieces = {{0, "slab_000000", 1.5, {portable::quat_from_rpy(0.3, -0.7, 1.9), {1, 2, 3}}, 0},
                 {1, "spike_000001", 0.5, {portable::quat_from_rpy(-2.0, 0.4, 0.1), {-4, 0, 0.2}}, 1},
                 {1, "spike_000002", 2, {{}, {0, -5, 0}}, 2}};
  pile.gravity = 3.7;
  model_ = test::make_scene(pile, {1, 2});
  model_.sim.models.push_back(make_pair(model_, JointKind::hinge, 0.7, {portable::quat_from_rpy(0, 0, 1), {8, 0, 4}}));
  model_.sim.models.back().fixed = true;
  model_.sim.models.push_back(make_pair(model_, JointKind::ball, 0.2, {{}, {0, 8, 4}}));
  model_.sim.models.push_back(make_robot("rover", make_rover({}), {portable::quat_from_rpy(0, 0, 0.5), {2, -2, 0.1}}, model_.sim));
  SimSurface hill;
  hill.name = "hill";
  auto mesh = std::make_shared<TriangleMesh>(slab_);
  hill.mesh = mesh, hill.world_from_mesh.translation = {20, 0, 0.05}, hill.scale = 2;
  model_.sim.surfaces = {hill};
  SimCamera camera;
  camera.name = "eye", camera.model = 5, camera.link = 0, camera.carrier_from_camera.translation = {0.2, 0, 0.2};
  camera.width = 640, camera.height = 480, camera.fx = camera.fy = 320, camera.cx = 319.5, camera.cy = 239.5;
  model_.sim.cameras = {camera};
  camera.name = "post", camera.model = -1, camera.fy = 400, camera.cx = 300, camera.cy = 200;
  model_.sim.cameras.push_back(camera);
}

}  // namespace sim_scene_test
}  // namespace rubble
