// A triangle mesh as plain data, for assets, drawing and export.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

// Which axis of a file points up. y: turned by +90 degrees about X when read, so that (x, y, z)
// becomes (x, -z, y), as glTF needs.
enum class UpAxis { y, z };

// A square of texels in rows from the top, 4 bytes each. side 0: there is none.
struct PaintImage {
  int side = 0;  // a power of two; unit: texel
  std::vector<std::uint8_t> texels;
};

// Colours of a surface from the file of a mesh: the supported part of glTF's metal-rough material (glTF 2.0,
// section 3.9). A surface without colours has the look of its name.
struct SurfacePaint {
  Vec3f colour{1, 1, 1};  // linear-light albedo; the image's and the corner's are multiplied by it
  float roughness = 1;    // the square root of alpha of the microfacets; the image's is multiplied by it
  float metalness = 0;    // multiplied in the same way; range: 0 to 1
  float reflectance = 0;  // of the non-metal share, at normal incidence; 0: matt
  PaintImage albedo;      // encoded as sRGB (IEC 61966-2-1); the fourth byte is unused
  PaintImage relief;      // X and Y of the normal, 0 to 255 for -1 to 1; roughness; metalness
  std::string sha256;     // of all its sources
};

// Of one corner of a triangle.
struct PaintCorner {
  float u = 0, v = 0;     // place in the images: (0, 0) lower left, (1, 1) upper right; they repeat
  Vec3f colour{1, 1, 1};  // linear-light, see SurfacePaint
};
PaintCorner between(const PaintCorner& a, const PaintCorner& b, float share);  // share: of b

// Triangles are counter-clockwise seen from outside. Lengths in metres, frame Z up.
struct TriangleMesh {
  std::vector<Vec3f> positions;                         // of the vertices; unit: m
  std::vector<Vec3f> normals;                           // one per position, unit length; empty: flat shading
  std::vector<std::array<std::uint32_t, 3>> triangles;  // indices into the positions
  std::vector<std::uint8_t> surfaces;                   // one per triangle, an index into surface_names
  std::vector<std::string> surface_names;               // looks, e.g. "concrete_cast", "concrete_fracture"
  std::vector<std::shared_ptr<const SurfacePaint>> paints;  // one per surface name, null: by its look; or empty
  std::vector<std::array<PaintCorner, 3>> paint_corners;    // one per triangle; empty where there is no paint

  const SurfacePaint* paint_of(std::size_t surface) const {
    return surface < paints.size() ? paints[surface].get() : nullptr;
  }
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
