// The links and joints of a URDF file in the order of their tree.
#pragma once

#include <string>
#include <vector>

#include "io/robot/urdf_elements.h"
#include "io/robot/urdf_reader.h"

namespace rubble {

// A joint with the names of its links, before the tree is known.
struct UrdfNamedJoint {
  UrdfJoint joint;            // without parent and child
  std::string parent, child;  // names of links
  bool floating = false;
};

// Fills links, joints and `fixed` of the file: the root first, parents before children, siblings by the names of their
// joints, as liburdfdom and pinocchio order them. Throws InputError with every mistake: names that are there twice, ends
// of joints that are not there, loops, several roots, floating joints anywhere but below an empty root.
void order_urdf_tree(UrdfElements& elements, std::vector<UrdfLink> links, std::vector<UrdfNamedJoint> joints, UrdfFile& file);

}  // namespace rubble
