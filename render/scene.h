// What the renderer draws, as plain data. It knows nothing of physics.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kernel/base/math.h"
#include "kernel/base/mesh.h"

namespace rubble {

enum class LightType { directional, spot, point };

// The main light. Its beam leaves along the X axis of its frame.
struct LightSpec {
  LightType type = LightType::directional;
  // directional: illuminance on a facing surface, in klx (clear sun: 100); spot and point: luminous
  // intensity in kcd. range: 0 to 1000
  double intensity = 60;
  Vec3 rpy_deg{0, 50, 35};  // roll, pitch (positive: down), yaw; unit: degree
  Vec3 position{0, 0, 20};  // of spot and point lights; unit: m
  double cone_deg = 60;     // full angle of a spot; range: 1 to 170
};

// A lamp carried by the camera, just beside the lens.
struct LampSpec {
  bool on = true;
  double intensity_cd = 120;       // on the axis; range: 0 to 100000
  double cone_deg = 90;            // full angle where it has fallen to half; range: 5 to 170
  Vec3 position{0.02, 0.0, 0.05};  // in the camera body frame; unit: m
};

// Homogeneous fog: transmittance exp(-density * distance).
struct AirSpec {
  double fog_density = 0;    // extinction; unit: 1/m; range: 0 to 10
  double fog_intensity = 1;  // albedo-like brightness of the fog; range: 0 to 1
};

struct SceneMesh {
  std::vector<TriangleMesh> levels;  // finest first; at least one
};

struct SceneInstance {
  std::uint32_t mesh = 0;  // index into meshes
  float scale = 1;
  Pose world_from_body;
  std::uint32_t id = 0;  // piece number, for labels
};

struct Scene {
  std::vector<std::shared_ptr<const SceneMesh>> meshes;
  std::vector<SceneInstance> instances;
  bool ground = true;  // the plane z = 0
  LightSpec light;
  LampSpec lamp;
  AirSpec air;
  std::uint64_t seed = 0;  // varies looks from piece to piece, never geometry
};

}  // namespace rubble
