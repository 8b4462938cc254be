// Vectors, rotations and rigid transforms as numbers of a StateHash, component by component: x, y, z;
// w, x, y, z; the rotation, then the translation.
#pragma once

#include "kernel/base/hash.h"
#include "kernel/base/math.h"

namespace rubble {

template <typename T>
void add(StateHash& hash, const Vec3T<T>& v) {
  hash.add(v.x), hash.add(v.y), hash.add(v.z);
}
inline void add(StateHash& hash, const Quat& q) {
  hash.add(q.w), hash.add(q.x), hash.add(q.y), hash.add(q.z);
}
inline void add(StateHash& hash, const Pose& pose) {
  add(hash, pose.rotation), add(hash, pose.translation);
}

}  // namespace rubble
