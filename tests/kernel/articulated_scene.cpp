#include "articulated_scene.h"

namespace rubble::testing {

AssemblyType make_chain(int count, double length, bool along_x, const JointType& joint) {
  AssemblyType chain;
  chain.name = "chain";
  chain.links.push_back({0, {}, 1});
  const Vec3 step = along_x ? Vec3{length, 0, 0} : Vec3{0, 0, -length};
  const Quat turn = along_x ? Quat{} : turned({0, 1, 0}, 1.5707963267948966);
  for (int i = 0; i < count; ++i) {
    chain.links.push_back({1, {turn, step * (i + 0.5)}, 1});
    JointType j = joint;
    j.parent = i;
    j.child = i + 1;
    j.assembly_from_joint = {kAboutY, step * double(i)};
    chain.joints.push_back(j);
  }
  return chain;
}

JointType joint_of(JointKind kind) {
  JointType joint;
  joint.kind = kind;
  return joint;
}

World make_world(const AssemblyType& assembly, double length, const WorldOptions& options,
                 double thickness) {
  return World({box_type("block", 0.1, 0.1, 0.1), box_type("bar", length, thickness, thickness)},
               options, {assembly});
}

NewPiece hung(const Vec3& position, const Quat& rotation) {
  return at(PieceKind::assembly(0), position, rotation, true);
}

double measure_period(World& world, int piece, double seconds) {
  double last = world.piece(piece).world_from_body.translation.x, first_time = 0, time = 0;
  int crossings = 0;
  while (world.time() < seconds) {
    world.step();
    const double x = world.piece(piece).world_from_body.translation.x;
    if (last < 0 && x >= 0) {
      time = world.time() - x / (x - last) / 60;
      if (crossings++ == 0) first_time = time;
    }
    last = x;
  }
  return (time - first_time) / (crossings - 1);
}

}  // namespace rubble::testing
