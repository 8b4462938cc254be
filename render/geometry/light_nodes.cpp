#include "render/geometry/light_nodes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "kernel/base/parallel.h"
#include "render/geometry/point_cells.h"
#include "render/geometry/prepared_mesh.h"

namespace rubble {

namespace {

constexpr std::uint32_t kMostNodes = 1u << 21;  // whose numbers fit beside the rest, see geometry.cpp
constexpr float kLeastCell = 0.04f, kMostCell = 0.1f;  // of space, one point each; unit: m
constexpr float kCellShare = 0.4f;              // of the mesh's radius
constexpr float kGrain = 5e-3f;                 // root of the mean area of triangles, of a heap of grains; unit: m
constexpr float kGrainsCell = 0.25f, kLeastHeap = 0.3f;  // cell and least radius of such a mesh; unit: m
constexpr std::size_t kMostOrigins = 8;         // of a point
constexpr std::size_t kNodesAJob = 1 << 13;
constexpr float kAside = 0.3f;                  // of origins from their node; unit: a step

struct Corners {
  Corners(const PreparedMesh& mesh, const PreparedTriangle& t)
      : a(mesh.vertices[t.vertices[0]]), b(mesh.vertices[t.vertices[1]]), c(mesh.vertices[t.vertices[2]]) {}
  const PreparedVertex &a, &b, &c;

  Vec3f position(float u, float v) const { return a.position * (1 - u - v) + b.position * u + c.position * v; }
  // That of the triangle where those of the corners cancel.
  Vec3f normal(float u, float v) const {
    const Vec3f mean = a.normal * (1 - u - v) + b.normal * u + c.normal * v;
    return dot(mean, mean) > 1e-8f ? normalized(mean) : face();
  }
  Vec3f face() const { return normalized(cross(b.position - a.position, c.position - a.position)); }
  float longest_edge() const {
    return std::max(distance(a.position, b.position),
                    std::max(distance(b.position, c.position), distance(c.position, a.position)));
  }
};

void add_vertex_nodes(PreparedMesh& mesh) {
  mesh.light_nodes.assign(mesh.vertices.size(), {});
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    mesh.light_nodes[i].position = mesh.vertices[i].position, mesh.light_nodes[i].normal = mesh.vertices[i].normal;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      LightNode& node = mesh.light_nodes[mesh.triangles[t].vertices[k]];
      node.triangle = t, node.u = k == 1 ? 1.0f : 0.0f, node.v = k == 2 ? 1.0f : 0.0f;
    }
}

void add_grid(PreparedMesh& mesh, std::uint32_t t, float spacing) {
  const Corners corners(mesh, mesh.triangles[t]);
  const auto n = std::min(std::uint32_t(std::ceil(corners.longest_edge() / spacing)), kMostLightSteps);
  if (n < 2 || mesh.light_nodes.size() + light_node_count(n) > kMostNodes) return;
  mesh.triangles[t].light_steps = n;
  mesh.triangles[t].first_node = std::uint32_t(mesh.light_nodes.size());
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i + j <= n; ++i) {
      LightNode node;
      node.triangle = t, node.u = float(i) / float(n), node.v = float(j) / float(n);
      node.position = corners.position(node.u, node.v), node.normal = corners.normal(node.u, node.v);
      mesh.light_nodes.push_back(node);
    }
}

// Of a node of a grid: places on its triangle a part of a step away, so that the point stands for the
// surface about it, not for one spot. Of a vertex: itself.
void add_origins(const PreparedMesh& mesh, const LightNode& node, bool vertex, std::vector<BakeOrigin>& out) {
  const PreparedTriangle& triangle = mesh.triangles[node.triangle];
  const Corners corners(mesh, triangle);
  const Vec3f face = corners.face();
  if (vertex || triangle.light_steps < 2) {
    out.push_back({node.position, node.normal});
    return;
  }
  const float d = kAside / float(triangle.light_steps);
  for (const auto& [du, dv] : {std::pair(d, 0.0f), std::pair(-d, d), std::pair(0.0f, -d)}) {
    const float u = node.u + du, v = node.v + dv;
    if (u >= 0 && v >= 0 && u + v <= 1) out.push_back({corners.position(u, v), face});
  }
}

