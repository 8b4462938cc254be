#include "app/eval/map/seen_surface.h"

#include <algorithm>
#include <cmath>

#include "app/eval/scores/space_key.h"
#include "kernel/base/random.h"

namespace rubble {
namespace {

constexpr int kRaysPerRow = 128;
constexpr double kCell = 0.2;      // unit: m
constexpr double kTouch = 1e-4;    // a ray that ends so near to a point has reached it; unit: m
constexpr double kGroundReach = 1e-6;  // of a hit on the ground from z = 0; unit: m

// Which frames may see the surface of a cell; sorted by cell, then frame.
class FramesOfCells {
 public:
  FramesOfCells(const PileQueries& queries, const RecordedViews& views, ThreadPool& pool) {
    std::vector<std::vector<std::int64_t>> cells(views.world_from_optical.size());
    pool.run(int(cells.size()), 1, [&](int begin, int end) {
      for (int i = begin; i < end; ++i)
        cells[std::size_t(i)] = look_around(queries, views, std::size_t(i));
    });
    for (std::size_t i = 0; i < cells.size(); ++i)
      for (const std::int64_t key : cells[i]) entries_.push_back({key, std::uint32_t(i)});
    std::sort(entries_.begin(), entries_.end());
  }

  struct Entry {
    std::int64_t cell = 0;
    std::uint32_t frame = 0;
    bool operator<(const Entry& b) const {
      return cell != b.cell ? cell < b.cell : frame < b.frame;
    }
  };

  // Those of one cell, [first, last).
  std::pair<const Entry*, const Entry*> find(std::int64_t cell) const {
    const auto range = std::equal_range(
        entries_.begin(), entries_.end(), Entry{cell, 0},
        [](const Entry& a, const Entry& b) { return a.cell < b.cell; });
    return {entries_.data() + (range.first - entries_.begin()),
            entries_.data() + (range.second - entries_.begin())};
  }
  const std::vector<Entry>& entries() const { return entries_; }

  // Whether a cell that a box touches is among them.
  bool touches(const Aabb& box) const {
    for (std::int64_t x = space_index(box.min.x, kCell); x <= space_index(box.max.x, kCell); ++x)
      for (std::int64_t y = space_index(box.min.y, kCell); y <= space_index(box.max.y, kCell); ++y) {
        const std::int64_t low = space_key(x, y, space_index(box.min.z, kCell));
        const std::int64_t high = space_key(x, y, space_index(box.max.z, kCell));
        const auto at = std::lower_bound(entries_.begin(), entries_.end(), Entry{low, 0});
        if (at != entries_.end() && at->cell <= high) return true;
      }
    return false;
  }

 private:
  // The cells that a frame's rays end in, and those around them.
  static std::vector<std::int64_t> look_around(const PileQueries& queries,
                                               const RecordedViews& views, std::size_t frame) {
    std::vector<std::int64_t> hits, cells;
    const Vec3& eye = views.world_from_optical[frame].translation;
    const Intrinsics& k = views.camera_of(frame).intrinsics;
    const double farthest = views.camera_of(frame).range.farthest;
    const double step = double(k.width) / kRaysPerRow;
    for (double v = -0.5; v <= k.height - 0.5; v += step)
      for (double u = -0.5; u <= k.width - 0.5; u += step) {
        const auto direction = views.direction(frame, u, v);
        if (!direction) continue;
        // Twice the range: planar depth is less than the length of the ray.
        const auto hit = queries.cast_ray(eye, *direction, 2 * farthest);
        if (hit && has_space_key(hit->point)) hits.push_back(space_key_of(hit->point, kCell));
      }
    sort_unique(hits);
    for (const std::int64_t key : hits)
      for (std::int64_t dx = -1; dx <= 1; ++dx)
        for (std::int64_t dy = -1; dy <= 1; ++dy)
          for (std::int64_t dz = -1; dz <= 1; ++dz)
            cells.push_back(key + (dx * (std::int64_t(1) << 42)) + dy * (1 << 21) + dz);
    sort_unique(cells);
    return cells;
  }

  static void sort_unique(std::vector<std::int64_t>& keys) {
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  }

  std::vector<Entry> entries_;
};

// Draws points and keeps those in cells that some frame may see.
class Sampler {
 public:
  Sampler(const FramesOfCells& frames, double spacing)
      : frames_(frames), spacing_(spacing), random_(0, "seen_surface") {}

