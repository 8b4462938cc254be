#include "app/search/heat_reports.h"

#include <algorithm>


namespace rubble {
namespace {

constexpr double kWarm = 5;       // above the debris; unit: K
constexpr double kOneBody = 1.0;  // from the middle of a spot to points that belong to it; unit: m
constexpr double kApart = 0.06;   // between points that are kept; unit: m
constexpr double kClose = 2.5;    // from where a spot is seen well enough; unit: m
constexpr std::size_t kEnough = 12;  // points that make a spot

}  // namespace

HeatReports::HeatReports(const SearchBriefing& briefing)
    : rules_(briefing.rules), rays_(search_camera(briefing.rules), briefing.rules.max_range) {}

Vec3 HeatReports::Spot::middle() const {
  Vec3 sum;
  for (const Vec3& p : points) sum += p;
  return sum * (1.0 / double(points.size()));
}

void HeatReports::add(const Vec3& point, double range) {
  auto at = std::find_if(spots_.begin(), spots_.end(),
                         [&](const Spot& s) { return distance(s.middle(), point) < kOneBody; });
  if (at == spots_.end()) at = spots_.insert(spots_.end(), Spot());
  at->nearest = std::min(at->nearest, range);
  const bool known = std::any_of(at->points.begin(), at->points.end(),
                                 [&](const Vec3& p) { return distance(p, point) < kApart; });
  if (!known) at->points.push_back(point);
}

std::vector<Vec3> HeatReports::update(const SearchObservation& seen) {
  const Pose body = seen.pose.world_from_body();
  for (std::size_t i = 0; i < seen.depth.size(); ++i) {
    if (seen.thermal[i] < rules_.ambient + kWarm || !(seen.depth[i] < rules_.max_range)) continue;
    const double range = double(seen.depth[i]) / rays_.cosine(i);
    add(body * (rays_.direction(i) * range), range);
  }
  std::vector<Vec3> reports;
  for (Spot& spot : spots_) {
    if (spot.reported || spot.nearest > kClose || spot.points.size() < kEnough) continue;
    spot.reported = true;
    reports.push_back(spot.middle());
  }
  return reports;
}

}  // namespace rubble