// At most kMostOrigins of them, from all over the list.
void keep_origins(PreparedMesh& mesh, BakePoint& point, const std::vector<BakeOrigin>& origins) {
  point.first_origin = std::uint32_t(mesh.bake_origins.size());
  const std::size_t count = std::min(origins.size(), kMostOrigins);
  for (std::size_t k = 0; k < count; ++k)
    mesh.bake_origins.push_back(origins[k * origins.size() / count]);
  point.origin_count = std::uint32_t(count);
}

// One point for each cell of space and side of the surface, in the middle of its nodes.
void choose_points(PreparedMesh& mesh, const std::vector<std::uint32_t>& nodes, float cell) {
  std::map<std::tuple<int, int, int, int>, std::vector<std::uint32_t>> cells;
  for (const std::uint32_t i : nodes) {
    const LightNode& node = mesh.light_nodes[i];
    const Vec3f q = (node.position - mesh.centre) * (1 / cell);
    const auto at = [](float x) { return int(std::floor(x + 0.5f)); };
    cells[{at(q.x), at(q.y), at(q.z), dominant_direction(node.normal)}].push_back(i);
  }
  for (const auto& [key, members] : cells) {
    BakePoint point;
    std::vector<BakeOrigin> origins;
    for (const std::uint32_t i : members) {
      point.position += mesh.light_nodes[i].position * (1 / float(members.size()));
      point.normal += mesh.light_nodes[i].normal;
      add_origins(mesh, mesh.light_nodes[i], i < mesh.vertices.size(), origins);
    }
    const bool none = dot(point.normal, point.normal) < 1e-12f;
    point.normal = none ? mesh.light_nodes[members.front()].normal : normalized(point.normal);
    if (origins.empty()) origins.push_back({point.position, point.normal});
    keep_origins(mesh, point, origins);
    mesh.bake_points.push_back(point);
  }
}

typedef float FourFloats __attribute__((vector_size(16)));

// Points that nodes choose from, four beside each other; what is over lies infinitely far away.
struct Candidates {
  struct Four {
    FourFloats x, y, z, normal_x, normal_y, normal_z;
    std::array<std::uint32_t, 4> point;
  };
  std::vector<Four> fours;
  std::size_t count = 0;

  void clear() { fours.clear(), count = 0; }
  void add(const BakePoint& p, std::uint32_t point) {
    const std::size_t k = count++ % 4;
    if (k == 0) {
      fours.emplace_back();
      fours.back().x = FourFloats{} + 1e30f;
    }
    Four& f = fours.back();
    f.x[k] = p.position.x, f.y[k] = p.position.y, f.z[k] = p.position.z;
    f.normal_x[k] = p.normal.x, f.normal_y[k] = p.normal.y, f.normal_z[k] = p.normal.z, f.point[k] = point;
  }
};

// The five points that cost least, the cheapest first; of equal ones the first that was looked at.
class NearestPoints {
 public:
  struct Entry {
    float cost;  // unit: m
    std::uint32_t point;
  };

  // turn_cost: of turning away by 60 degrees; unit: m
  NearestPoints(const LightNode& node, float turn_cost) : node_(node), turn_cost_(turn_cost) {
    best_.fill({1e30f, 0});
  }

