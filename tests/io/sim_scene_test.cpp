// Scenes for simulators: a free wedge, a door on a fixed frame, a chain by balls, a bundled robot, terrain and a camera, as
// MuJoCo, Gazebo's parser and our own reader of URDF find them.
#include "io/scenes/sim_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#if __has_include(<mujoco/mujoco.h>)
#include <mujoco/mujoco.h>
#endif
#if __has_include(<sdf/sdf.hh>)
#include <sdf/sdf.hh>
#endif

#include "io/mesh/mesh_file.h"
#include "io/robot/urdf_reader.h"
#include "io/scenes/surface_heights.h"
#include "kernel/base/portable_math.h"
#include "scripting/robots/rover.h"
#include "kernel/robot/parts.h"
#include "tests/io/all_recorders.h"
#include "tests/io/small_scene.h"
#include "tests/io/support.h"

namespace rubble {
namespace sim_scene_test {

using test::ScratchFolder;

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

class SimScenes : public ::testing::Test {
 protected:
  SimScenes() {
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

  std::string write(const std::string& format) {
    export_pile(model_, format, folder_.path());
    return folder_ / format;
  }
  double free_mass() const {
    double mass = 0;
    for (const SimModel& m : model_.sim.models)
      for (std::size_t i = 0; i < m.links.size(); ++i)
        if (!m.fixed || i > 0) mass += m.links[i].mass;
    return mass;
  }

  TriangleMesh slab_ = make_box_mesh({1, 2, 0.2}), spike_ = [] {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {0.3f, 0, 0}, {0, 0.3f, 0}, {0, 0, 0.6f}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    mesh.surfaces = {0, 0, 0, 0};
    mesh.surface_names = {"rebar"};
    return mesh;
  }();
  ExportModel model_;
  ScratchFolder folder_;
};

TEST_F(SimScenes, PrincipalInertiaOfATurnedBox) {
  const Quat turn = portable::quat_from_rpy(0.4, -1.1, 2.5);
  const Mat3 r = turn.matrix();
  const Mat3 inertia = r * Mat3::diagonal({1, 3, 7}) * r.transposed();
  const PrincipalInertia found = calc_principal_inertia(inertia);
  const Mat3 axes = found.link_from_principal.matrix();
  const Mat3 again = axes * Mat3::diagonal(found.moments) * axes.transposed();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(again.rows[i][j], inertia.rows[i][j], 1e-12);
  double sorted[3] = {found.moments.x, found.moments.y, found.moments.z};
  std::sort(sorted, sorted + 3);
  EXPECT_NEAR(sorted[0], 1, 1e-12);
  EXPECT_NEAR(sorted[2], 7, 1e-12);
}

TEST_F(SimScenes, BoxesAreFoundAndNothingElseIs) {
  const Pose pose{portable::quat_from_rpy(0.4, -1.1, 2.5), {1, 2, 3}};
  std::vector<Vec3> corners;
  for (const Vec3& p : make_box({0.4, 2, 6}).points) corners.push_back(pose * p);
  const auto box = find_box(calc_hull(corners));
  ASSERT_TRUE(box);
  EXPECT_NEAR(box->size.x * box->size.y * box->size.z, 0.4 * 2 * 6, 1e-9);
  EXPECT_LT(distance(box->shape_from_box.translation, pose.translation), 1e-9);
  for (const Vec3& corner : corners) {
    const Vec3 in_box = box->shape_from_box.inverse() * corner;
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(std::abs(in_box[i]), 0.5 * box->size[i], 1e-9);
  }
  corners[0] += Vec3{0.01, 0, 0};
  EXPECT_FALSE(find_box(calc_hull(corners))) << "a corner is 1 cm away";
  EXPECT_FALSE(find_box(model_.sim.shapes[1].hulls[0])) << "a tetrahedron";
}

// A part of a bundled girder, of which two merged faces share three corners: their fans would have a triangle twice.
TEST_F(SimScenes, ConvexPartsAreClosedAndConvex) {
  const Hull part = calc_hull({{-1.49918, 0.09673, 0.11858}, {-1.49918, 0.10937, 0.1199},   {-0.90048, 0.08921, 0.17706},
                               {-0.90048, -0.10798, 0.15645}, {-0.96182, -0.10586, 0.15059}, {-1.49918, -0.08817, 0.14374},
                               {-0.90048, -0.10812, 0.1632},  {-0.90048, 0.08906, 0.18381},  {-0.97961, 0.09162, 0.18123},
                               {-1.49918, -0.06952, 0.14569}, {-1.49918, -0.08778, 0.13312}, {-1.49918, 0.10909, 0.13161},
                               {-1.4336, 0.10691, 0.13787},   {-1.01809, -0.10399, 0.14877}, {-1.33622, -0.09365, 0.14903}});
  std::map<std::pair<int, int>, int> edges;
  double six = 0;
  for (const std::array<int, 3>& t : calc_hull_triangles(part)) {
    const auto at = [&](int i) { return part.points[std::size_t(t[std::size_t(i)])]; };
    for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
    const Vec3 normal = cross(at(1) - at(0), at(2) - at(0));
    six += dot(at(0), normal);
    for (const Vec3& p : part.points) EXPECT_LT(dot(normal, p - at(0)), 1e-5 * norm(normal)) << "a corner over a face";
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
  EXPECT_NEAR(six / 6, calc_volume(part), 1e-3 * calc_volume(part));
}

TEST_F(SimScenes, HeightsAreThoseOfTheSurface) {
  const SurfaceHeights heights = calc_surface_heights(model_.sim.surfaces, 0.1);
  ASSERT_EQ(heights.columns, 21);
  ASSERT_EQ(heights.rows, 41);
  EXPECT_NEAR(heights.low.x, 19, 1e-9);
  for (const float share : heights.shares) EXPECT_NEAR(heights.low.z + heights.range * double(share), 0.25, 1e-6);
  EXPECT_EQ(calc_surface_heights({}, 0.1).columns, 0);
}

// Its XML without what is newer than Debian's MuJoCo, which has no surfaces without volume either.
TEST_F(SimScenes, MujocoFindsMassesPosesJointsAndMotors) {
#if __has_include(<mujoco/mujoco.h>)
  const std::string folder = write("mjcf");
  std::string text = test::read_text(folder + "/pile.xml");
  EXPECT_EQ(text.find("vertex="), std::string::npos) << "Rapier reads meshes of files only";
  for (const char* newer : {" inertia=\"(shell|convex)\"", "<size memory=\"512M\"/>", " (resolution|sensorsize|focalpixel|principalpixel)=\"[^\"]*\""})
    text = std::regex_replace(text, std::regex(newer), "");
  text = std::regex_replace(text, std::regex("implicitfast"), "implicit");
  std::ofstream(folder + "/old.xml") << text;
  char error[1000] = "";
  mjModel* const model = mj_loadXML((folder + "/old.xml").c_str(), nullptr, error, sizeof error);
  ASSERT_TRUE(model) << error;
  mjData* const data = mj_makeData(model);
  mj_forward(model, data);
  EXPECT_NEAR(model->opt.gravity[2], -3.7, 1e-12);
  double moving = 0;
  std::size_t found = 0;
  for (const SimModel& m : model_.sim.models) {
    for (const SimLink& link : m.links) {
      const std::string name = m.links.size() > 1 ? m.name + "/" + link.name : link.name;
      const int body = mj_name2id(model, mjOBJ_BODY, name.c_str());
      ASSERT_GE(body, 0) << name;
      ++found;
      EXPECT_LT(distance(Vec3(data->xpos[3 * body], data->xpos[3 * body + 1], data->xpos[3 * body + 2]), link.world_from_link.translation), 1e-9)
          << name;
      const Quat& q = link.world_from_link.rotation;
      const double* r = data->xquat + 4 * body;
      EXPECT_NEAR(std::abs(r[0] * q.w + r[1] * q.x + r[2] * q.y + r[3] * q.z), 1, 1e-9) << name;
      if (model->body_weldid[body] == 0) continue;
      moving += model->body_mass[body];
      EXPECT_NEAR(model->body_mass[body], link.mass, 1e-9 * link.mass) << name;
    }
  }
  EXPECT_EQ(found, 3u + 2 + 2 + 5);
  EXPECT_NEAR(moving, free_mass(), 1e-9 * moving);
  EXPECT_EQ(model->nq, 7 + 7 + 1 + (7 + 4) + (7 + 4)) << "two pieces, the door, the chain, the rover";
  EXPECT_EQ(model->nu, 4) << "the rover's wheels";
  EXPECT_EQ(model->ncam, 2);
  EXPECT_EQ(model->nhfield, 1);
  const int door = mj_name2id(model, mjOBJ_JOINT, "door/hold");
  EXPECT_NEAR(data->qpos[model->jnt_qposadr[door]], 0.7, 1e-12);
  EXPECT_NEAR(model->jnt_range[2 * door], -1, 1e-12);
  EXPECT_NEAR(model->qpos_spring[model->jnt_qposadr[door]], 0.25, 1e-12);
  // The kernel's convex parts: a box as a box.
  int boxes = 0, meshes = 0;
  for (int g = 0; g < model->ngeom; ++g)
    if (model->geom_contype[g] != 0) boxes += model->geom_type[g] == mjGEOM_BOX, meshes += model->geom_type[g] == mjGEOM_MESH;
  EXPECT_EQ(boxes, 1 + 4 + 1) << "slabs, and the rover's body";
  EXPECT_EQ(meshes, 2 + 4);
  // The camera of the rover looks forwards: MuJoCo's look along -Z.
  const int eye = mj_name2id(model, mjOBJ_CAMERA, "eye");
  EXPECT_NEAR(-data->cam_xmat[9 * eye + 2], std::cos(0.5), 1e-9);
  EXPECT_NEAR(-data->cam_xmat[9 * eye + 5], std::sin(0.5), 1e-9);
  EXPECT_NEAR(model->cam_fovy[eye], 2 * std::atan(240 / 320.0) * 180 / portable::kPi, 1e-9);
  mj_deleteData(data);
  mj_deleteModel(model);
#else
  GTEST_SKIP() << "there is no MuJoCo";
#endif
}

// MuJoCo counts the positions of both from those of the scene; a motor would hold the second joint where it is.
TEST_F(SimScenes, MimicsAreTiesInMujocoAndNotesElsewhere) {
  std::vector<SimJoint>& joints = model_.sim.models.back().joints;
  joints[0].position = 0.5;
  joints[1].position = 0.125, joints[1].mimics = 0, joints[1].multiplier = -1, joints[1].offset = 0.25;
  const std::string text = test::read_text(write("mjcf") + "/pile.xml");
  const std::string follower = "rover/" + joints[1].name;
  EXPECT_NE(text.find("<joint joint1=\"" + follower + "\" joint2=\"rover/" + joints[0].name + "\" polycoef=\"-0.375 -1 0 0 0\"/>"),
            std::string::npos);
  EXPECT_EQ(text.find("<general name=\"" + follower), std::string::npos);
  EXPECT_NE(text.find("<general name=\"rover/" + joints[0].name), std::string::npos);
  for (const auto& limits : {sdf_limits(model_.sim), usd_limits(model_.sim)})
    EXPECT_EQ(std::count(limits.begin(), limits.end(), "1 joint with `mimic`: each moves by itself"), 1);
}

// Edges of the picture by the lens: pixel (0, 0) has its centre at (0, 0).
TEST_F(SimScenes, LensesOffTheMiddleStaySo) {
  const std::string xml = test::read_text(write("mjcf") + "/pile.xml");
  for (const char* part : {" resolution=\"640 480\" sensorsize=\"", " focalpixel=\"320 400\" principalpixel=\"19.5 39.5\"/>"})
    EXPECT_NE(xml.find(part), std::string::npos) << part;
  const std::string usd = test::read_text(write("usd") + "/pile.usda");
  const std::string post = usd.substr(usd.find("def Camera \"post\""));
  const auto value = [&](const std::string& name) { return std::stod(post.substr(post.find(name + " = ") + name.size() + 3)); };
  const double focal = value("focalLength");
  EXPECT_NEAR((value("horizontalApertureOffset") + value("horizontalAperture") / 2) / focal, (639.5 - 300) / 320, 1e-9);
  EXPECT_NEAR((value("verticalApertureOffset") + value("verticalAperture") / 2) / focal, (200 + 0.5) / 400, 1e-9);
  EXPECT_NEAR((value("verticalApertureOffset") - value("verticalAperture") / 2) / focal, -(479.5 - 200) / 400, 1e-9);
}

TEST_F(SimScenes, GazebosParserFindsMassesJointsAndSensors) {
#if __has_include(<sdf/sdf.hh>)
  sdf::Root root;
  for (const sdf::Error& error : root.Load(write("sdf") + "/pile.sdf")) ADD_FAILURE() << error.Message();
  const sdf::World& world = *root.WorldByIndex(0);
  EXPECT_EQ(world.ModelCount(), 1u + 1 + 6 + 1) << "ground, hill, models, the camera on its post";
  double mass = 0;
  for (const SimModel& m : model_.sim.models) {
    const sdf::Model* model = world.ModelByName(m.name);
    ASSERT_TRUE(model) << m.name;
    EXPECT_EQ(model->Static(), m.fixed && m.links.size() == 1) << m.name;
    ASSERT_EQ(model->LinkCount(), m.links.size());
    for (std::size_t i = 0; i < m.links.size(); ++i)
      if (!m.fixed || i > 0) mass += model->LinkByIndex(i)->Inertial().MassMatrix().Mass();
  }
  EXPECT_NEAR(mass, free_mass(), 1e-9 * mass);
  const sdf::Model* door = world.ModelByName("door");
  const sdf::Joint* hold = door->JointByName("hold");
  ASSERT_TRUE(hold);
  EXPECT_EQ(hold->Type(), sdf::JointType::REVOLUTE);
  EXPECT_NEAR(hold->Axis()->Lower(), -1.7, 1e-12) << "0 is the pose of the file";
  EXPECT_NEAR(hold->Axis()->Upper(), 1.3, 1e-12);
  EXPECT_NEAR(hold->Axis()->SpringReference(), -0.45, 1e-12);
  EXPECT_TRUE(door->JointByName("fixed_root"));
  const sdf::Link* base = world.ModelByName("rover")->LinkByName("base_link");
  ASSERT_EQ(base->SensorCount(), 1u);
  EXPECT_NEAR(base->SensorByIndex(0)->CameraSensor()->HorizontalFov().Radian(), portable::kPi / 2, 1e-9);
  int controllers = 0;
  const sdf::ElementPtr rover = world.ModelByName("rover")->Element();
  for (sdf::ElementPtr at = rover->GetElement("plugin"); at; at = at->GetNextElement("plugin")) ++controllers;
  EXPECT_EQ(controllers, 4) << "one of each wheel";
#else
  GTEST_SKIP() << "this release has no SDFormat";
#endif
}

TEST_F(SimScenes, UrdfIsReadBackWithMassesAndPlaces) {
  const std::string folder = write("urdf");
  const UrdfFile fixed = read_urdf(folder + "/fixed.urdf");
  EXPECT_TRUE(fixed.fixed);
  EXPECT_EQ(fixed.links.size(), 1u + 1 + 1) << "world, the slab, the hill";
  const UrdfFile spike = read_urdf(folder + "/models/spike_000002.urdf");
  EXPECT_FALSE(spike.fixed);
  EXPECT_NEAR(spike.links[0].mass, model_.sim.models[2].links[0].mass, 1e-9);
  const UrdfFile door = read_urdf(folder + "/models/door.urdf");
  ASSERT_EQ(door.joints.size(), 1u);
  EXPECT_EQ(door.joints[0].kind, JointKind::hinge);
  // The leaf is where its link was, when its joint is at 0.7.
  const SimModel& m = model_.sim.models[3];
  const Pose turned{portable::quat_from_rpy(0, 0, 0.7), {}};
  const Pose leaf = m.links[0].world_from_link * door.joints[0].parent_from_child * turned;
  const Vec3 found = leaf * door.links[1].link_from_inertial.translation;
  EXPECT_LT(distance(found, m.links[1].world_from_link * m.links[1].centre_of_mass), 1e-9);
  EXPECT_EQ(read_urdf(folder + "/models/chain.urdf").joints.size(), 3u) << "a ball is three hinges";
  const UrdfFile rover = read_urdf(folder + "/robots/rover.urdf");
  double mass = 0;
  for (const UrdfLink& link : rover.links) mass += link.mass;
  EXPECT_NEAR(mass, make_rover({}).mass(), 1e-9);
  const auto scene = nlohmann::json::parse(test::read_text(folder + "/scene.json"));
  EXPECT_EQ(scene["models"][3]["file"], "models/door.urdf");
  EXPECT_EQ(scene["models"][3]["joints"][0]["position"], 0.7);
  EXPECT_EQ(scene["models"][0]["links"][0]["label"], "slab");
}

// What OpenUSD itself says of it is asked by tests/scenes/judge_engines.py.
TEST_F(SimScenes, UsdHasEachBodyWithItsMass) {
  const std::string text = test::read_text(write("usd") + "/pile.usda");
  EXPECT_EQ(text.compare(0, 10, "#usda 1.0\n"), 0);
  double mass = 0;
  const std::regex number("physics:mass = ([-+.0-9e]+)");
  for (auto at = std::sregex_iterator(text.begin(), text.end(), number); at != std::sregex_iterator(); ++at) mass += std::stod((*at)[1]);
  EXPECT_NEAR(mass, free_mass() + model_.sim.models[3].links[0].mass, 1e-6 * mass) << "and the frame of the door, which a joint holds";
  EXPECT_EQ(std::count(text.begin(), text.end(), '{'), std::count(text.begin(), text.end(), '}'));
  for (const char* part : {"def PhysicsRevoluteJoint \"hold\"", "def PhysicsSphericalJoint \"hold\"", "token[] semantics:labels:class = [\"slab\"]", "physics:approximation = \"convexHull\"", "def Camera \"eye\"",
                           "physics:approximation = \"none\""})
    EXPECT_NE(text.find(part), std::string::npos) << part;
  std::size_t articulations = 0;
  for (std::size_t at = text.find("RootAPI"); at != std::string::npos; at = text.find("RootAPI", at + 1)) ++articulations;
  EXPECT_EQ(articulations, 3u) << "the door, the chain and the rover: Newton refuses joints that belong to none";
}

// A picture of a mesh goes beside the scene, and its places into the mesh.
TEST_F(SimScenes, PicturesGoBesideTheScene) {
  SurfacePaint paint;
  paint.albedo.side = 2;
  paint.albedo.texels.assign(16, 200);
  slab_.surface_names = {"poster"};
  slab_.paints = {std::make_shared<const SurfacePaint>(paint)};
  slab_.paint_corners.assign(slab_.triangles.size(), {PaintCorner{0, 0, {1, 1, 1}}, {1, 0, {1, 1, 1}}, {0.5f, 1, {1, 1, 1}}});
  for (const MeshFormat& format : mesh_formats()) {
    if (!format.is_folder) continue;
    const std::string folder = write(format.name);
    EXPECT_TRUE(std::filesystem::exists(folder + "/meshes/poster.png")) << format.name;
    const std::string all = test::read_tree(folder);
    for (const char* part : {"poster.png"}) EXPECT_NE(all.find(part), std::string::npos) << format.name;
    EXPECT_NE(all.find(format.name == "usd" ? "(0.5, 1)" : "vt 0.5 1\n"), std::string::npos) << format.name;
  }
}

// A surface of that name without a picture has a material of its own.
TEST_F(SimScenes, PicturesOfGlbHavePlaces) {
  SurfacePaint paint;
  paint.albedo.side = 2;
  paint.albedo.texels.assign(16, 200);
  slab_.surface_names = {"rebar"};  // as that of the spikes
  slab_.paints = {std::make_shared<const SurfacePaint>(paint)};
  slab_.paint_corners.assign(slab_.triangles.size(), {PaintCorner{0, 0, {1, 1, 1}}, {1, 0, {1, 1, 1}}, {0.5f, 1, {1, 1, 1}}});
  export_pile(model_, "glb", folder_.path());
  const std::string bytes = test::read_text(folder_ / "pile.glb");
  std::uint32_t size = 0;
  std::memcpy(&size, bytes.data() + 12, 4);
  const auto document = nlohmann::json::parse(bytes.substr(20, size));
  int pictured = 0, plain = 0;
  for (const auto& mesh : document["meshes"])
    for (const auto& primitive : mesh["primitives"]) {
      const auto& look = document["materials"][primitive["material"].get<std::size_t>()]["pbrMetallicRoughness"];
      const bool picture = look.contains("baseColorTexture");
      EXPECT_EQ(picture, primitive["attributes"].contains("TEXCOORD_0")) << mesh["name"];
      ++(picture ? pictured : plain);
    }
  EXPECT_EQ(pictured, 1);
  EXPECT_EQ(plain, 1);
}

TEST_F(SimScenes, EachFormatSaysWhatItCannotHold) {
  const auto holds = [](const std::vector<std::string>& said, const char* part) {
    return std::any_of(said.begin(), said.end(), [&](const std::string& s) { return s.find(part) != std::string::npos; });
  };
  EXPECT_TRUE(holds(mjcf_limits(model_.sim), "height field"));
  EXPECT_TRUE(holds(mjcf_limits(model_.sim), "1 joint of the kind ball"));
  EXPECT_TRUE(holds(urdf_limits(model_.sim), "three hinges"));
  EXPECT_TRUE(holds(usd_limits(model_.sim), "dry friction"));
  model_.sim.models.clear(), model_.sim.surfaces.clear(), model_.sim.cameras.clear();
  for (const MeshFormat& format : mesh_formats())
    EXPECT_TRUE(!format.limits || format.limits(model_.sim).empty()) << format.name;
}

// Readers that split corners by their normals, such as trimesh, find closed meshes all the same.
TEST_F(SimScenes, CornersOfFlatMeshesAreShared) {
  for (const char* format : {"sdf", "urdf"}) {
    const std::string text = test::read_text(write(format) + "/meshes/slab.obj");
    EXPECT_EQ(text.find("vn "), std::string::npos);
    std::size_t corners = 0;
    for (std::size_t at = text.find("\nv "); at != std::string::npos; at = text.find("\nv ", at + 1)) ++corners;
    EXPECT_EQ(corners, 8u);
  }
}

// `rubble export --force` removes what it knows; what else is there is somebody's, and refuses the export.
TEST_F(SimScenes, TheNextExportKnowsEveryFileAndFolder) {
  for (const bool empty : {false, true}) {
    if (empty) model_.sim = {};
    ScratchFolder folder;
    for (const MeshFormat& format : mesh_formats()) {
      if (!format.is_folder) continue;
      export_pile(model_, format.name, folder.path());
      const std::string whole = folder / format.name;
      for (const auto& entry : std::filesystem::recursive_directory_iterator(whole)) {
        const std::string name = std::filesystem::relative(entry.path(), whole).string();
        if (entry.is_directory())
          EXPECT_FALSE(std::filesystem::is_empty(entry.path())) << format.name << ": " << name;
        else
          EXPECT_TRUE(is_scene_file(name)) << format.name << ": " << name;
      }
    }
  }
}

}  // namespace sim_scene_test
}  // namespace rubble
