// The input of the renderer, as plain data. It contains no physics.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "kernel/base/math.h"
#include "kernel/base/mesh.h"

namespace rubble {

// directional: parallel light of given strength; sun: parallel light whose strength, colour and sky follow from the
// position of the sun.
enum class LightType { directional, spot, point, sun };

// A light of the scene. Its beam is along the X axis of its frame.
struct LightSpec {
  LightType type = LightType::directional;  // selects the members below
  // directional: illuminance on a facing surface, in klx (clear sun: 100); spot and point: luminous
  // intensity in kcd. range: 0 to 1000
  double intensity = 60;
  Vec3 rpy_deg{0, 50, 35};   // roll, pitch (positive: down), yaw; not of the sun; unit: degree
  Vec3 position{0, 0, 20};   // of spot and point lights; unit: m
  double cone_deg = 60;      // full angle of a spot; range: 1 to 170
  double elevation_deg = 40;  // of the sun above the horizon; range: -18 (night) to 90
  double azimuth_deg = 215;   // of the sun, from X towards Y; unit: degree
};

// The sky of LightType::sun; formulas: sky/sky_model.h. Other types of light have the sky `clear`.
enum class SkyType {
  clear,
  hazy,       // a clear sky with fourteen times the haze: a visibility of 9 km
  cloudy,     // broken clouds over a clear sky
  overcast,   // the overcast sky of the CIE; the sun is hidden
  moonlit,    // a clear night with the full moon in place of the sun
  city_night,  // the glow of a town on a moonless night; the sun is ignored
  cie_clear    // the standard clear sky of the CIE; the sun below the horizon: clear
};
struct SkySpec {
  SkyType type = SkyType::clear;
  double cloud_cover = 0.5;  // of cloudy: covered share of the layer; range: 0 to 1
};
inline constexpr std::size_t kMostLights = 4;

// A spot on a body, such as the headlamp of a robot. It lights surfaces, with shadows. Its reflected light and its
// light in air exist only in path-traced images.
struct CarriedLight {
  std::uint32_t instance = 0;  // carrier: index into Scene::instances
  Pose body_from_light;        // the beam is along X; unit: m
  double intensity_cd = 100;   // on its axis; range: 0 to 100000
  double cone_deg = 70;        // full angle; range: 1 to 170
};

enum class LampShape { point, ring, cluster };

// A lamp on the camera, beside the lens.
struct LampSpec {
  bool on = true;                  // false: unlit
  double intensity_cd = 120;       // on the axis; range: 0 to 100000
  double cone_deg = 90;            // full angle at half intensity; range: 5 to 170
  Vec3 position{0.02, 0.0, 0.05};  // of its middle, in the camera body frame; unit: m
  // Light-emitting diodes in a ring, or over a disc, that faces forward with the diameter `size`.
  LampShape shape = LampShape::point;
  double size = 0.08;  // unit: m; range: 0 to 1
};

// Repeated bursts of dust, as from shifting debris: see Medium.
struct DustSpec {
  double period = 0;        // mean time between bursts; 0: none; unit: s; range: 0 to 3600
  double irregularity = 1;  // largest deviation of a burst from its regular time, in periods; range: 0 to 1
  Vec3 position{0, 0, 1};   // bursts start in the box around this point ...
  Vec3 bounds{4, 4, 1};     // ... of these full edge lengths; unit: m
  double density = 3;       // extinction in the middle of a fresh plume; unit: 1/m; range: 0 to 100
  double radius = 0.3;      // of a fresh plume; unit: m; range: 0.01 to 10
  double speed = 1.5;       // initial speed; unit: m/s; range: 0 to 50
  double spread = 0.03;     // turbulent diffusivity; unit: m2/s; range: 0 to 10
  double fall = 0.04;       // settling speed; unit: m/s; range: 0 to 10
  double half_life = 8;     // time until half of the dust has left the air; unit: s; range: 0.1 to 3600
  // As AirSpec::fog_asymmetry; mineral dust has 0.7 to 0.8 (Hess, Koepke and Schult 1998, "Optical
  // properties of aerosols and clouds").
  double asymmetry = 0.75;
};

// Fog or smoke, dust, rain and snow. The transmittance of a distance d is exp(-extinction d).
struct AirSpec {
  double fog_density = 0;    // extinction at the ground; unit: 1/m; range: 0 to 10
  double fog_intensity = 1;  // share of the extinguished light that is scattered; range: 0 to 1
  // Mean cosine g of the scattering angle: 0 is isotropic, near 1 is almost straight on. Smoke has about 0.75, droplets
  // of fog 0.85; range: -0.99 to 0.99
  double fog_asymmetry = 0.75;
  double fog_height = 0;      // scale height: density falls by a factor e over it; 0: constant density; unit: m
  double fog_noise = 0;       // 0: uniform; 1: from zero to double within fog_noise_size
  double fog_noise_size = 2;  // of the largest billows; unit: m; range: 0.05 to 100
  Vec3 wind;                  // carries billows, plumes, drops and flakes; unit: m/s
  // Rate of water. The veil is everywhere, also under roofs; formulas: media/precipitation.h
  double rain_mm_h = 0;  // unit: mm/h; range: 0 to 100
  double snow_mm_h = 0;  // unit: mm/h; range: 0 to 10
  DustSpec dust;              // bursts; none by default
};

struct SceneMesh {
  std::vector<TriangleMesh> levels;  // finest first; at least one
  // Of surroundings: approximate distance between bake points; 0: as on a piece; unit: m
  double light_spacing = 0;
};

// Place of an instance's mesh in the larger body that it was cut from. Instances of one body have one tone and
// continuous textures.
struct CutFrom {
  std::uint32_t body = 0;  // number of the body; 0: it is a body of its own
  Vec3 origin;             // of the mesh frame in that of the body, whose axes are parallel to it; unit: m
  int grain = 0;           // axis along which grain and boards run: 0, 1 or 2 for X, Y or Z
};

struct SceneInstance {
  std::uint32_t mesh = 0;  // index into meshes
  float scale = 1;         // of the mesh; range: above 0
  Pose world_from_body;    // unit: m
  std::uint32_t id = 0;     // piece number
  std::uint16_t label = 2;  // class, as in the stream `label`; range: 2 and up
  // Part of the surroundings: the size of the pile's shadow map and the like does not depend on it.
  bool surrounds = false;
  CutFrom cut_from{};
};

// Moving instances and their poses over time. All other instances rest, and their light is baked. Moving instances are
// lit for each view, cast shadows, and reduce the light of resting ones.
struct SceneMotion {
  std::vector<std::uint32_t> moving;  // indices into Scene::instances, ascending; empty: nothing moves
  // world_from_body of each of `moving` at a stamp as ViewRays::stamp_ns; empty: the instance does not exist then. May
  // be called in any order of stamps.
  std::function<std::vector<std::optional<Pose>>(std::int64_t stamp_ns)> poses_at;
  Aabb reach;  // of the origins of all moving instances at all times; unit: m
  // Whether most of them never leave their world_from_body, as while nobody knows what will move: rays then meet those
  // that have not left it as what rests.
  bool may_rest = false;
};

struct Scene {
  std::vector<std::shared_ptr<const SceneMesh>> meshes;  // indexed by SceneInstance::mesh
  std::vector<SceneInstance> instances;                  // every visible piece
  SceneMotion motion;                                    // of some of them
  bool ground = true;  // the plane z = 0
  LightSpec light;                     // the main light, which also defines the sky
  SkySpec sky;                         // if the main light is the sun
  std::vector<LightSpec> more_lights;  // at most kMostLights - 1
  std::vector<CarriedLight> carried_lights;  // together with more_lights at most kMostLights - 1
  // Distant lights, such as street lamps: they are part of the baked light, so their shadows are soft. Any number.
  std::vector<LightSpec> far_lights;
  LampSpec lamp;                       // on the camera
  double wetness = 0;  // of all surfaces: darker, and glossy if they face up; range: 0 to 1
  AirSpec air;         // fog, smoke, dust
  std::uint64_t seed = 0;     // varies the looks of pieces and the air, never geometry
  std::optional<std::uint64_t> look_seed{};  // of the looks of pieces; not given: `seed`
  std::int64_t start_ns = 0;  // stamp of time zero of the air
};

}  // namespace rubble