  void look_at(const Candidates::Four& f) {
    const Vec3f& p = node_.position;
    const Vec3f& n = node_.normal;
    const FourFloats x = f.x - p.x, y = f.y - p.y, z = f.z - p.z;
    const FourFloats turn = 1.0f - (f.normal_x * n.x + f.normal_y * n.y + f.normal_z * n.z);
    const FourFloats squares = x * x + y * y + z * z + 4.0f * turn * turn * turn_cost_ * turn_cost_;
    for (std::size_t k = 0; k < 4; ++k)
      if (squares[k] < worst_) take({std::sqrt(squares[k]), f.point[k]}, squares[k]);
  }
  const Entry& operator[](std::size_t k) const { return best_[k]; }

 private:
  // What costs more than the fifth has a square above `worst_`, too: roots are rounded in order.
  void take(Entry entry, float square) {
    for (std::size_t k = 0; k < best_.size(); ++k)
      if (entry.cost < best_[k].cost) {
        std::swap(entry, best_[k]);
        std::swap(square, squares_[k]);
      }
    worst_ = squares_.back();
  }

  const LightNode& node_;
  float turn_cost_;
  float worst_ = 1e38f;
  std::array<Entry, 5> best_;
  std::array<float, 5> squares_{1e38f, 1e38f, 1e38f, 1e38f, 1e38f};  // of their costs
};

// A point's weight is zero where the fifth is as near (Franke and Little's weights), so light has no steps where
// the four nearest change.
void weigh_points(const Candidates& candidates, float cell, LightNode& node) {
  const float turn_cost = 2.5f * cell;
  NearestPoints best(node, turn_cost);
  for (const Candidates::Four& f : candidates.fours) best.look_at(f);
  float sum = 0;
  const float far = std::min(best[4].cost, 3 * best[0].cost + 2 * turn_cost), soft = 0.02f * cell;
  for (std::size_t k = 0; k < 4; ++k) {
    const float w = best[k].cost < far ? (far - best[k].cost) / (far * (best[k].cost + soft)) : 0;
    node.points[k] = best[k].cost < 1e29f ? best[k].point : best[0].point;
    node.weights[k] = w * w;
    sum += node.weights[k];
  }
  if (sum <= 0) node.weights = {1, 0, 0, 0}, sum = 1;
  for (float& w : node.weights) w /= sum;
}

// Nodes in one cell of space choose from the same points, which are looked for once.
void weigh_all(PreparedMesh& mesh, float cell, int threads) {
  std::vector<PointCells::Point> points;
  for (std::uint32_t i = 0; i < mesh.bake_points.size(); ++i) points.push_back({mesh.bake_points[i].position, i});
  const PointCells grid(cell, points);
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order;  // cell, node
  for (std::uint32_t i = 0; i < mesh.light_nodes.size(); ++i)
    order.emplace_back(grid.cell_of(mesh.light_nodes[i].position), i);
  std::sort(order.begin(), order.end());
  parallel_for((order.size() + kNodesAJob - 1) / kNodesAJob, threads, [&](std::size_t job) {
    Candidates candidates;
    const auto add = [&](std::uint32_t i) { candidates.add(mesh.bake_points[i], i); };
    const std::size_t begin = job * kNodesAJob, end = std::min(begin + kNodesAJob, order.size());
    for (std::size_t n = begin; n < end; ++n) {
      LightNode& node = mesh.light_nodes[order[n].second];
      if (n == begin || order[n].first != order[n - 1].first) {
        candidates.clear();
        for (int reach = 2; candidates.count == 0 && reach < 256; reach *= 2) grid.near(node.position, reach, add);
        if (candidates.count == 0)
          for (std::uint32_t i = 0; i < mesh.bake_points.size(); ++i) add(i);
      }
      weigh_points(candidates, cell, node);
    }
  });
}

// A heap of grains takes the light of the floor around it: at a point for each of its parts, light would take
// minutes to find.
bool is_heap_of_grains(const PreparedMesh& mesh, std::size_t finest_triangles) {
  double twice = 0;
  for (std::size_t t = 0; t < finest_triangles; ++t) {
    const Corners c(mesh, mesh.triangles[t]);
    twice += double(norm(cross(c.b.position - c.a.position, c.c.position - c.a.position)));
  }
  return mesh.radius > kLeastHeap && 0.5 * twice < double(finest_triangles) * double(kGrain * kGrain);
}

