// A scene as it is drawn: prepared meshes, and where they stand.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "render/geometry/prepared_mesh.h"
#include "render/geometry/untouched_memory.h"
#include "render/materials/paint_layers.h"
#include "render/scene/frame.h"
#include "render/scene/scene.h"

namespace rubble {

// A placed mesh. Number 0 is the ground where the scene has one.
struct PlacedMesh {
  std::uint32_t mesh = 0;                    // index into the prepared meshes
  double scale = 1;                          // of the mesh; range: above 0
  Pose world_from_mesh;                      // unit: m
  Vec3f centre;                              // of its bounding sphere, in the world
  float radius = 0;                          // of that sphere; unit: m
  std::uint32_t id = 0;                      // piece number
  std::uint16_t label = 0;                   // class, as in the stream `label`
  std::uint32_t first_flag = 0;              // of its finest level's clusters, in per-cluster tables
  std::uint32_t first_light = 0;             // of its nodes, in the table of baked light
  // Varies the look: where in the textures it begins; below the tone, whether it is cut from a body, where, and
  // the axis of its grain. See find_surface in shaders/surface.glsl.
  std::array<std::uint32_t, 2> look_seed{};
  bool moves = false;                        // its pose is that of the present moment, see MovingPieces
  bool there = true;                         // false: what moves is not there at the present moment
  bool surrounds = false;                    // of the surroundings, see SceneInstance
};

inline constexpr std::uint32_t kGroundId = kGroundInstance;

// Plain data: all prepared meshes and where they stand.
struct PreparedScene {
  std::vector<PreparedMesh> meshes;  // each once
  std::vector<PlacedMesh> placed;    // pieces, and the ground where there is one
  std::shared_ptr<const PaintLayers> paints;  // of all meshes; null where nothing is painted
  std::string paint_key;                      // another text for other paints
  std::size_t cluster_flags = 0;     // clusters of the finest level over all placed meshes
  std::size_t light_nodes = 0;       // entries of the table of baked light
  Aabb bounds;  // of all pieces, without the ground and surroundings, wherever they move
  bool surrounded = false;           // some of it is of the surroundings
  bool glass = false;                // some of it is of glass
  std::uint64_t moment = 0;          // another number whenever anything has moved
};
PreparedScene prepare_scene(const Scene& scene, int threads);
// What does not move, as a scene of its own, its placed meshes in the same order.
PreparedScene resting_part(const PreparedScene& scene);

// Light that reaches a node, without the direct part of the main light and the lamp. Zero bytes: none.
struct BakedLight {
  // Illuminance on a surface of normal n: dot(n, vector), as three half floats; then the share of
  // red and of blue, 0 to 255 for 0 to 1 times the sum of the three colours.
  std::uint16_t x = 0, y = 0, z = 0;
  std::uint8_t red = 0, blue = 0;  // see above; 85: a third, grey
};

// One a light node of a scene. Much of it is never lit, and takes no memory.
using LightTable = UntouchedTable<BakedLight>;

// Of consecutive light nodes of a scene.
struct LightRange {
  std::size_t begin, end;
};

}  // namespace rubble
