#include "kernel/fines/fine_sites.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/parallel.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"
#include "kernel/fines/resting.h"

namespace rubble {
namespace {

constexpr double kLeastRoom = 0.02;    // above a place; unit: m
constexpr double kAround = 0.9;        // beyond a piece, fines may lie on the ground; unit: m
constexpr double kSquare = 0.5;          // of the plan; unit: m
constexpr int kMostCells = 1 << 20;    // of the plan
constexpr int kMostSurfaces = 60;      // along one line
constexpr double kBeyond = 1e-6;       // from one surface to the next; unit: m
constexpr double kFarthest = 1.2;      // that is looked for walls; unit: m
constexpr double kEyeHeight = 0.03;    // of that look; unit: m
constexpr int kDirections = 8;         // of that look

Aabb box_of(const PieceState& piece, const Aabb& mesh) {
  Aabb box;
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner{i & 1 ? mesh.max.x : mesh.min.x, i & 2 ? mesh.max.y : mesh.min.y, i & 4 ? mesh.max.z : mesh.min.z};
    box.include(piece.world_from_body * (corner * piece.scale));
  }
  return box;
}

bool is_scenery(int type, const StrewOptions& options) {
  return std::find(options.scenery.begin(), options.scenery.end(), type) != options.scenery.end();
}

// The squares of the ground that are near a piece.
class Plan {
 public:
  Plan(const PileState& pile, const std::vector<const TriangleMesh*>& meshes, const StrewOptions& options) {
    std::vector<Aabb> of_type(meshes.size()), boxes;
    for (std::size_t t = 0; t < meshes.size(); ++t)
      if (meshes[t]) of_type[t] = meshes[t]->bounds();
    for (const PieceState& piece : pile.pieces) {
      const auto type = std::size_t(piece.type);
      if (piece.status == PieceStatus::lost || is_scenery(piece.type, options) || of_type[type].empty()) continue;
      boxes.push_back(box_of(piece, of_type[type]));
      around_.include(boxes.back().min), around_.include(boxes.back().max);
    }
    if (!boxes.empty()) mark(boxes);
  }

  std::size_t size() const { return squares_.size(); }
  double top() const { return around_.max.z; }
  // u, v: in the square, each from 0 to 1.
  Vec3 place(std::size_t square, double u, double v) const {
    const int n = squares_[square];
    return {low_.x + (n % columns_ + u) * cell_, low_.y + (n / columns_ + v) * cell_, 0};
  }

 private:
  void mark(const std::vector<Aabb>& boxes) {
    low_ = around_.min - Vec3(kAround, kAround, 0);
    const Vec3 size = around_.max - around_.min + Vec3(2 * kAround, 2 * kAround, 0);
    while (size.x / cell_ * (size.y / cell_) > kMostCells) cell_ *= 2;
    columns_ = int(size.x / cell_) + 1;
    const int rows = int(size.y / cell_) + 1;
    std::vector<std::uint8_t> near(std::size_t(columns_) * std::size_t(rows), 0);
    const auto at = [this](double x, double low, int most) {
      return std::clamp(int(std::floor((x - low) / cell_)), 0, most - 1);
    };
    for (const Aabb& box : boxes)
      for (int y = at(box.min.y - kAround, low_.y, rows); y <= at(box.max.y + kAround, low_.y, rows); ++y)
        for (int x = at(box.min.x - kAround, low_.x, columns_); x <= at(box.max.x + kAround, low_.x, columns_); ++x)
          near[std::size_t(y) * std::size_t(columns_) + std::size_t(x)] = 1;
    for (std::size_t i = 0; i < near.size(); ++i)
      if (near[i]) squares_.push_back(int(i));
  }

  Aabb around_;
  Vec3 low_;
  double cell_ = kSquare;
  int columns_ = 0;
  std::vector<int> squares_;
};

class Finder {
 public:
  Finder(const PileState& pile, const PileQueries& queries, const StrewOptions& options)
      : pile_(pile), queries_(queries), options_(options) {}

  // Everything that faces up along a line and is not inside of a piece.
  void look_along(Vec3 from, std::vector<FineSite>& sites) const {
    double ceiling = from.z;
    int inside = 0;
    for (int i = 0; i < kMostSurfaces; ++i) {
      const auto hit = queries_.cast_ray(from, {0, 0, -1}, from.z + 100);
      if (!hit) return;
      const bool enters = hit->normal.z > 0;
      if (enters && inside == 0 && hit->normal.z > kSteepestRest && ceiling - hit->point.z > kLeastRoom)
        sites.push_back(describe(*hit, ceiling - hit->point.z));
      if (hit->piece == kGroundPiece) return;
      inside = std::max(0, inside + (enters ? 1 : -1));
      if (!enters) ceiling = hit->point.z;
      from.z = hit->point.z - kBeyond;
    }
  }

