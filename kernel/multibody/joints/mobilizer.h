// Input for the mobilizer of a joint in a Simbody system. Only for kernel/multibody.
#pragma once

#ifndef RUBBLE_WITHOUT_SIMBODY
#include <Simbody.h>

namespace rubble {

struct MobilizerPlace {
  SimTK::MobilizedBody parent;
  SimTK::Transform in_parent, in_link;  // the joint's frames
  SimTK::Body::Rigid body;
  SimTK::MobilizedBody made;  // out
};

}  // namespace rubble
#endif
