// What the renderer draws, as plain data. It knows nothing of physics.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "kernel/base/math.h"
#include "kernel/base/mesh.h"

namespace rubble {

// directional: a beam from very far away, of given strength; sun: one whose strength, colour and sky
// follow from where the sun stands.
enum class LightType { directional, spot, point, sun };

// A light of the place. A beam leaves along the X axis of its frame.
struct LightSpec {
  LightType type = LightType::directional;  // decides which members below count
  // directional: illuminance on a facing surface, in klx (clear sun: 100); spot and point: luminous
  // intensity in kcd. range: 0 to 1000
  double intensity = 60;
  Vec3 rpy_deg{0, 50, 35};   // roll, pitch (positive: down), yaw; not of the sun; unit: degree
  Vec3 position{0, 0, 20};   // of spot and point lights; unit: m
  double cone_deg = 60;      // full angle of a spot; range: 1 to 170
  double elevation_deg = 40;  // of the sun above the horizon; range: -18 (night) to 90
  double azimuth_deg = 215;   // of the sun, from X towards Y; unit: degree
};

// What the sky of LightType::sun looks like; formulas: sky/sky_model.h. clear is also that of the
// other types of light.
enum class SkyType {
  clear,
  hazy,       // a clear sky with fourteen times the haze: a visibility of 9 km
  cloudy,     // broken clouds over a clear sky
  overcast,   // the overcast sky of the CIE; the sun is hidden
  moonlit,    // a clear night: in the place of the sun stands the full moon
  city_night,  // the glow of a town on a moonless night; the sun is ignored
  cie_clear    // the standard clear sky of the CIE; the sun below the horizon: clear
};
struct SkySpec {
  SkyType type = SkyType::clear;
  double cloud_cover = 0.5;  // of cloudy: the share of the layer that is cloud; range: 0 to 1
};
inline constexpr std::size_t kMostLights = 4;

// A spot on a body, such as the headlamp of a robot. It lights surfaces, with shadows; what they reflect and what
// hangs in the air is lit by it in path-traced pictures alone.
struct CarriedLight {
  std::uint32_t instance = 0;  // that bears it: index into Scene::instances
  Pose body_from_light;        // the beam leaves along X; unit: m
  double intensity_cd = 100;   // on its axis; range: 0 to 100000
  double cone_deg = 70;        // full angle; range: 1 to 170
};

enum class LampShape { point, ring, cluster };

// A lamp carried by the camera, just beside the lens.
struct LampSpec {
  bool on = true;                  // false: unlit
  double intensity_cd = 120;       // on the axis; range: 0 to 100000
  double cone_deg = 90;            // full angle where it has fallen to half; range: 5 to 170
  Vec3 position{0.02, 0.0, 0.05};  // of its middle, in the camera body frame; unit: m
  // Light-emitting diodes in a ring or all over a disc facing forward, of this diameter.
  LampShape shape = LampShape::point;
  double size = 0.08;  // unit: m; range: 0 to 1
};

// Dust that bursts out now and then, as when debris shifts: see Medium.
struct DustSpec {
  double period = 0;        // mean time between bursts; 0: none; unit: s; range: 0 to 3600
  double irregularity = 1;  // how far a burst may be off its beat, in periods; range: 0 to 1
  Vec3 position{0, 0, 1};   // bursts start in the box around this point ...
  Vec3 bounds{4, 4, 1};     // ... of these full edge lengths; unit: m
  double density = 3;       // extinction in the middle of a fresh plume; unit: 1/m; range: 0 to 100
  double radius = 0.3;      // of a fresh plume; unit: m; range: 0.01 to 10
  double speed = 1.5;       // at which it is thrown out; unit: m/s; range: 0 to 50
  double spread = 0.03;     // turbulent diffusivity; unit: m2/s; range: 0 to 10
  double fall = 0.04;       // speed at which it settles; unit: m/s; range: 0 to 10
  double half_life = 8;     // until half of it is gone from the air; unit: s; range: 0.1 to 3600
  // As AirSpec::fog_asymmetry; mineral dust has 0.7 to 0.8 (Hess, Koepke and Schult 1998, "Optical
  // properties of aerosols and clouds").
  double asymmetry = 0.75;
};

// Fog or smoke, dust, rain and snow. Extinction is what a metre takes away: transmittance exp(-extinction d).
struct AirSpec {
  double fog_density = 0;    // extinction at the ground; unit: 1/m; range: 0 to 10
  double fog_intensity = 1;  // share of the extinguished light that is scattered; range: 0 to 1
  // Mean cosine g of the angle by which light is turned when it is scattered: 0 evenly, near 1 almost
  // straight on. Smoke about 0.75, droplets of fog 0.85; range: -0.99 to 0.99
  double fog_asymmetry = 0.75;
  double fog_height = 0;      // scale height: density falls by e every so many metres; 0: it does not
  double fog_noise = 0;       // 0: even; 1: from nothing to double within fog_noise_size
  double fog_noise_size = 2;  // of the largest billows; unit: m; range: 0.05 to 100
  Vec3 wind;                  // carries billows, plumes, drops and flakes; unit: m/s
  // Of water that falls everywhere, also under roofs as far as its veil goes; formulas: media/precipitation.h
  double rain_mm_h = 0;  // unit: mm/h; range: 0 to 100
  double snow_mm_h = 0;  // unit: mm/h; range: 0 to 10
  DustSpec dust;              // bursts; none by default
};

struct SceneMesh {
  std::vector<TriangleMesh> levels;  // finest first; at least one
  // Of surroundings: about how far apart light is found on it; 0: as close as on a piece; unit: m
  double light_spacing = 0;
};

// How an instance's mesh was cut from a larger body. Instances of one body have one tone, and textures that
// run on from one to the next.
struct CutFrom {
  std::uint32_t body = 0;  // any number but 0; 0: it is a body of its own
  Vec3 origin;             // of the mesh frame in that of the body, whose axes are parallel to it; unit: m
  int grain = 0;           // axis along which grain and boards run: 0, 1 or 2 for X, Y or Z
};

struct SceneInstance {
  std::uint32_t mesh = 0;  // index into meshes
  float scale = 1;         // of the mesh; range: above 0
  Pose world_from_body;    // unit: m
  std::uint32_t id = 0;     // piece number
  std::uint16_t label = 2;  // class, as in the stream `label`; range: 2 and up
  // Of the surroundings: what is made to measure for the pile, such as its shadow map, does not grow with it.
  bool surrounds = false;
  CutFrom cut_from{};
};

// What moves, and where it is when. The rest of a scene stays where its instances say, and its light
// is baked; what moves is lit anew for every view, throws shadows where it is, and takes light from
// what rests.
struct SceneMotion {
  std::vector<std::uint32_t> moving;  // indices into Scene::instances, rising; empty: nothing moves
  // world_from_body of each of `moving` in turn at a stamp as ViewRays::stamp_ns; nothing: it is not
  // there. May be called in any order of stamps.
  std::function<std::vector<std::optional<Pose>>(std::int64_t stamp_ns)> poses_at;
  Aabb reach;  // of the origins of all that move, at all times; unit: m
};

struct Scene {
  std::vector<std::shared_ptr<const SceneMesh>> meshes;  // each once, by SceneInstance::mesh
  std::vector<SceneInstance> instances;                  // every piece that is drawn
  SceneMotion motion;                                    // of some of them
  bool ground = true;  // the plane z = 0
  LightSpec light;                     // the main one, which makes the sky
  SkySpec sky;                         // of a main light that is the sun
  std::vector<LightSpec> more_lights;  // at most kMostLights - 1
  std::vector<CarriedLight> carried_lights;  // at most so many that with more_lights they are kMostLights - 1
  // Lights far from what matters, such as distant street lamps: found with the baked light, so their shadows are
  // soft. Any number.
  std::vector<LightSpec> far_lights;
  LampSpec lamp;                       // on the camera
  double wetness = 0;  // of all surfaces: darker, and glossy where they face up; range: 0 to 1
  AirSpec air;         // fog, smoke, dust
  std::uint64_t seed = 0;     // varies looks from piece to piece, never geometry; and the air
  std::int64_t start_ns = 0;  // the stamp at which the air's time is zero
};

}  // namespace rubble