 private:
  bool is_ground(int host) const {
    return host == kGroundPiece || is_scenery(pile_.pieces[std::size_t(host)].type, options_);
  }

  FineSite describe(const RayHit& hit, double headroom) const {
    FineSite site;
    site.point = hit.point, site.normal = hit.normal, site.host = hit.piece, site.headroom = headroom;
    site.wall = kFarthest;
    const Vec3 eye = hit.point + Vec3(0, 0, std::min(kEyeHeight, 0.5 * headroom));
    for (int i = 0; i < kDirections; ++i) {
      const auto [s, c] = portable::sincos(2 * portable::kPi * (i + 0.5) / kDirections);
      const auto met = queries_.cast_ray(eye, {c, s, 0}, kFarthest);
      if (!met || is_ground(met->piece)) continue;
      site.corner += std::max(0.0, 1 - met->distance / kCornerReach) / kDirections;
      if (met->distance >= site.wall) continue;
      site.wall = met->distance, site.to_wall = {c, s, 0}, site.source = met->piece;
    }
    if (!is_ground(site.host))
      site.source = site.host;
    else if (headroom > 0 && site.source >= 0)
      site.away = site.wall;
    else
      site.away = kFarthest;
    return site;
  }

  const PileState& pile_;
  const PileQueries& queries_;
  const StrewOptions& options_;
};

}  // namespace

std::vector<FineSite> find_fine_sites(const PileState& pile, const std::vector<const TriangleMesh*>& meshes,
                                      const PileQueries& queries, int lines, const StrewOptions& options) {
  const Plan plan(pile, meshes, options);
  if (plan.size() == 0) return {};
  const Finder finder(pile, queries, options);
  constexpr std::size_t kLinesPerJob = 64;
  const std::size_t jobs = (std::size_t(lines) + kLinesPerJob - 1) / kLinesPerJob;
  std::vector<std::vector<FineSite>> found(jobs);
  parallel_for(jobs, options.threads, [&](std::size_t job) {
    RandomStream random(options.seed, "fines.lines." + std::to_string(job));
    for (std::size_t k = 0; k < kLinesPerJob; ++k) {
      const std::size_t line = job * kLinesPerJob + k;
      if (line >= std::size_t(lines)) break;
      const double u = random.uniform(), v = random.uniform();
      Vec3 from = plan.place(line * plan.size() / std::size_t(lines), u, v);
      from.z = plan.top() + 0.1;
      finder.look_along(from, found[job]);
    }
  });
  std::vector<FineSite> sites;
  for (const std::vector<FineSite>& part : found) sites.insert(sites.end(), part.begin(), part.end());
  return sites;
}

FinePatches::FinePatches(std::uint64_t seed) {
  constexpr int kWaves = 10;
  constexpr double kShortest = 0.4, kGrowth = 1.25;  // of waves; unit: m
  RandomStream random(seed, "fines.patches");
  double length = kShortest;
  for (int i = 0; i < kWaves; ++i, length *= kGrowth)
    waves_.push_back({random.direction() * (2 * portable::kPi / length), random.uniform(0, 2 * portable::kPi)});
}

double FinePatches::at(const Vec3& place) const {
  constexpr double kContrast = 0.55;
  double sum = 0;
  for (const Wave& wave : waves_) sum += portable::cos(dot(wave.turn, place) + wave.phase);
  return portable::exp(kContrast * sum - 0.25 * kContrast * kContrast * double(waves_.size()));
}

namespace {

constexpr double kRoomCell = 0.05;  // unit: m

// Calls visit(key) for each cell that a ball's box is in, until it gives false.
template <typename Visit>
bool each_cell(const Vec3& centre, double radius, const Visit& visit) {
  const auto cell = [](double x) { return std::int64_t(std::floor(x / kRoomCell)); };
  const auto bits = [](std::int64_t i) { return std::uint64_t(i) & 0x1fffffu; };
  for (std::int64_t z = cell(centre.z - radius); z <= cell(centre.z + radius); ++z)
    for (std::int64_t y = cell(centre.y - radius); y <= cell(centre.y + radius); ++y)
      for (std::int64_t x = cell(centre.x - radius); x <= cell(centre.x + radius); ++x)
        if (!visit(bits(x) | bits(y) << 21 | bits(z) << 42)) return false;
  return true;
}

}  // namespace

bool RoomForFines::take(const Vec3& centre, double radius) {
  const auto is_free = [&](std::uint64_t key) {
    const auto found = cells_.find(key);
    if (found == cells_.end()) return true;
    for (const Ball& ball : found->second)
      if (distance(ball.centre, centre) < kFineCloseness * (ball.radius + radius)) return false;
    return true;
  };
  if (!each_cell(centre, radius, is_free)) return false;
  return each_cell(centre, radius, [&](std::uint64_t key) {
    cells_[key].push_back({centre, radius});
    return true;
  });
}

}  // namespace rubble
