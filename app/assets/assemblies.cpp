#include "app/assets/assemblies.h"

#include "kernel/base/hash.h"

namespace rubble {

AssemblyType make_assembly(const Asset& asset, const AssetLibrary& library) {
  AssemblyType assembly;
  assembly.name = asset.name;
  for (const AssetLink& link : asset.links) {
    assembly.links.push_back({library.find(link.asset).index, link.whole_from_link, link.scale});
    if (link.on >= 0) assembly.joints.push_back(link.joint);
  }
  return assembly;
}

std::string hash_content(const Asset& asset, const AssemblyType& assembly,
                         const AssetLibrary& library) {
  Sha256 hash;
  const auto add_pose = [&hash](const Pose& pose) {
    const Quat& q = pose.rotation;
    const Vec3& p = pose.translation;
    for (const double number : {q.w, q.x, q.y, q.z, p.x, p.y, p.z}) hash.add(&number, sizeof number);
  };
  for (std::size_t i = 0; i < assembly.links.size(); ++i) {
    const AssemblyLink& link = assembly.links[i];
    const std::string& piece = library.contents.at(std::size_t(link.type)).sha256;
    hash.add(piece.data(), piece.size());
    add_pose(link.assembly_from_link);
    hash.add(&link.scale, sizeof link.scale);
    const double on = asset.links[i].on;
    hash.add(&on, sizeof on);
  }
  for (const JointType& j : assembly.joints) {
    add_pose(j.assembly_from_joint);
    for (const double number :
         {double(j.kind), j.stiffness, j.damping, j.friction, j.yield, j.break_force, j.break_torque, j.lower,
          j.upper, double(j.collide)}) {
      hash.add(&number, sizeof number);
    }
  }
  return hash.hex();
}

}  // namespace rubble
