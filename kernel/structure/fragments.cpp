#include "kernel/structure/fragments.h"

#include <algorithm>

namespace rubble {
namespace {

constexpr double kLeastArea = 1e-6;  // smaller faces give no bond; unit: m2
// Corners of a fragment that are closer than this are one; unit: m.
constexpr double kSameCorner = 1e-6;
constexpr double kMostOfSteepest = 0.95;  // steepest cut, as a share of the slope at which cuts would meet; unit: 1

std::vector<Vec3> draw_points(const Vec3& size, const CutOptions& options, RandomStream& random) {
  std::vector<Vec3> points;
  for (int k = 0; k < options.counts[2]; ++k) {
    for (int j = 0; j < options.counts[1]; ++j) {
      for (int i = 0; i < options.counts[0]; ++i) {
        const int cell[3] = {i, j, k};
        Vec3 point;
        for (int axis = 0; axis < 3; ++axis) {
          // Where there is one cell across, its points leave the middle by the spacing along the
          // others, so that cuts are tilted.
          double spacing = size[axis] / options.counts[axis];
          const double middle = -size[axis] / 2 + (cell[axis] + 0.5) * spacing;
          point[axis] = middle + random.uniform(-1, 1) * options.roughness * spacing;
        }
        points.push_back(point);
      }
    }
  }
  return points;
}

// The steepest slope at which cuts through these places of an axis meet neither each other nor the ends
// within the box. reach: of the box across the axis, to where they slope; unit: m
double find_steepest(const std::vector<Vec3>& points, int along, double length, double reach) {
  double least = 1e30, before = -length;  // the ends count as two cuts that do not slope
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double cut = (points[i][along] + points[i + 1][along]) / 2;
    least = std::min(least, i == 0 ? 2 * (cut + length / 2) : cut - before);
    before = cut;
  }
  return std::min(least, 2 * (length / 2 - before)) / (2 * reach);
}

// Neighbours leave the axis to opposite sides, as far as gives the cut between them the slope.
void tilt_cuts(const Vec3& size, const CutOptions& options, RandomStream& random, std::vector<Vec3>& points) {
  int along = -1, axes = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (options.counts[axis] > 1) along = axis, ++axes;
  }
  if (axes != 1 || !(options.slope > 0)) return;
  Vec3 aside = random.direction();
  aside[along] = 0;
  aside = normalized(aside);
  double reach = 0;
  for (int axis = 0; axis < 3; ++axis) reach += std::abs(aside[axis]) * size[axis] / 2;
  const double slope = std::min(options.slope, kMostOfSteepest * find_steepest(points, along, size[along], reach));
  double spacing = 1e30;  // the widest slope is that of the closest points
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    spacing = std::min(spacing, points[i + 1][along] - points[i][along]);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 off = aside * (slope * spacing / 2 * (i % 2 == 0 ? 1 : -1));
    const double place = points[i][along];
    points[i] = off;
    points[i][along] = place;
  }
}

std::vector<HalfSpace> sides_of(const Vec3& size) {
  return {{{1, 0, 0}, size.x / 2},  {{-1, 0, 0}, size.x / 2}, {{0, 1, 0}, size.y / 2},
          {{0, -1, 0}, size.y / 2}, {{0, 0, 1}, size.z / 2},  {{0, 0, -1}, size.z / 2}};
}

// The cell's half-spaces: those of the box, then one to each other point that may bound it.
struct Cell {
  std::vector<HalfSpace> bounds;
  std::vector<int> neighbours;  // -1: the box
};

Cell make_cell(const std::vector<Vec3>& points, int index, const Vec3& size) {
  Cell cell;
  cell.bounds = sides_of(size);
  cell.neighbours.assign(cell.bounds.size(), -1);
  for (int other = 0; other < int(points.size()); ++other) {
    if (other == index) continue;
    // The same plane from both sides, to the bit.
    const Vec3 &low = points[std::min(index, other)], &high = points[std::max(index, other)];
    const Vec3 normal = normalized(high - low);
    const double offset = dot(normal, (low + high) * 0.5);
    cell.bounds.push_back(index < other ? HalfSpace{normal, offset} : HalfSpace{-normal, -offset});
    cell.neighbours.push_back(other);
  }
  return cell;
}

std::vector<FragmentFace> find_faces(const Cell& cell, double extent) {
  std::vector<FragmentFace> faces;
  for (std::size_t i = 0; i < cell.bounds.size(); ++i) {
    std::vector<HalfSpace> others = cell.bounds;
    others.erase(others.begin() + std::ptrdiff_t(i));
    const Polygon polygon = cut_plane(cell.bounds[i], others, extent);
    if (calc_area_properties(polygon, make_axes(cell.bounds[i].normal)).area < kLeastArea) continue;
    faces.push_back({cell.bounds[i], polygon, cell.neighbours[i]});
  }
  return faces;
}

std::vector<Vec3> find_corners(const std::vector<FragmentFace>& faces, double gap, double extent) {
  std::vector<HalfSpace> bounds;
  for (const FragmentFace& face : faces) {
    bounds.push_back({face.plane.normal, face.plane.offset - gap / 2});
  }
  std::vector<Vec3> corners;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    std::vector<HalfSpace> others = bounds;
    others.erase(others.begin() + std::ptrdiff_t(i));
    for (const Vec3& p : cut_plane(bounds[i], others, extent)) {
      const bool known = std::any_of(corners.begin(), corners.end(), [&](const Vec3& q) {
        return distance(p, q) < kSameCorner;
      });
      if (!known) corners.push_back(p);
    }
  }
  return corners;
}

}  // namespace

std::vector<Fragment> cut_box(const Vec3& size, const CutOptions& options, RandomStream& random) {
  std::vector<Vec3> points = draw_points(size, options, random);
  tilt_cuts(size, options, random, points);
  const double extent = norm(size);
  std::vector<Fragment> fragments;
  for (int i = 0; i < int(points.size()); ++i) {
    Fragment fragment;
    fragment.faces = find_faces(make_cell(points, i, size), extent);
    fragment.corners = find_corners(fragment.faces, options.gap, extent);
    fragments.push_back(std::move(fragment));
  }
  return fragments;
}

}  // namespace rubble
