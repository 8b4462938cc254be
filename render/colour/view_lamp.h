// Where a view's lamp is.
#pragma once

#include "render/colour/frame_light.h"
#include "render/scene/scene.h"

namespace rubble {

// The lamp as what throws shadows on the image.
struct ContactLamp {
  bool on = false;   // false: no shadows of the lamp are looked for
  Vec3f place;       // in the optical frame; unit: m
  float radius = 0;  // unit: m
};

struct ViewLamp {
  Pose bearer;        // of the lamp, in the world
  Vec3 in_optical;    // its place in the optical frame; unit: m
  double offset = 0;  // from the eye; unit: m

  ContactLamp contact(bool on, const FrameLight& light) const {
    return {on, Vec3f(in_optical),
            light.lamp.shape == LampShape::point ? 0.004f : float(light.lamp.size / 2)};
  }
};

inline ViewLamp find_view_lamp(const ViewProjection& view, const Pose& world_from_camera,
                               const FrameLight& light) {
  const Pose* rig = light.world_from_rig;
  const Vec3 place = rig ? view.optical_from_world * (*rig * light.lamp.position)
                         : camera_from_optical.inverse() * light.lamp.position;
  return {rig ? *rig : world_from_camera, place, norm(rig ? place : light.lamp.position)};
}

}  // namespace rubble
