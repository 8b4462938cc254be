#include "render/geometry/prepared_mesh.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "kernel/base/error.h"
#include "render/geometry/mesh_refine.h"
#include "render/materials/glass.h"
#include "render/materials/paint_layers.h"
#include "render/materials/surface_appearance.h"

namespace rubble {

namespace {

// Longest edge, for light that varies along a face: but not more than some thousand triangles for
// the sake of it.
constexpr float kLongestEdge = 0.3f;  // unit: m
constexpr float kEdgeShare = 0.08f;   // of a large mesh's radius
constexpr std::size_t kClusterTriangles = 64;
constexpr float kLightSpacing = 0.1f;  // of nodes of light along long edges; unit: m

std::vector<std::uint32_t> material_table(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> table;
  for (std::size_t s = 0; s < mesh.surface_names.size(); ++s)
    table.push_back(find_surface_appearance(mesh.paint_of(s) ? kPaintedAppearance : mesh.surface_names[s]));
  if (table.empty()) table.push_back(find_surface_appearance("concrete_cast"));
  return table;
}

// Interleaves the low 10 bits of three numbers.
std::uint32_t morton(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  std::uint32_t code = 0;
  for (int bit = 0; bit < 10; ++bit)
    code |= ((x >> bit & 1u) << (3 * bit)) | ((y >> bit & 1u) << (3 * bit + 1)) |
            ((z >> bit & 1u) << (3 * bit + 2));
  return code;
}

Vec3f face_normal(const PreparedMesh& mesh, const PreparedTriangle& t) {
  const Vec3f& a = mesh.vertices[t.vertices[0]].position;
  return normalized(
      cross(mesh.vertices[t.vertices[1]].position - a, mesh.vertices[t.vertices[2]].position - a));
}

// A box around the points, and a sphere of the same centre; both a little larger, for rounding.
void find_bounds(const std::vector<Vec3f>& points, Vec3f& centre, Vec3f& half, float& radius) {
  Vec3f low = points.front(), high = points.front();
  for (const Vec3f& p : points) low = min(low, p), high = max(high, p);
  centre = (low + high) * 0.5f;
  half = (high - low) * 0.50001f;
  radius = 0;
  for (const Vec3f& p : points) radius = std::max(radius, distance(p, centre));
  radius *= 1.00001f;
}

Cluster make_cluster(const PreparedMesh& mesh, std::size_t first, std::size_t count) {
  Cluster cluster;
  cluster.first_triangle = std::uint32_t(first);
  cluster.triangle_count = std::uint32_t(count);
  std::vector<Vec3f> points, normals;
  Vec3f sum;
  for (std::size_t i = first; i < first + count; ++i) {
    for (std::uint32_t v : mesh.triangles[i].vertices) points.push_back(mesh.vertices[v].position);
    normals.push_back(face_normal(mesh, mesh.triangles[i]));
    sum += normals.back();
  }
  find_bounds(points, cluster.centre, cluster.half, cluster.radius);
  cluster.cone_axis = normalized(sum);
  float cosine = 1;
  for (const Vec3f& n : normals) cosine = std::min(cosine, dot(n, cluster.cone_axis));
  cluster.cone_cosine = cosine > 0.05f ? cosine - 1e-4f : -1.0f;
  return cluster;
}

// Sorts the triangles of a level by side and place, and cuts the list into clusters.
void cluster_level(PreparedMesh& mesh, std::size_t first) {
  PreparedLevel level;
  level.first_cluster = std::uint32_t(mesh.clusters.size());
  level.first_triangle = std::uint32_t(first);
  level.triangle_count = std::uint32_t(mesh.triangles.size() - first);
  struct Keyed {
    std::uint64_t key;
    PreparedTriangle triangle;
    std::size_t source;
  };
  std::vector<Keyed> keyed;
  const Vec3f low = mesh.centre - Vec3f(1, 1, 1) * mesh.radius;
  const float scale = 1023.0f / (2 * std::max(mesh.radius, 1e-6f));
  for (std::size_t i = first; i < mesh.triangles.size(); ++i) {
    const PreparedTriangle& t = mesh.triangles[i];
    Vec3f mid;
    for (std::uint32_t v : t.vertices) mid += mesh.vertices[v].position * (1.0f / 3);
    const Vec3f q = max((mid - low) * scale, Vec3f());
    const std::uint64_t side = std::uint64_t(dominant_direction(face_normal(mesh, t)));
    keyed.push_back(
        {side << 32 | morton(std::uint32_t(q.x), std::uint32_t(q.y), std::uint32_t(q.z)), t, i});
  }
  std::stable_sort(keyed.begin(), keyed.end(),
                   [](const Keyed& a, const Keyed& b) { return a.key < b.key; });
  std::size_t start = 0;
  for (std::size_t i = 0; i < keyed.size(); ++i) mesh.triangles[first + i] = keyed[i].triangle;
  if (!mesh.paint.empty()) {
    const std::vector<TrianglePaint> paint = mesh.paint;
    for (std::size_t i = 0; i < keyed.size(); ++i) mesh.paint[first + i] = paint[keyed[i].source];
  }
  for (std::size_t i = 1; i <= keyed.size(); ++i) {
    const bool full = i - start == kClusterTriangles;
    const bool turned = i < keyed.size() && keyed[i].key >> 32 != keyed[start].key >> 32;
    if (i < keyed.size() && !full && !(turned && i - start >= kClusterTriangles / 4)) continue;
    mesh.clusters.push_back(make_cluster(mesh, first + start, i - start));
    start = i;
  }
  level.cluster_count = std::uint32_t(mesh.clusters.size()) - level.first_cluster;
  mesh.levels.push_back(level);
}

float longest_edge(const TriangleMesh& mesh) {
  const Aabb box = mesh.bounds();
  return box.empty() ? kLongestEdge
                     : std::max(kLongestEdge, kEdgeShare * float(distance(box.min, box.max)) / 2);
}

// Of the triangles of a level, which are the last of `out`.
void append_paint(const TriangleMesh& source, const TriangleMesh& mesh, PreparedMesh& out) {
  if (source.paints.empty() && out.paint.empty()) return;
  out.paint.resize(out.triangles.size() - mesh.triangles.size());
  std::vector<std::int32_t> numbers;
  std::vector<float> reds;
  for (std::size_t s = 0; s < source.surface_names.size(); ++s) {
    const bool painted = source.paint_of(s);
    numbers.push_back(painted ? std::int32_t(out.paints.size()) : -1);
    reds.push_back(painted ? mean_paint(source, s).x : 0);
    if (painted) out.paints.push_back(source.paints[s]);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    TrianglePaint paint;
    const std::size_t surface = mesh.surfaces[t];
    if (surface < numbers.size() && numbers[surface] >= 0)
      paint = {mesh.paint_corners[t], numbers[surface], reds[surface]};
    out.paint.push_back(paint);
  }
}

void append_level(const TriangleMesh& source, double light_spacing, PreparedMesh& out) {
  // Light varies along the nodes of a triangle: where they are far apart, so may its corners be.
  const float longest = light_spacing > 0 ? float(light_spacing * kMostLightSteps) : longest_edge(source);
  const TriangleMesh mesh = refine_mesh(source, longest);
  const std::vector<std::uint32_t> materials = material_table(source);
  const std::uint32_t base = std::uint32_t(out.vertices.size());
  const std::size_t first = out.triangles.size();
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    out.vertices.push_back({mesh.positions[i], mesh.normals[i]});
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& v = mesh.triangles[t];
    if (mesh.surfaces[t] >= materials.size())
      throw RunError("a mesh has a triangle of surface " + std::to_string(mesh.surfaces[t]) +
                     " but names only " + std::to_string(materials.size()));
    const std::uint32_t material = materials[mesh.surfaces[t]];
    out.triangles.push_back({{base + v[0], base + v[1], base + v[2]}, material});
    out.glass = out.glass || material == glass_appearance();
  }
  append_paint(source, mesh, out);
  if (out.levels.empty() && !out.vertices.empty()) {
    std::vector<Vec3f> points;
    for (const PreparedVertex& v : out.vertices) points.push_back(v.position);
    find_bounds(points, out.centre, out.half, out.radius);
  }
  cluster_level(out, first);
}

}  // namespace

