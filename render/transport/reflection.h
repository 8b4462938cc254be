// How a point of a surface reflects: a matt base under up to two layers that mirror roughly, the gloss
// of the material and a film of water.
//
//   f = sum of layers c F(h) D(h) G(o, i) / (4 cos_o cos_i)
//       + base (1 - E(o)) (1 - E(i)) / (pi (1 - E_mean))
// D and G are those of Trowbridge and Reitz with Smith's shadowing, heights correlated (Walter et al.
// 2007, Heitz 2014), F is Schlick's, c how much of the point the layer covers, and E(o) the share of
// light from o that the layers mirror, tabled. What they do not mirror reaches the base, in both
// directions (Kelemen and Szirmay-Kalos 2001), so that a white base gives exactly all light back: no
// energy is made or lost at any roughness.
#pragma once

#include "kernel/base/math.h"
#include "render/transport/sample_sequence.h"

namespace rubble {

struct MirrorLayer {
  float cover = 0;      // share of the point that it covers; 0: there is no such layer; range: 0 to 1
  float reflectance = 0;  // at normal incidence; range: 0 to 1
  float roughness = 1;    // alpha of the distribution; range: 0.02 to 1
};

struct Reflection {
  Vec3f base;               // albedo of the matt part; range: 0 to 1
  MirrorLayer gloss, film;  // below, and of water above

  bool matt() const { return gloss.cover <= 0 && film.cover <= 0; }
};

// Directions in a frame whose Z axis is the normal, both away from the surface.
Vec3f reflect_share(const Reflection& r, const Vec3f& out, const Vec3f& in);  // f cos_i; unit: 1/sr
// Density with which sample_reflection() finds `in`; unit: 1/sr
float reflection_density(const Reflection& r, const Vec3f& out, const Vec3f& in);

struct ReflectedSample {
  Vec3f in;           // where the light comes from, unit length, as above
  Vec3f weight;       // reflect_share / density
  float density = 0;  // 0: nothing was found
};
// choice: which part; in [0, 1).
ReflectedSample sample_reflection(const Reflection& r, const Vec3f& out, SamplePair u, float choice);

// Share of light from a direction of this cosine that a layer mirrors: the integral of its f cos_i,
// times its cover.
float mirrored_share(const MirrorLayer& layer, float cosine);
// Albedo for light from all around, layers and base.
Vec3f mean_albedo(const Reflection& r);

}  // namespace rubble
