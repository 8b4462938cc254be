// What a point of a surface is: its normals, how it reflects, what it emits.
#pragma once

#include <cstdint>
#include <vector>

#include "render/geometry/geometry.h"
#include "render/geometry/ground_map.h"
#include "render/geometry/ray_scene.h"
#include "render/materials/texture_stack.h"
#include "render/transport/reflection.h"

namespace rubble {

namespace scalar {
struct SurfaceLayers;
}

struct SurfacePoint {
  Vec3f position;         // unit: m
  Vec3f face_normal;      // of the triangle, unit
  Vec3f normal;           // with rounding and relief, unit
  Reflection reflection;  // in the frame of `normal`
  Vec3f emission;         // radiance, the same in all directions; unit: kcd/m2
  Vec3f glow;             // likewise, but it lights nothing: see SurfaceAppearance::glow
  Vec3f passed;           // share of light that goes straight through, of a sheet of glass; else 0
};

struct SurfaceQuery {
  RayScene::Triangle triangle;  // that the ray met
  float u = 0, v = 0;           // weights of its second and third corner
  Vec3f direction;              // of the ray that met it, unit
  float footprint = 0;          // width of what the ray stands for there; unit: m
};

class SurfaceModel {
 public:
  virtual ~SurfaceModel() = default;
  virtual void find(const SurfaceQuery& query, SurfacePoint& out) const = 0;
};

// Where a flat triangle is met: position and normals; it reflects nothing yet.
SurfacePoint find_flat_point(const PreparedScene& scene, const SurfaceQuery& query);

// The looks of SurfaceAppearance, by the formulas of shaders/surface_model.glsl.
class LookSurfaces : public SurfaceModel {
 public:
  // wetness: as in Scene. The scene must outlive it.
  LookSurfaces(const PreparedScene& scene, const std::vector<PatternImage>& patterns,
               const GroundMap& ground, double wetness);
  // Puts what moves where it is in the scene now.
  void follow();
  void find(const SurfaceQuery& query, SurfacePoint& out) const override;

 private:
  struct Placed {
    Vec3f axis_x, axis_y, axis_z;  // of the mesh, in the world, unit
    Vec3f origin;                  // unit: m
    float scale = 1, seed_u = 0, seed_v = 0, tint = 0, warm = 0;
    int turn = 0;   // axis of the mesh along which grain runs
    Vec3f in_body;  // of the body that it was cut from: where the mesh's origin lies; unit: m
  };
  struct Place;
  Placed place(const PlacedMesh& piece) const;
  void find_place(const SurfaceQuery& query, Place& place) const;
  void find_pattern(const SurfaceQuery& query, Place& place) const;
  void add_paint(const SurfaceQuery& query, const TrianglePaint& paint, const Place& place, SurfacePoint& out,
                 scalar::SurfaceLayers& layers) const;
  void read_ground(const Vec3f& world, float& debris, float& tone) const;

  const PreparedScene& scene_;
  TextureStack textures_;
  GroundMap ground_;
  float wetness_;
  std::vector<Placed> placed_;
};

}  // namespace rubble
