// Light that arrives by way of the sky and other surfaces, found by ray casting (Embree).
//
// What all points of the scene throw back is found once. The light that a camera sees on a piece takes many more rays,
// and is found from that when the piece is first seen: it follows from the scene alone, whoever asks and when.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "kernel/base/system/disk_cache.h"
#include "render/geometry/scene_rays.h"
#include "render/lighting/lighting.h"

namespace rubble {

struct BakeOptions {
  int threads = 1;         // the result does not depend on it
  int rays = 512;          // a bake point at most, fewer where light is even; range: 8 to 1024
  int bounces = 5;         // between surfaces
  std::uint64_t seed = 0;  // of the directions of rays
};

// Light scattered in the air, on a grid over the pieces and a little around them.
struct AirLight {
  Vec3f origin, cell;                  // of grid point (0, 0, 0), and from point to point; unit: m
  std::array<std::int32_t, 3> size{};  // points along x, y and z
  // Of sky and surfaces, the mean over all directions; unit: kcd/m2; x runs fastest
  std::vector<Vec3f> radiance;
  // Of each light in turn, in grids like that: its illuminance where it arrives; unit: klx. Empty:
  // none arrives anywhere.
  std::vector<Vec3f> direct;

  // Between points, or of the border's nearest outside.
  Vec3f at(const Vec3f& point) const { return at(radiance.data(), point); }
  Vec3f nearest(const Vec3f& point) const;  // of the box of the grid

 private:
  Vec3f at(const Vec3f* grid, const Vec3f& point) const;
};

// Where a bake point is, in the world.
struct BakePlace {
  Vec3f position, normal;  // unit: m; unit length
};

// What the bake points see of each other, for light that is found later: a view of a bake, which must outlive it. Points
// are those of the placed meshes in turn.
class BakeLinks {
 public:
  // Instead of a point: a ray that meets no surface, the inside of one, and one that does not count.
  static constexpr std::uint32_t kSky = 0xffffffffu, kInside = 0xfffffffeu, kNone = 0xfffffffdu;
  static constexpr std::uint32_t kClosed = 0x80000000u;  // added to the number of a point that lies inside a piece

  // hits: `count` of each point, cosine-weighted; stand_ins: of points inside a piece an open one nearby, else kNone.
  BakeLinks(std::size_t count, const std::vector<std::uint32_t>& hits, const std::vector<std::uint32_t>& stand_ins,
            const std::vector<BakePlace>& of_places, const std::vector<Vec3f>& of_points)
      : places(of_places), albedos(of_points), per_point(count), hits_(hits), stand_ins_(stand_ins) {}

  const std::vector<BakePlace>& places;  // of each point
  const std::vector<Vec3f>& albedos;     // likewise
  const std::size_t per_point;

  // All of them, as they are kept.
  const std::vector<std::uint32_t>& hits() const { return hits_; }
  const std::vector<std::uint32_t>& stand_ins() const { return stand_ins_; }
  // That many links, for sender().
  const std::uint32_t* of(std::size_t point) const {
    const std::uint32_t stand_in = stand_ins_[point];
    return hits_.data() + (stand_in == kNone ? point : stand_in) * per_point;
  }
  // The open point that light comes from; kSky: none does; kNone: the link does not count.
  std::uint32_t sender(std::uint32_t link) const {
    if (link < kClosed || link == kNone) return link;
    if (link > kNone) return kSky;
    const std::uint32_t stand_in = stand_ins_[link - kClosed];
    return stand_in == kNone ? kSky : stand_in;
  }

 private:
  const std::vector<std::uint32_t>&hits_, &stand_ins_;
};

// Albedo for light from all around of a place on a triangle (weights of its second and third corner), the
// mean over some centimetres. Called from several threads.
using AlbedoAt = std::function<Vec3f(const RayScene::Triangle& triangle, float u, float v)>;

class Baker;

class LightBake {
 public:
  // Casts the rays of the solution, unless the cache has it. All but the albedo must outlive this. rays: of that scene, in
  // which nothing moves. surfaces: what the albedos follow from besides the scene, as a hash. progress: called with the
  // done fraction, on the calling thread; may be empty.
  LightBake(const PreparedScene& scene, SceneRays& rays, const LightSet& light, const AlbedoAt& albedo,
            const BakeOptions& options, const DiskCache& cache = DiskCache(), const std::string& surfaces = {},
            const std::function<void(double)>& progress = {});
  ~LightBake();  // keeps what it found in the cache

  // Finds the light of those placed meshes whose light is not known yet. Returns them, in order. pieces: in any order,
  // some perhaps more than once.
  std::vector<std::uint32_t> light_pieces(const std::vector<std::uint32_t>& pieces);
  std::vector<std::uint32_t> light_all();
  bool knows(std::uint32_t piece) const { return known_[piece]; }
  bool knows_all() const { return known_count_ == known_.size(); }
  // One a node of each placed mesh, in the order of first_light; nothing where it is not known yet.
  const LightTable& nodes() const { return nodes_; }
  // Of the same light; found when it is first asked for.
  const AirLight& air();
  BakeLinks links() const;  // valid as long as this
  // Of each bake point by that light, matt; unit: kcd/m2.
  const std::vector<Vec3f>& radiance() const;

 private:
  bool restore_solution();
  void keep_solution() const;
  void restore_pieces();
  void keep_pieces() const;
  std::size_t node_count(std::uint32_t piece) const;

  const PreparedScene& scene_;
  SceneRays& rays_;
  const LightSet& light_;
  BakeOptions options_;
  DiskCache cache_;
  std::string key_;
  std::unique_ptr<Baker> baker_;
  LightTable nodes_;
  std::vector<std::uint8_t> known_;                       // of each placed mesh
  std::size_t known_count_ = 0, kept_count_ = 0;          // of these; of them in the cache
  std::unique_ptr<AirLight> air_;
};

// Every node and all air as if nothing stood around: the sky alone.
struct OpenSkyLight {
  LightTable nodes;
  AirLight air;
};
OpenSkyLight open_sky_light(const PreparedScene& scene, const LightSet& light);

// Of everything that a bake follows from, as a key of the cache.
std::string bake_key(const PreparedScene& scene, const LightSet& light, const std::string& surfaces,
                     const BakeOptions& options);

}  // namespace rubble
