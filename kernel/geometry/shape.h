// Piece types compiled for collision: convex parts with faces and edges about the centre of mass,
// and mass properties at density 1. Immutable, shared by all pieces of a type; a piece's uniform
// scale is applied to the turned corners.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "kernel/base/math.h"
#include "kernel/base/mesh.h"
#include "kernel/geometry/triangle_mesh_shape.h"
#include "kernel/model/pile.h"

namespace rubble {

// A convex polyhedron; coordinates in metres from the centre of mass of the whole piece, scale 1.
struct ConvexShape {
  struct Face {
    Vec3f normal;                   // unit length, outwards
    std::uint16_t first = 0, count = 0;  // corners: loops[first .. first + count)
  };
  struct Edge {
    std::uint16_t a = 0, b = 0;                   // corners
    std::uint16_t left_face = 0, right_face = 0;  // the faces that it joins
  };
  std::vector<Vec3f> corners;  // of the hull, from the piece's centre of mass; unit: m
  std::vector<Face> faces;
  std::vector<std::uint16_t> loops;  // counter-clockwise seen from outside
  std::vector<Edge> edges;
  float radius = 0;  // of the sphere about the piece's centre of mass; unit: m
};

struct Shape {
  std::vector<ConvexShape> parts;
  std::shared_ptr<const TriangleMeshShape> surface;  // instead of parts
  VolumeProperties volume;  // at scale 1 and density 1, centre in the frame of the type
  float radius = 0;         // of the sphere about the centre of mass; unit: m
  Vec3f reach;              // largest |x|, |y|, |z| of any corner from there; unit: m
};

// Corners of a part at most: they are numbered in 16 bits, and contact takes longer with each.
inline constexpr std::size_t kMostPartCorners = 1000;

// Throws InputError, with `key` as the path of the type, when a part does not span a volume, when
// the volume is not positive or a material figure is out of range.
Shape compile_shape(const PieceType& type, const std::string& key);

// Volume, centre and inertia of one convex part at density 1.
VolumeProperties calc_volume_properties(const ConvexPart& part);

}  // namespace rubble