int dominant_direction(const Vec3f& n) {
  const float ax = std::fabs(n.x), ay = std::fabs(n.y), az = std::fabs(n.z);
  if (ax >= ay && ax >= az) return n.x > 0 ? 0 : 1;
  if (ay >= az) return n.y > 0 ? 2 : 3;
  return n.z > 0 ? 4 : 5;
}

PreparedMesh prepare_mesh(const SceneMesh& mesh, int threads) {
  PreparedMesh out;
  for (const TriangleMesh& level : mesh.levels) append_level(level, mesh.light_spacing, out);
  if (out.vertices.empty()) throw RunError("a mesh of the scene has no triangles");
  const float coarse = float(mesh.light_spacing);
  make_light_nodes(out, out.levels.front().triangle_count, coarse > 0 ? coarse : kLightSpacing, coarse, threads);
  out.light_nodes.shrink_to_fit();
  return out;
}

namespace {

// Grid lines: even steps over [low, high], then steps that grow outwards to 4 km.
std::vector<float> ground_lines(double low, double high) {
  constexpr double kFar = 4000, kGrowth = 1.35;
  const double inner = std::max(0.3, (high - low) / 190);
  std::vector<float> lines;
  for (double x = low, step = inner; x > low - kFar; step *= kGrowth)
    x -= step, lines.insert(lines.begin(), float(x));
  const int count = std::max(1, int(std::ceil((high - low) / inner)));
  for (int i = 0; i <= count; ++i) lines.push_back(float(low + (high - low) * i / count));
  for (double x = high, step = inner; x < high + kFar; step *= kGrowth)
    x += step, lines.push_back(float(x));
  return lines;
}

}  // namespace

