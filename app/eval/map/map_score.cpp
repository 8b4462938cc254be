#include "app/eval/map/map_score.h"

#include <algorithm>
#include <optional>

#include "app/eval/scores/point_grid.h"
#include "app/eval/scores/surface_score.h"

namespace rubble {
namespace {

constexpr int kGrain = 1024;

double share_within(const std::vector<double>& distances, double limit) {
  if (distances.empty()) return 0;
  const auto within = std::count_if(distances.begin(), distances.end(),
                                    [&](double d) { return d <= limit; });
  return double(within) / double(distances.size());
}

// The value that a share of them do not exceed.
double find_quantile(std::vector<double> values, double share) {
  const std::size_t at = std::min(values.size() - 1, std::size_t(share * double(values.size())));
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(at), values.end());
  return values[at];
}

template <typename Score>
void set_shares(Score& score) {
  score.within_1cm = share_within(score.distances, 0.01);
  score.within_2cm = share_within(score.distances, 0.02);
  score.within_5cm = share_within(score.distances, kNearSurface);
}

// A mesh as the only piece of a pile, to be asked exactly.
class MapSurface {
 public:
  explicit MapSurface(const PlyMesh& map) {
    TriangleMesh mesh;
    for (const Vec3& p : map.positions) mesh.positions.push_back(Vec3f(p));
    mesh.triangles = map.triangles;
    PileState pile;
    pile.types = {"map"};
    pile.pieces.resize(1);
    pile.pieces.front().status = PieceStatus::fixed;
    queries_.emplace(pile, std::vector<const TriangleMesh*>{&mesh}, false);
  }

  double find_distance(const Vec3& place) const {
    const auto closest = queries_->find_closest(place, kNearSurface);
    return closest ? closest->distance : 2 * kNearSurface;
  }

 private:
  std::optional<PileQueries> queries_;
};

}  // namespace

MapAccuracy calc_map_accuracy(const std::vector<Vec3>& points, const PileQueries& truth,
                              const SeenPoints& seen, ThreadPool& pool) {
  MapAccuracy score;
  score.distances.resize(points.size());
  std::vector<char> unseen(points.size(), 0);
  const PointGrid grid(seen.points, kNearSurface);
  pool.run(int(points.size()), kGrain, [&](int begin, int end) {
    for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
      const auto closest = truth.find_closest(points[i], kFarthest);
      score.distances[i] = closest ? closest->distance : kFarthest;
      unseen[i] = !closest || grid.find_distance(closest->point) >= kNearSurface;
    }
  });
  set_shares(score);
  score.median = find_quantile(score.distances, 0.5);
  score.percentile_90 = find_quantile(score.distances, 0.9);
  score.unseen = double(std::count(unseen.begin(), unseen.end(), 1)) / double(points.size());
  return score;
}

MapCompleteness calc_map_completeness(const PlyMesh& map, const SeenPoints& seen,
                                      ThreadPool& pool) {
  MapCompleteness score;
  score.distances.resize(seen.points.size());
  const auto measure = [&](const auto& surface) {
    pool.run(int(seen.points.size()), kGrain, [&](int begin, int end) {
      for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i)
        score.distances[i] = surface.find_distance(seen.points[i]);
    });
  };
  if (map.triangles.empty())
    // A little wider, so that a point at 5 cm sharp counts.
    measure(PointGrid(map.positions, 1.000001 * kNearSurface));
  else
    measure(MapSurface(map));
  set_shares(score);
  return score;
}

}  // namespace rubble
