// Rain and snow: how many drops or flakes of which size are in the air, how fast they fall, and what they take
// from light. Closed forms of the rate alone.
//
// Sizes are exponential in the diameter D of the drop, or of the drop that a flake melts to:
//   N(D) = n0 exp(-slope D) in 1/(m3 mm), D in mm, rate R in mm/h of water
//   rain: n0 = 8000, slope = 4.1 R^-0.21 (Marshall and Palmer 1948)
//   snow: n0 = 3800 R^-0.87, slope = 2.55 R^-0.48 (Gunn and Marshall 1958)
// Terminal speed in m/s:
//   rain: 9.65 - 10.3 exp(-0.6 D) (Atlas, Srivastava and Sekhon 1973)
//   snow: 1.6 (D / 10)^0.3, dendrites (Langleben 1954)
// A flake's density is 0.17 / d g/cm3, d its own diameter in mm (Holroyd 1971), so d = sqrt(D^3 / 0.17).
//
// Both are far larger than wavelengths: a drop takes the light that falls on its disc. As much again is diffracted,
// but by less than a tenth of a degree, so that it stays in the pixel or the beam. Extinction is the sum of
// the discs: rain pi/4 n0 2/slope^3, snow pi/4 n0/0.17 6/slope^4, times 1e-6; unit: 1/m.
#pragma once

namespace rubble {

enum class PrecipitationKind { rain, snow };

class Precipitation {
 public:
  // Mean cosine of the angle by which drops turn light; our choice. Spheres of water, without what is diffracted,
  // have 0.7 to 0.8.
  static constexpr double kAsymmetry = 0.75;

  // rate: of water; unit: mm/h; range: above 0
  Precipitation(PrecipitationKind kind, double rate);

  PrecipitationKind kind() const { return kind_; }
  // Drops with D from `low` to `high` in a cubic metre, and one of their D, for `random` in [0, 1).
  double count(double low, double high) const;
  double draw(double low, double high, double random) const;
  double diameter(double melted) const;    // as seen; unit: mm
  double fall_speed(double melted) const;  // unit: m/s
  // Of drops with D from `low` to `high`; of all of them; unit: 1/m
  double extinction(double low, double high) const;
  double extinction() const { return all_; }

  // Cameras draw drops one by one where they are seen best: those with D from smallest() to largest(), up to
  // reach(D) metres away. The rest is a veil.
  double smallest() const;
  double largest() const;
  double reach(double melted) const;
  // Of the drops that are not drawn one by one at this distance; unit: 1/m
  double veil(double distance) const;

 private:
  double moment(double x) const;  // integral from 0 to x of D^2 or D^3, times the exponential

  PrecipitationKind kind_;
  double n0_, slope_, all_;
};

}  // namespace rubble