PreparedMesh prepare_ground(const Aabb& around) {
  constexpr double kMargin = 3, kWidest = 60;  // unit: m
  const auto low = [&](double x) { return std::max(x - kMargin, -kWidest); };
  const auto high = [&](double x) { return std::min(x + kMargin, kWidest); };
  Aabb area = around;
  if (area.empty()) area.include({0, 0, 0});
  const std::vector<float> xs = ground_lines(low(area.min.x), high(area.max.x));
  const std::vector<float> ys = ground_lines(low(area.min.y), high(area.max.y));
  PreparedMesh out;
  for (float y : ys)
    for (float x : xs) out.vertices.push_back({{x, y, 0}, {0, 0, 1}});
  const std::uint32_t material = find_surface_appearance("ground"), row = std::uint32_t(xs.size());
  for (std::uint32_t j = 0; j + 1 < ys.size(); ++j) {
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      const std::uint32_t a = j * row + i, b = a + 1, c = a + row, d = c + 1;
      out.triangles.push_back({{a, b, d}, material});
      out.triangles.push_back({{a, d, c}, material});
    }
  }
  out.half = Vec3f(4200, 4200, 1e-3f);
  out.radius = 6000;
  cluster_level(out, 0);
  // Light every 0.1 m; of large places every 0.15 m, of very large ones at the vertices alone.
  constexpr float kFine = 0.15f, kCoarse = 0.22f, kNone = 1, kLongest = 0.45f;  // unit: m
  const double square = (high(area.max.x) - low(area.min.x)) * (high(area.max.y) - low(area.min.y));
  make_ground_nodes(out, square < 300 ? kFine : square < 1200 ? kCoarse : kNone, kLongest);
  return out;
}

}  // namespace rubble
