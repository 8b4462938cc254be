// What hangs in the air: fog or smoke that thins with height and billows, and plumes of dust. One
// seeded medium for everything that looks through it, colour image and depth sensor alike.
//
// Extinction in 1/m at a point p and a time t:
//   (fog(p) + sum of the puffs of dust) * billows(p - wind t)
//   fog = density * exp(-max(z, 0) / height);  billows: a factor of mean 1, from noise of 3 octaves
//   a puff is a Gaussian ball of constant mass but for what settles:
//     extinction = density (r/s)^3 m exp(-|p - c|^2 / (2 s^2)),  s^2 = r^2 + 2 spread age,
//     c = start + wind age + throw * 0.5 s * (1 - exp(-age / 0.5 s)) - fall age,
//     m = 2^(-age / half_life) (1 - age / (5 half_life)) (1 - exp(-age / 0.2 s))
// Rain and snow add the same extinction everywhere (precipitation.h).
// Light that is scattered is turned by the phase function below, of fog, dust and drops by their own g.
// Each burst throws out kPuffs of them in directions of its own; bursts, places and directions
// follow from the seed and the number of the burst alone. Time zero is the start of the mission.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "kernel/base/math.h"
#include "render/media/precipitation.h"
#include "render/scene/scene.h"

namespace rubble {

// Henyey and Greenstein 1941, "Diffuse radiation in the galaxy": the share of scattered light that
// leaves per steradian at an angle to its way, for a mean cosine g; over all directions it is 1.
// cosine: 1 straight on, -1 straight back. unit: 1/sr
inline double phase_function(double g, double cosine) {
  const double base = 1 + g * g - 2 * g * cosine;
  return (1 - g * g) / (4 * 3.14159265358979324 * base * std::sqrt(base));
}

// The share of scattered light that goes on nearly straight, for a mean cosine g: it counts as not scattered at all,
// and what is left has the mean cosine g / (1 + g) (the delta-Eddington approximation, Joseph, Wiscombe and Weinman
// 1976). So beams reach as far as they do by light that was scattered forwards many times.
inline double forward_share(double g) { return g > 0 ? g * g : 0; }
inline double turned_cosine(double g) { return g > 0 ? g / (1 + g) : g; }

struct DustPuff {
  Vec3 centre;            // in the world; unit: m
  double deviation = 1;   // s above; unit: m
  double extinction = 0;  // in its middle; unit: 1/m

  double at(const Vec3& p) const;
  // Along a ray from `from` towards the unit vector `direction`, between two distances: closed.
  double optical_depth(const Vec3& from, const Vec3& direction, double near, double far) const;
};

// The medium at one instant.
class Air {
 public:
  double extinction(const Vec3& p) const;  // unit: 1/m
  // Integral of the extinction over `distance` m along the unit vector `direction`; the share of
  // light that passes is exp(-optical_depth). Closed form without billows; with them, sums over
  // steps of a sixth of the largest billow, up to 60 billows away, and the mean beyond.
  double optical_depth(const Vec3& from, const Vec3& direction, double distance) const;

  bool clear() const { return spec_.fog_density <= 0 && puffs_.empty() && falling_.empty(); }
  // The same everywhere: optical depth is extinction({}) times distance.
  bool homogeneous() const;
  double albedo() const { return spec_.fog_intensity; }
  // Light that is scattered at p by an angle of this cosine, per metre and steradian, as a share of
  // the light that comes: of fog, dust and drops, each by its own phase function; unit: 1/(m sr)
  double scattering(const Vec3& p, double cosine) const;
  double fog_density() const { return spec_.fog_density; }
  double fog_height() const { return spec_.fog_height; }
  double fog_asymmetry() const { return spec_.fog_asymmetry; }
  double dust_asymmetry() const { return spec_.dust.asymmetry; }

  // The parts that extinction is made of.
  double fog(const Vec3& p) const;
  double fog_depth(const Vec3& from, const Vec3& direction, double distance) const;
  // What beams lose, when what is scattered nearly straight on counts as not scattered: of extinction by what has this
  // mean cosine; and along a ray by fog and drops, without billows and puffs.
  double turned_share(double g) const { return 1 - albedo() * forward_share(g); }
  double turned_depth(const Vec3& from, const Vec3& direction, double distance) const {
    return fog_depth(from, direction, distance) * turned_share(fog_asymmetry()) +
           drops_ * distance * turned_share(Precipitation::kAsymmetry);
  }
  double billows(const Vec3& p) const;
  // What these are made of: strength as AirSpec::fog_noise; noise: kNoiseSide^3 values, null where the strength is 0.
  struct Billows {
    double strength, size;
    Vec3 drift;
    const float* noise;
  };
  Billows billow_noise() const { return {spec_.fog_noise, spec_.fog_noise_size, drift_, noise_ ? noise_->data() : nullptr}; }
  const std::vector<DustPuff>& puffs() const { return puffs_; }
  const std::vector<Precipitation>& falling() const { return falling_; }
  double drops() const { return drops_; }  // extinction of all that falls; unit: 1/m

 private:
  friend class Medium;
  AirSpec spec_;
  Vec3 drift_;  // of the billows so far
  std::vector<DustPuff> puffs_;
  std::vector<Precipitation> falling_;
  double drops_ = 0;
  std::shared_ptr<const std::vector<float>> noise_;  // kNoiseSide^3 values from -1 to 1
};

// The air along a ray: what Air says there, to the last bit, and sooner where it is asked at many places. Puffs that the
// ray does not meet are left out.
class AirOnRay {
 public:
  struct Sample {
    double extinction = 0, scattering = 0;  // as of Air
  };
  // direction: unit length; near, far: between which it is asked; unit: m. The air must outlive it.
  AirOnRay(const Air& air, const Vec3& from, const Vec3& direction, double near, double far);
  // cosine: as Air::scattering()
  Sample at(double distance, double cosine) const;

 private:
  // A puff that is not nought between two distances.
  struct Met {
    const DustPuff* puff;
    double first, last;
  };

  const Air& air_;
  Vec3 from_, direction_;
  std::vector<Met> met_;  // in their order: sums are the same
};

class Medium {
 public:
  static constexpr int kPuffs = 7;       // a burst
  static constexpr int kNoiseSide = 32;  // of the repeated block of noise

  Medium() : Medium(AirSpec{}, 0) {}
  Medium(const AirSpec& spec, std::uint64_t seed);

  bool clear() const { return spec_.fog_density <= 0 && !has_dust() && falling_.empty(); }  // at all times
  bool homogeneous() const;                                             // at all times
  Air at(double seconds) const;
  const std::vector<Precipitation>& falling() const { return falling_; }
  const Vec3& wind() const { return spec_.wind; }

  // When burst number `burst` (0, 1, ...) happens; unit: s.
  double burst_time(std::uint64_t burst) const;

 private:
  bool has_dust() const { return spec_.dust.period > 0 && spec_.dust.density > 0; }
  void add_burst(std::uint64_t burst, double seconds, std::vector<DustPuff>& puffs) const;

  AirSpec spec_;
  std::uint64_t seed_;
  std::vector<Precipitation> falling_;
  std::shared_ptr<const std::vector<float>> noise_;
};

}  // namespace rubble
