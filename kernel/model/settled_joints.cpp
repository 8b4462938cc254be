#include "kernel/model/settled_joints.h"

#include <cstdint>

#include "kernel/base/error.h"

namespace rubble {
namespace {

// Where each assembly of the pile has its pieces.
struct Instance {
  const AssemblyType* assembly = nullptr;
  int first = 0;
  double scale = 1;
};

// pieces: how many the pile has, with those of the building, which come after the placed ones.
std::vector<Instance> list_instances(const Pile& pile, const BuildingState& building, int& pieces) {
  std::vector<Instance> instances;
  pieces = 0;
  const auto add = [&](const std::vector<Placement>& placements) {
    for (const Placement& p : placements) {
      if (!p.kind.is_assembly) {
        ++pieces;
        continue;
      }
      const AssemblyType& assembly = pile.assemblies[std::size_t(p.kind.index)];
      instances.push_back({&assembly, pieces, p.scale});
      pieces += int(assembly.links.size());
    }
  };
  add(pile.placed);
  if (building.count > 0 && building.first != pieces) refuse_joints("another building");
  pieces += building.count;
  for (const Layer& layer : pile.layers) add(layer.pieces);
  return instances;
}

const JointType* find_type(const std::vector<Instance>& instances, const JointState& joint, double& scale) {
  for (const Instance& at : instances) {
    if (joint.parent < at.first || joint.parent >= at.first + int(at.assembly->links.size())) continue;
    scale = at.scale;
    for (const JointType& type : at.assembly->joints) {
      if (type.parent == joint.parent - at.first && type.child == joint.child - at.first) return &type;
    }
  }
  return nullptr;
}

}  // namespace

void refuse_joints(const std::string& what) {
  Diagnostic d;
  d.message = "the settled pile is not of this mission: " + what;
  d.hint = "settle it again";
  throw InputError(d);
}

std::vector<SettledJoint> list_settled_joints(const Pile& pile, const PileState& state) {
  int pieces = 0;
  const std::vector<Instance> instances = list_instances(pile, state.building, pieces);
  if (pieces != int(state.pieces.size())) {
    refuse_joints("it has " + std::to_string(state.pieces.size()) + " pieces, the mission " + std::to_string(pieces));
  }
  std::vector<std::uint8_t> hangs(state.pieces.size(), 0);
  std::vector<SettledJoint> joints;
  for (const JointState& joint : state.joints) {
    SettledJoint settled;
    settled.state = &joint;
    settled.type = find_type(instances, joint, settled.scale);
    settled.loop = hangs[std::size_t(joint.child)] || joint.parent >= joint.child;
    if (!settled.loop) hangs[std::size_t(joint.child)] = 1;
    joints.push_back(settled);
  }
  return joints;
}

}  // namespace rubble
