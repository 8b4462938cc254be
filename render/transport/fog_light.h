// How fog and smoke change the light of a scene: what the air scatters, on surfaces and towards cameras.
#pragma once

#include <cstdint>
#include <vector>

#include "render/device/device_lamp.h"
#include "render/lighting/bake.h"
#include "render/transport/air_transfer.h"
#include "render/transport/lamp_reach.h"

namespace rubble {

class FogLight {
 public:
  using Radiance = std::vector<AirTransfer::Colour>;  // of each bake point, matt; unit: kcd/m2

  // scene: what rests; rays: of what light does not pass through there, for the constructor only; light: of the scene;
  // radiance: of its bake points by that light in clear air. The pool must outlive it.
  FogLight(const PreparedScene& scene, const RayScene& rays, const Aabb& box, const LightSet& light, Radiance radiance,
           ThreadPool& pool);

  // Light of the place in this air, without its billows and puffs.
  void set_air(const Air& air);
  // Baked light of those placed meshes in that air. Nodes are those of `scene`, whatever moves there.
  void weaken(const PreparedScene& scene, const LightTable& clear, const std::vector<std::uint32_t>& pieces,
              LightTable& out);

  // Light of the lamp. radiance: of the bake points by it.
  void set_lamp(const LampReach& reach, const Radiance& radiance);
  void put_lamp_out();
  // Of a surface there by the light of the place, without direct sun, mean over all orientations; unit: klx
  float daylight(const Vec3f& point) const;
  // That the air throws on a surface, of the lamp's alone; unit: klx
  Vec3f lamp_illuminance(const Vec3f& point, const Vec3f& normal) const;

  // All that comes to points of the air but beams.
  const RadianceGrid& field() const { return field_; }
  LampAir air_of_device() const;  // for one that finds the lamp's light in the air itself; refers to this

 private:
  struct Place {       // of a bake point: where the air's light is asked for
    float off;         // its surface; unit: m
    std::uint8_t seen; // which of the corners about it
  };
  struct Change {  // of the baked light of a point
    Vec3f factor{1, 1, 1};
    Vec3f air;  // what the air throws on it; unit: klx
  };

  void find_lit(const RayScene& rays);
  void find_places(const PreparedScene& scene, const RayScene& rays);
  void find_reached(const RayScene& rays);
  void find_direct(const Air* air, AirTransfer::Sources& out) const;
  void find_open();
  float usual_off() const;  // from surfaces; unit: m
  Place place_of_mover(const Vec3f& surface, const Vec3f& normal) const;  // as what rests sees it
  Change change_at(const Vec3f& surface, const Vec3f& normal, const Place& place) const;
  void add_up();

  Aabb box_;
  LightSet light_;
  Radiance radiance_;
  ThreadPool& pool_;
  AirTransfer transfer_;
  Air air_;
  AirMatter matter_;
  std::uint64_t matter_version_ = 0;
  std::vector<Vec3f> sky_, usual_;              // by direction; mean radiance of each point in clear air
  std::vector<std::vector<float>> lit_;         // by each light: share of the air that each point stands for
  std::vector<std::vector<float>> reached_;     // by each light, as AirTransfer::Sources
  std::vector<RadianceTerms> clear_;            // in clear air
  std::vector<Place> places_;                   // of each bake point of what rests
  AirTransfer::Result day_, lamp_;              // lamp_: empty where it is out
  RadianceGrid field_;
};

}  // namespace rubble
