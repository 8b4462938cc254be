// A triangle mesh as plain data: what assets are made of, what is drawn and what is exported.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

// Which axis of a file points up. y: turned by +90 degrees about X when read, so that (x, y, z)
// becomes (x, -z, y), as glTF needs.
enum class UpAxis { y, z };

// Triangles are counter-clockwise seen from outside. Lengths in metres, frame Z up.
struct TriangleMesh {
  std::vector<Vec3f> positions;                         // of the vertices; unit: m
  std::vector<Vec3f> normals;                           // one per position, unit length; empty: flat shading
  std::vector<std::array<std::uint32_t, 3>> triangles;  // indices into the positions
  std::vector<std::uint8_t> surfaces;                   // one per triangle, an index into surface_names
  std::vector<std::string> surface_names;               // looks, e.g. "concrete_cast", "concrete_fracture"

  Aabb bounds() const;
};

// Volume properties of a closed mesh at density 1 (so mass = volume), by the divergence theorem.
struct VolumeProperties {
  double volume = 0;    // unit: m3; negative when the triangles face inwards
  Vec3 centre_of_mass;  // unit: m
  Mat3 inertia;         // about the centre of mass; unit: m5 (times density: kg m2)
};
VolumeProperties calc_volume_properties(const TriangleMesh& mesh);

// True when every edge, after welding equal positions, is used once in each direction.
bool is_closed(const TriangleMesh& mesh);

}  // namespace rubble
