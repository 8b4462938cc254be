// Light's way through the air: what passes, where it is scattered, and which way it goes on.
//
// A camera's ray meets air as far as AirVolume::kFarthest. All other light meets it only within the
// box of the air that is baked (the pieces and 1.5 m around them): sun and sky reach that box
// undiminished, for fog without an end would leave no daylight at all.
#pragma once

#include "render/media/medium.h"
#include "render/transport/sample_sequence.h"

namespace rubble {

class AirPath {
 public:
  AirPath() = default;  // nothing hangs in it
  AirPath(const Air& air, const Aabb& box) : air_(air), box_(box), clear_(air.clear()) {}

  bool clear() const { return clear_; }
  float albedo() const { return float(air_.albedo()); }
  // The part of a way that lies in the box; false: none.
  bool clip(const Vec3f& from, const Vec3f& direction, float& near, float& far) const;
  // Share of light that passes between two distances along a ray.
  float passes(const Vec3f& from, const Vec3f& direction, float near, float far) const;
  // The same, of the part in the box alone.
  float passes_in_box(const Vec3f& from, const Vec3f& direction, float far) const;
  // Where the light of a ray is taken out between two distances: with the chance and at the places of
  // the exponential law. random: in [0, 1). False: it passes.
  bool find_event(const Vec3f& from, const Vec3f& direction, float near, float far, float random,
                  float& at) const;

  // What is scattered per metre and steradian by an angle of this cosine, of 1 that arrives.
  float scattering(const Vec3f& p, float cosine) const { return float(air_.scattering(Vec3(p), double(cosine))); }
  // Of what is scattered at p: the share per steradian at an angle of this cosine.
  float phase(const Vec3f& p, float cosine) const;
  Vec3f sample_phase(const Vec3f& p, const Vec3f& direction, SamplePair u, float choice) const;

 private:
  struct Shares {
    float fog = 1, drops = 0;  // of the extinction; the rest: dust
  };
  Shares shares(const Vec3f& p) const;

  Air air_;
  Aabb box_;
  bool clear_ = true;
};

}  // namespace rubble
