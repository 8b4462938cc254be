// Radiance in the air: at the points of a grid, by direction.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/lighting/harmonics.h"

namespace rubble {

struct AirGrid {
  Vec3f origin, cell;                  // of point (0, 0, 0), and from point to point; unit: m
  std::array<std::int32_t, 3> size{};  // points along x, y and z, at least 2; x runs fastest

  std::size_t count() const { return std::size_t(size[0]) * std::size_t(size[1]) * std::size_t(size[2]); }
  Vec3f point(std::size_t i) const;
  Vec3f nearest(const Vec3f& point) const;  // of the box of the grid
  Vec3f length() const;                     // of that box

  // The eight points about a place, or about the border's nearest, and their weights.
  struct Corners {
    std::array<std::uint32_t, 8> at;
    std::array<float, 8> weight;

    // Takes those that are seen alone, one bit each; as far as these weigh little, with what stands for the others.
    void keep(std::uint8_t seen, const std::vector<std::uint32_t>& stand_in);
  };
  Corners about(const Vec3f& point) const;
};

// Which of the corners about it a place sees, near enough: of the middle of the part of the cell in which it lies.
struct SeenCorners {
  int cuts = 1;  // of a cell along each axis
  // Of each part, one bit a corner; parts are counted along x, then y, then z in the cell, and cells by their lowest
  // corners. Empty: all see all.
  std::vector<std::uint8_t> seen;

  std::uint8_t at(const AirGrid& grid, const Vec3f& point) const;
};

// One function of direction, of each colour; unit: kcd/m2 times the norm of harmonics_of().
using RadianceTerms = std::array<Vec3f, kHarmonics>;

// What the mean between lights is multiplied by, so that it lies between them in stops: light falls by the same factor from
// one metre to the next where it comes into a void from outside. A mean would let daylight glow a whole cell deep.
float factor_in_stops(const std::array<float, 8>& luminances, const std::array<float, 8>& weights);

// Between the points of a grid: the mean, and what lies between them in stops.
RadianceTerms blend(const std::vector<RadianceTerms>& grid, const AirGrid::Corners& corners);
RadianceTerms blend_in_stops(const std::vector<RadianceTerms>& grid, const AirGrid::Corners& corners);

struct RadianceGrid {
  AirGrid grid;
  SeenCorners seen;
  std::vector<RadianceTerms> terms;  // of each point: what arrives from each direction; between points in stops
  std::vector<RadianceTerms> ends_of_lamp;  // what arrives of a lamp's light by way of surfaces, besides; empty: none
  // Likewise, what the air has scattered of a lamp's light, but for what goes nearly straight on; empty: none.
  std::vector<RadianceTerms> of_lamp;
  // Of each point, whose light stands for it at places that see none of the corners about them: of all, and of the lamp.
  std::vector<std::uint32_t> stand_in, lamp_stand_in;
  RadianceTerms open{};              // of places far away, over level ground

  // Between points; outside the box an estimate.
  RadianceTerms at(const Vec3f& point) const;
  RadianceTerms of_lamp_at(const Vec3f& point) const;  // outside the box nothing

 private:
  AirGrid::Corners corners(const Vec3f& point, const std::vector<std::uint32_t>& stands_in) const;
  RadianceTerms between(const AirGrid::Corners& corners) const;
  void add_disc(const Vec3f& point, int quarter, float share, RadianceTerms& out) const;
};

// The sum over the terms of each order in this direction.
std::array<Vec3f, kOrders> orders_towards(const RadianceTerms& terms, const Vec3f& direction);
// Illuminance on a surface of this normal, at least 0; unit: klx
Vec3f illuminance_of(const RadianceTerms& terms, const Vec3f& normal);
// The same between the points of a grid, in stops or not.
Vec3f illuminance_between(const std::vector<RadianceTerms>& grid, const AirGrid::Corners& corners, const Vec3f& normal,
                          bool in_stops);

}  // namespace rubble
