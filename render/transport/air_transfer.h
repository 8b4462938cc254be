// Light that the air scatters any number of times, on the points of a grid: the equation of radiative transfer by
// discrete ordinates and source iteration (Chandrasekhar 1960; Lewis and Miller 1984). Along each link of a point,
// what lies at its end arrives weakened, and the air on the way adds what it scattered in the iteration before.
#pragma once

#include <vector>

#include "kernel/base/parallel.h"
#include "render/lighting/radiance_grid.h"
#include "render/media/air_links.h"

namespace rubble {

class AirTransfer {
 public:
  typedef float Four __attribute__((vector_size(16)));
  struct Colour {
    Four c{};  // red, green, blue, and another number or 0
  };
  struct Sources {
    const Vec3f* sky = nullptr;         // radiance by direction of the links; none: black
    const Colour* surfaces = nullptr;   // radiance of each bake point, matt
    std::vector<RadianceTerms> direct;  // of each point: beams that arrive there
    // Where it is known which places of the links they reach, these scatter them, and not the points: a beam is narrower
    // than a cell. Of each light, what would arrive at each point if nothing stood in its way but air; and the share of the
    // stretch of air about each place that it reaches, as AirLinks::seen. Empty: the points scatter `direct`.
    std::vector<std::vector<RadianceTerms>> beams;
    const std::vector<std::vector<float>>* reached = nullptr;
    // Of each point, the mean radiance under which surfaces have that radiance; empty: what arrives without
    // scattering. Where more arrives, they reflect more.
    std::vector<Vec3f> usual;
    // On either side of a wall the light of one side stands for both: the darker, so that no daylight glows in a
    // void; of a lamp the brighter, which is where its camera is.
    bool brighter = false;
    double tolerance = 0.003;  // change of all light by which it ends
    int most = 60;             // iterations
  };
  struct Result {
    std::vector<RadianceTerms> ends, air;  // what arrives from surfaces and sky, and from the air
    // Of each point, whose light stands for it where nobody knows which corners a place sees.
    std::vector<std::uint32_t> stand_in;

    AirGrid::Corners shown(AirGrid::Corners corners) const;  // with what stands for each
  };

  explicit AirTransfer(AirLinks links);
  const AirLinks& links() const { return links_; }
  Result solve(const AirMatter& air, const Sources& sources, ThreadPool& pool);

 private:
  static constexpr std::size_t kTerms = 9;  // of spherical harmonics, to the second order
  using Terms = std::array<Colour, kTerms>;

  std::vector<std::uint32_t> choose_sides(bool brighter) const;
  void find_lit(const Sources& sources, const std::vector<RadianceTerms>& ends);
  void gather_total(const Sources& sources, ThreadPool& pool);
  void find_response(const std::vector<Vec3f>& usual);
  void sweep(const AirMatter& air, const Sources& sources, bool scatters, ThreadPool& pool);
  // By the air at each point against a direction: all light but beams of which that is known, and these.
  struct Emitted {
    std::vector<Colour> light;
    std::vector<std::vector<Colour>> beams;
  };
  void emit(const AirMatter& air, const Sources& sources, std::size_t direction, Emitted& out) const;
  void follow(const AirMatter& air, const Sources& sources, std::size_t direction, const Emitted* emitted);
  Colour between(const std::vector<Colour>& grid, const Vec3f& at, std::uint8_t seen, std::size_t otherwise, bool in_stops) const;
  void project(const std::vector<Colour>& incoming, std::vector<RadianceTerms>& out, ThreadPool& pool) const;

  AirLinks links_;
  std::vector<Harmonics> harmonics_;       // of each direction
  std::vector<Colour> ends_in_, air_in_;   // by direction, then by point: what arrives
  std::vector<Terms> total_;               // what arrived last
  std::vector<Colour> response_;           // of surfaces near each point
  std::vector<std::uint8_t> lit_;          // of each point: outside all pieces, and not dark
};

}  // namespace rubble