  // Every piece has a stream of its own, so that what is left out elsewhere moves no point.
  void add_piece(const PieceState& piece, std::size_t number, const TriangleMesh& mesh) {
    std::vector<Vec3> corners;
    Aabb box;
    for (const Vec3f& p : mesh.positions) {
      corners.push_back(piece.world_from_body * (Vec3(p) * piece.scale));
      box.include(corners.back());
    }
    if (box.empty() || !frames_.touches(box)) return;
    random_ = RandomStream(number, "seen_surface");
    owed_ = random_.uniform();
    for (const auto& t : mesh.triangles) add_triangle(corners[t[0]], corners[t[1]], corners[t[2]]);
  }

  // The plane z = 0, square by square.
  void add_ground() {
    const int squares = int(std::ceil(kCell / spacing_));
    random_ = RandomStream(0, "seen_ground");
    std::int64_t last = -1;
    for (const auto& entry : frames_.entries()) {
      if (entry.cell == last) continue;
      last = entry.cell;
      constexpr std::int64_t kMask = (1 << 21) - 1, kHalf = 1 << 20;
      if ((entry.cell & kMask) != kHalf) continue;  // not the layer that begins at z = 0
      const double x = double((entry.cell >> 42) - kHalf) * kCell;
      const double y = double(((entry.cell >> 21) & kMask) - kHalf) * kCell;
      // spacing^2 a point on average, also where it does not divide the cell.
      const double chance = kCell * kCell / (spacing_ * spacing_ * squares * squares);
      for (int i = 0; i < squares * squares; ++i) {
        const double u = random_.uniform(), v = random_.uniform();
        if (random_.uniform() >= chance) continue;
        points_.push_back({x + kCell * (i % squares + u) / squares,
                           y + kCell * (i / squares + v) / squares, kGroundReach});
      }
    }
  }

  const std::vector<Vec3>& points() const { return points_; }

 private:
  void add_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a, ac = c - a;
    for (owed_ += norm(cross(ab, ac)) / 2 / (spacing_ * spacing_); owed_ >= 1; --owed_) {
      const double s = std::sqrt(random_.uniform()), t = random_.uniform();
      const Vec3 p = a + ab * (s * (1 - t)) + ac * (s * t);
      if (!has_space_key(p)) continue;
      const auto [first, last] = frames_.find(space_key_of(p, kCell));
      if (first != last) points_.push_back(p);
    }
  }

  const FramesOfCells& frames_;
  const double spacing_;
  RandomStream random_;
  double owed_ = 0;  // points that small triangles have not had yet
  std::vector<Vec3> points_;
};

bool is_seen(const Vec3& point, const FramesOfCells& frames, const PileQueries& queries,
             const RecordedViews& views) {
  const auto [first, last] = frames.find(space_key_of(point, kCell));
  for (auto entry = first; entry != last; ++entry) {
    if (!views.has_in_picture(entry->frame, point)) continue;
    const Vec3 ray = point - views.world_from_optical[entry->frame].translation;
    const double length = norm(ray);
    if (length <= kTouch) continue;
    if (!queries.cast_ray(point - ray, ray, length - kTouch)) return true;
  }
  return false;
}

}  // namespace

SeenPoints find_seen_surface(const PileState& pile, const std::vector<const TriangleMesh*>& meshes,
                             const PileQueries& queries, const RecordedViews& views,
                             double spacing, ThreadPool& pool) {
  const FramesOfCells frames(queries, views, pool);
  Sampler sampler(frames, spacing);
  for (std::size_t i = 0; i < pile.pieces.size(); ++i)
    if (pile.pieces[i].status != PieceStatus::lost)
      sampler.add_piece(pile.pieces[i], i, *meshes[std::size_t(pile.pieces[i].type)]);
  sampler.add_ground();
  const std::vector<Vec3>& points = sampler.points();
  std::vector<char> seen(points.size(), 0);
  pool.run(int(points.size()), 256, [&](int begin, int end) {
    for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i)
      seen[i] = is_seen(points[i], frames, queries, views);
  });
  SeenPoints surface;
  surface.spacing = spacing;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (seen[i]) surface.points.push_back(points[i]);
  return surface;
}

}  // namespace rubble
