// A surface's paint as glTF has it: images as PNG, and vertices of its own.
#pragma once

#include <string>
#include <vector>

#include "kernel/base/mesh.h"

namespace rubble {

// The bytes of PNG files; empty where the paint has no such image.
struct GlbImages {
  std::string base_colour, metallic_roughness, normal;
};
GlbImages make_glb_images(const SurfacePaint& paint);

// The corners of the triangles of one surface, each a vertex: two triangles may differ in them where they meet.
struct GlbCorners {
  std::vector<Vec3f> positions, normals, colours;  // in the mesh frame; normals of faces where the mesh has none
  std::vector<Vec3f> tangents;                     // unit, to the right in the images
  std::vector<float> handedness;                   // -1 where the images are mirrored, else 1
  std::vector<float> places;                       // u, v of each, v downwards
  bool coloured = false;                           // some colour is not white
};
GlbCorners make_glb_corners(const TriangleMesh& mesh, std::size_t surface);

}  // namespace rubble