float choose_cell(const PreparedMesh& mesh, std::size_t finest_triangles) {
  if (is_heap_of_grains(mesh, finest_triangles)) return kGrainsCell;
  return std::clamp(mesh.radius * kCellShare, kLeastCell, kMostCell);
}

}  // namespace

LightNodes find_light_nodes(const PreparedMesh& mesh, std::uint32_t triangle, float u, float v) {
  const PreparedTriangle& t = mesh.triangles[triangle];
  const std::uint32_t n = t.light_steps;
  if (n < 2) return {t.vertices, {1 - u - v, u, v}};
  const float x = u * float(n), y = v * float(n);
  const std::uint32_t i = std::min(std::uint32_t(std::max(x, 0.0f)), n - 1);
  const std::uint32_t j = std::min(std::uint32_t(std::max(y, 0.0f)), n - 1 - i);
  const float fx = x - float(i), fy = y - float(j);
  const bool upper = fx + fy > 1 && i + j + 2 <= n;
  const std::uint32_t right = t.first_node + light_node_index(n, i + 1, j);
  const std::uint32_t above = t.first_node + light_node_index(n, i, j + 1);
  if (upper) return {{t.first_node + light_node_index(n, i + 1, j + 1), above, right}, {fx + fy - 1, 1 - fx, 1 - fy}};
  return {{t.first_node + light_node_index(n, i, j), right, above}, {1 - fx - fy, fx, fy}};
}

void make_light_nodes(PreparedMesh& mesh, std::size_t finest_triangles, float spacing, float stated_cell, int threads) {
  add_vertex_nodes(mesh);
  std::vector<std::uint8_t> finest(mesh.vertices.size(), 0);
  for (std::size_t t = 0; t < finest_triangles; ++t)
    for (const std::uint32_t v : mesh.triangles[t].vertices) finest[v] = 1;
  for (std::uint32_t t = 0; t < finest_triangles; ++t) add_grid(mesh, t, spacing);
  std::vector<std::uint32_t> nodes;
  for (std::uint32_t i = 0; i < mesh.light_nodes.size(); ++i)
    if (i >= finest.size() || finest[i]) nodes.push_back(i);
  const float cell = stated_cell > 0 ? stated_cell : choose_cell(mesh, finest_triangles);
  choose_points(mesh, nodes, cell);
  weigh_all(mesh, cell, threads);
}

void make_ground_nodes(PreparedMesh& mesh, float spacing, float longest) {
  add_vertex_nodes(mesh);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    if (Corners(mesh, mesh.triangles[t]).longest_edge() <= longest) add_grid(mesh, t, spacing);
  std::map<std::pair<float, float>, std::vector<std::uint32_t>> places;  // nodes of triangles that meet
  for (std::uint32_t i = 0; i < mesh.light_nodes.size(); ++i) {
    const Vec3f& p = mesh.light_nodes[i].position;
    const auto rounded = [](float x) { return std::floor(x * 256 + 0.5f); };
    places[{rounded(p.x), rounded(p.y)}].push_back(i);
  }
  for (const auto& [place, members] : places) {
    BakePoint point{mesh.light_nodes[members.front()].position, {0, 0, 1}};
    std::vector<BakeOrigin> origins;
    for (const std::uint32_t i : members) {
      add_origins(mesh, mesh.light_nodes[i], i < mesh.vertices.size(), origins);
      mesh.light_nodes[i].points.fill(std::uint32_t(mesh.bake_points.size()));
      mesh.light_nodes[i].weights = {1, 0, 0, 0};
    }
    if (origins.empty()) origins.push_back({point.position, point.normal});
    keep_origins(mesh, point, origins);
    mesh.bake_points.push_back(point);
  }
}

}  // namespace rubble
