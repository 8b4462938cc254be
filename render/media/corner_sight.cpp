#include "render/media/corner_sight.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace rubble {

namespace {

constexpr double kMargin = 0.01;  // about a triangle; unit: m
constexpr int kMostCuts = 6;      // of a cell along each axis: each part takes some rays
constexpr float kReach = 100;     // of rays that find out whether a place is inside a piece; unit: m

}  // namespace

CornerSight::CornerSight(const PreparedScene& scene, const RayScene& rays, const AirGrid& grid)
    : rays_(rays), grid_(grid), crowded_(grid.count()) {
  note_triangles(scene);
}

void CornerSight::note_triangles(const PreparedScene& scene) {
  std::vector<Vec3> corners;
  std::uint32_t of = RayScene::kNone;
  for (std::uint32_t number = 0; number < rays_.triangle_count(); ++number) {
    const RayScene::Triangle triangle = rays_.triangle(number);
    const PlacedMesh& placed = scene.placed[triangle.placed];
    const PreparedMesh& mesh = scene.meshes[placed.mesh];
    if (triangle.placed != of) {
      of = triangle.placed;
      corners.clear();
      for (const PreparedVertex& v : mesh.vertices)
        corners.push_back(placed.world_from_mesh * (Vec3(v.position) * placed.scale));
    }
    Aabb box;
    for (const std::uint32_t v : mesh.triangles[triangle.source].vertices) box.include(corners[v]);
    note_box(box);
  }
}

void CornerSight::note_box(const Aabb& box) {
  std::array<int, 3> low{}, high{};
  for (int a = 0; a < 3; ++a) {
    const double origin = double(grid_.origin[a]), cell = double(grid_.cell[a]);
    const int last = grid_.size[std::size_t(a)] - 2;
    if (box.max[a] + kMargin < origin || box.min[a] - kMargin > origin + cell * (last + 1)) return;
    const auto cell_of = [&](double x) { return int(std::clamp((x - origin) / cell, 0.0, double(last))); };
    low[std::size_t(a)] = cell_of(box.min[a] - kMargin), high[std::size_t(a)] = cell_of(box.max[a] + kMargin);
  }
  for (int z = low[2]; z <= high[2]; ++z)
    for (int y = low[1]; y <= high[1]; ++y)
      for (int x = low[0]; x <= high[0]; ++x)
        crowded_[(std::size_t(z) * std::size_t(grid_.size[1]) + std::size_t(y)) * std::size_t(grid_.size[0]) + std::size_t(x)] = 1;
}

std::uint8_t CornerSight::seen_from(const Vec3f& place) const {
  const AirGrid::Corners corners = grid_.about(place);
  if (!crowded_[corners.at[0]]) return 255;
  std::array<RayScene::Ray, 8> rays;
  std::array<std::uint8_t, 8> hidden{};
  for (std::size_t k = 0; k < 8; ++k) {
    const Vec3f way = grid_.point(corners.at[k]) - place;
    rays[k] = {place, 0, way, 1};
    if (dot(way, way) < 1e-10f) rays[k] = {place, 0, {0, 0, 1}, 1e-5f};  // it is that corner
  }
  rays_.blocked_many(rays.data(), rays.size(), RayScene::Order::coherent, hidden.data());
  std::uint8_t seen = 0;
  for (std::size_t k = 0; k < 8; ++k)
    if (!hidden[k]) seen = std::uint8_t(seen | 1u << k);
  return seen;
}

bool CornerSight::inside(const Vec3f& place) const {
  int back = 0;
  for (const Vec3f& d : {Vec3f(0.3f, 0.2f, 0.93f), Vec3f(-0.5f, 0.6f, -0.62f), Vec3f(0.7f, -0.6f, 0.38f)})
    back += rays_.cast(place, d, 0, kReach).back;
  return back >= 2;
}

SeenCorners CornerSight::table(float part, ThreadPool& pool) const {
  const Vec3f& cell = grid_.cell;
  SeenCorners out;
  out.cuts = std::clamp(int(std::ceil(std::max(cell.x, std::max(cell.y, cell.z)) / part)), 1, kMostCuts);
  const std::size_t cuts = std::size_t(out.cuts), parts = cuts * cuts * cuts;
  out.seen.assign(grid_.count() * parts, 255);
  pool.run(int(grid_.count()), 16, [&](int begin, int end) {
    for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
      if (!crowded_[i]) continue;
      for (std::size_t k = 0; k < parts; ++k) {
        const auto middle = [&](std::size_t n) { return (float(n) + 0.5f) / float(cuts); };
        const Vec3f place = grid_.point(i) + Vec3f(cell.x * middle(k % cuts), cell.y * middle(k / cuts % cuts),
                                                   cell.z * middle(k / cuts / cuts));
        out.seen[i * parts + k] = inside(place) ? 0 : seen_from(place);
      }
    }
  });
  return out;
}

}  // namespace rubble
