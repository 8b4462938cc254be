#include "kernel/geometry/decomposing/decompose_steps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>
#include <tuple>

#include "kernel/base/disjoint_sets.h"
#include "kernel/geometry/hull.h"

namespace rubble::decomposing {
namespace {

using Points = std::vector<Vec3>;
using Triangle = std::array<int, 3>;

constexpr double kSameVolume = 1e-4;    // as a share: what single precision and files leave of it
constexpr double kSamePlane = 1e-5;     // of the size of a body
constexpr double kAligned = 1e-3;       // sine of the angle between a face and a direction, at most
constexpr std::size_t kMostPlanes = 40;  // across one direction

// A closed surface whose corners are shared.
struct Body {
  Points corners;
  std::vector<Triangle> triangles;
};

// Corners that are at the same place become one.
Body weld(const TriangleMesh& mesh) {
  Body body;
  std::map<std::tuple<float, float, float>, int> known;
  std::vector<int> welded;
  for (const Vec3f& p : mesh.positions) {
    const auto [at, is_new] = known.try_emplace({p.x, p.y, p.z}, int(body.corners.size()));
    if (is_new) body.corners.emplace_back(p);
    welded.push_back(at->second);
  }
  for (const auto& t : mesh.triangles) {
    const Triangle w{welded[t[0]], welded[t[1]], welded[t[2]]};
    if (w[0] != w[1] && w[1] != w[2] && w[2] != w[0]) body.triangles.push_back(w);
  }
  return body;
}

// Triangles that hang together by corners; in the order of their first triangles.
std::vector<Body> split(const Body& whole) {
  DisjointSets joined;
  joined.reset(whole.corners.size());
  for (const Triangle& t : whole.triangles) joined.join(t[0], t[1]), joined.join(t[0], t[2]);
  std::vector<Body> bodies;
  std::map<int, std::size_t> body_of;
  std::vector<int> place(whole.corners.size(), -1);
  for (const Triangle& t : whole.triangles) {
    const auto [at, is_new] = body_of.try_emplace(joined.find(t[0]), bodies.size());
    if (is_new) bodies.emplace_back();
    Body& body = bodies[at->second];
    Triangle own{};
    for (std::size_t k = 0; k < 3; ++k) {
      int& moved = place[std::size_t(t[k])];
      if (moved < 0) moved = int(body.corners.size()), body.corners.push_back(whole.corners[std::size_t(t[k])]);
      own[k] = moved;
    }
    body.triangles.push_back(own);
  }
  return bodies;
}

bool is_closed(const Body& body) {
  std::map<std::pair<int, int>, int> edges;
  for (const Triangle& t : body.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  return std::all_of(edges.begin(), edges.end(), [](const auto& edge) { return edge.second == 0; });
}

double calc_volume(const Body& body) {
  double six = 0;
  const Vec3& origin = body.corners[0];
  for (const Triangle& t : body.triangles)
    six += dot(body.corners[std::size_t(t[0])] - origin,
               cross(body.corners[std::size_t(t[1])] - origin, body.corners[std::size_t(t[2])] - origin));
  return six / 6;
}

// Its corners, where it is convex and has few.
Points as_convex(const Body& body, double volume, int max_corners) {
  if (calc_hull_volume(body.corners) > volume * (1 + kSameVolume)) return {};
  try {
    Points corners = calc_hull(body.corners).points;
    return int(corners.size()) <= max_corners ? corners : Points{};
  } catch (const std::invalid_argument&) {
    return {};
  }
}

Vec3 area_of(const Body& body, const Triangle& t) {
  const Vec3& a = body.corners[std::size_t(t[0])];
  return cross(body.corners[std::size_t(t[1])] - a, body.corners[std::size_t(t[2])] - a);
}

// Three directions at right angles across which every face lies; none: there are none.
std::optional<std::array<Vec3, 3>> find_frame(const Body& body) {
  std::vector<Vec3> areas;
  double largest = 0, total = 0;
  for (const Triangle& t : body.triangles) {
    areas.push_back(area_of(body, t));
    largest = std::max(largest, norm(areas.back())), total += norm(areas.back());
  }
  const auto widest = [&](const auto& fits) -> Vec3 {
    Vec3 best;
    for (const Vec3& area : areas)
      if (fits(area) && norm(area) > norm(best)) best = area;
    return best;
  };
  const Vec3 first = normalized(widest([](const Vec3&) { return true; }));
  const Vec3 second = widest([&](const Vec3& area) { return std::fabs(dot(area, first)) < 0.1 * norm(area); });
  if (norm(second) < 1e-9 * largest) return {};
  const Vec3 third = normalized(cross(first, second));
  const std::array<Vec3, 3> frame{first, cross(third, first), third};
  double askew = 0;
  for (const Vec3& area : areas) {
    double along = 0;
    for (const Vec3& axis : frame) along = std::max(along, std::fabs(dot(area, axis)));
    if (along < norm(area) * (1 - kAligned * kAligned)) askew += norm(area);
  }
  if (askew > 1e-6 * total) return {};
  return frame;
}

// A body in its own frame, cut by all the planes of its faces.
struct Lattice {
  std::array<std::vector<double>, 3> planes;  // ascending
  std::array<int, 3> size{};                  // cells between them
  std::vector<char> inside;                   // x fastest

  std::size_t index(const std::array<int, 3>& c) const {
    return std::size_t((c[2] * size[1] + c[1]) * size[0] + c[0]);
  }
};

std::vector<double> distinct(std::vector<double> values, double tolerance) {
  std::sort(values.begin(), values.end());
  std::vector<double> kept;
  for (const double value : values)
    if (kept.empty() || value - kept.back() > tolerance) kept.push_back(value);
  return kept;
}

// How often the surface winds about a point: faces that a ray along the third axis leaves, less those
// that it enters.
int winding(const Points& corners, const std::vector<Triangle>& triangles, const Vec3& at) {
  int count = 0;
  for (const Triangle& t : triangles) {
    const Vec3 &a = corners[std::size_t(t[0])], &b = corners[std::size_t(t[1])], &c = corners[std::size_t(t[2])];
    if (std::max({a.z, b.z, c.z}) < at.z) continue;
    const auto side = [&](const Vec3& p, const Vec3& q) {
      return (q.x - p.x) * (at.y - p.y) - (q.y - p.y) * (at.x - p.x);
    };
    const double ab = side(a, b), bc = side(b, c), ca = side(c, a);
    if (ab > 0 && bc > 0 && ca > 0) ++count;
    if (ab < 0 && bc < 0 && ca < 0) --count;
  }
  return count;
}

bool fill(const Points& corners, const std::vector<Triangle>& triangles, double tolerance, Lattice& lattice) {
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Vec3& p : corners) values.push_back(p[axis]);
    lattice.planes[std::size_t(axis)] = distinct(std::move(values), tolerance);
    const std::size_t count = lattice.planes[std::size_t(axis)].size();
    if (count < 2 || count > kMostPlanes) return false;
    lattice.size[std::size_t(axis)] = int(count) - 1;
  }
  // Faces that lie across the ray's direction; its point avoids diagonals of cells.
  std::vector<Triangle> faces;
  for (const Triangle& t : triangles) {
    const double span = std::max({corners[std::size_t(t[0])].z, corners[std::size_t(t[1])].z, corners[std::size_t(t[2])].z}) -
                        std::min({corners[std::size_t(t[0])].z, corners[std::size_t(t[1])].z, corners[std::size_t(t[2])].z});
    if (span <= tolerance) faces.push_back(t);
  }
  const double share[3] = {0.5432109, 0.4567123, 0.5};
  for (int z = 0; z < lattice.size[2]; ++z)
    for (int y = 0; y < lattice.size[1]; ++y)
      for (int x = 0; x < lattice.size[0]; ++x) {
        Vec3 at;
        const int cell[3] = {x, y, z};
        for (int axis = 0; axis < 3; ++axis) {
          const auto& planes = lattice.planes[std::size_t(axis)];
          const double low = planes[std::size_t(cell[axis])], high = planes[std::size_t(cell[axis]) + 1];
          at[axis] = low + share[axis] * (high - low);
        }
        lattice.inside.push_back(winding(corners, faces, at) != 0);
      }
  return true;
}

struct Block {
  std::array<int, 3> low{}, high{};  // cells, half-open
};

bool is_free(const Lattice& lattice, const std::vector<char>& open, const Block& block) {
  for (int z = block.low[2]; z < block.high[2]; ++z)
    for (int y = block.low[1]; y < block.high[1]; ++y)
      for (int x = block.low[0]; x < block.high[0]; ++x)
        if (!open[lattice.index({x, y, z})]) return false;
  return true;
}

// From each cell that is left a block grows along the axes in this order, as far as it can.
std::vector<Block> cover(const Lattice& lattice, const std::array<int, 3>& order) {
  std::vector<char> open = lattice.inside;
  std::vector<Block> blocks;
  for (int z = 0; z < lattice.size[2]; ++z)
    for (int y = 0; y < lattice.size[1]; ++y)
      for (int x = 0; x < lattice.size[0]; ++x) {
        if (!open[lattice.index({x, y, z})]) continue;
        Block block{{x, y, z}, {x + 1, y + 1, z + 1}};
        for (const int axis : order) {
          const std::size_t k = std::size_t(axis);
          for (Block more = block; more.high[k] < lattice.size[k]; block = more) {
            more.low[k] = block.high[k], more.high[k] = block.high[k] + 1;
            if (!is_free(lattice, open, more)) break;
            more.low[k] = block.low[k];
          }
        }
        for (int w = block.low[2]; w < block.high[2]; ++w)
          for (int v = block.low[1]; v < block.high[1]; ++v)
            for (int u = block.low[0]; u < block.high[0]; ++u) open[lattice.index({u, v, w})] = 0;
        blocks.push_back(block);
      }
  return blocks;
}

std::vector<Block> cover_with_fewest(const Lattice& lattice) {
  std::array<int, 3> order{0, 1, 2};
  std::vector<Block> best = cover(lattice, order);
  while (std::next_permutation(order.begin(), order.end())) {
    std::vector<Block> other = cover(lattice, order);
    if (other.size() < best.size()) best = std::move(other);
  }
  return best;
}

// Boxes, where all faces lie across three directions at right angles.
std::vector<Points> as_boxes(const Body& body, double volume) {
  const auto frame = find_frame(body);
  if (!frame) return {};
  const Vec3 origin = body.corners[0];
  Points own;  // in the frame
  double size = 0;
  for (const Vec3& p : body.corners) {
    const Vec3 d = p - origin;
    own.push_back({dot(d, (*frame)[0]), dot(d, (*frame)[1]), dot(d, (*frame)[2])});
    size = std::max(size, norm(d));
  }
  Lattice lattice;
  if (!fill(own, body.triangles, kSamePlane * size, lattice)) return {};
  std::vector<Points> boxes;
  double sum = 0;
  for (const Block& block : cover_with_fewest(lattice)) {
    boxes.emplace_back();
    double product = 1;
    for (std::size_t k = 0; k < 3; ++k)
      product *= lattice.planes[k][std::size_t(block.high[k])] - lattice.planes[k][std::size_t(block.low[k])];
    sum += product;
    for (int i = 0; i < 8; ++i) {
      Vec3 corner = origin;
      for (std::size_t k = 0; k < 3; ++k) {
        const int plane = i >> k & 1 ? block.high[k] : block.low[k];
        corner += (*frame)[k] * lattice.planes[k][std::size_t(plane)];
      }
      boxes.back().push_back(corner);
    }
  }
  // A surface that crosses itself holds another volume than it winds about.
  if (std::fabs(sum - volume) > kSameVolume * volume) return {};
  return boxes;
}

}  // namespace

std::vector<Points> find_exact_parts(const TriangleMesh& mesh, int max_parts, int max_corners) {
  const Body whole = weld(mesh);
  if (whole.triangles.empty() || !is_closed(whole)) return {};
  const std::vector<Body> bodies = split(whole);
  if (int(bodies.size()) > max_parts) return {};
  std::vector<Points> parts;
  for (const Body& body : bodies) {
    const double volume = calc_volume(body);
    if (volume <= 0) return {};  // a cavity, or inside out
    if (Points convex = as_convex(body, volume, max_corners); !convex.empty()) {
      parts.push_back(std::move(convex));
      continue;
    }
    std::vector<Points> boxes = as_boxes(body, volume);
    if (boxes.empty()) return {};
    for (Points& box : boxes) parts.push_back(std::move(box));
  }
  if (int(parts.size()) > max_parts) parts.clear();
  return parts;
}

}  // namespace rubble::decomposing
