#include "app/search/baselines.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"

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

// The two baselines that remember nothing, and what all of them share.

namespace {

// Ahead, up or down until something is in the way; then another direction.
class RandomWalk : public SearchAgent {
 public:
  explicit RandomWalk(const SearchBriefing& briefing)
      : rules_(briefing.rules), random_(briefing.seed, "search/random"), heat_(briefing) {
    choose();
  }

  SearchAction act(const SearchObservation& seen) override {
    if (seen.stopped) choose();
    SearchAction action;
    action.reports = heat_.update(seen);
    if (turn_left_ > 0) {
      turn_left_ -= rules_.period * rules_.turn_rate;
      action.command.turn = side_ * rules_.turn_rate;
    } else {
      action.command.velocity = {rules_.speed, 0, climb_};
    }
    return action;
  }

 private:
  void choose() {
    turn_left_ = random_.uniform(0.3, portable::kPi);
    side_ = random_.uniform() < 0.5 ? -1 : 1;
    climb_ = random_.uniform(-0.3, 0.3) * rules_.speed;
  }

  SearchRules rules_;
  RandomStream random_;
  HeatReports heat_;
  double turn_left_ = 0, side_ = 1, climb_ = 0;  // unit: rad, , m/s
};

// Keeps the wall at its right hand, and the middle between floor and ceiling.
class WallFollower : public SearchAgent {
 public:
  explicit WallFollower(const SearchBriefing& briefing) : rules_(briefing.rules), heat_(briefing) {}

  SearchAction act(const SearchObservation& seen) override {
    const double ahead = nearest(seen, 0.35, 0.65, 0.3, 0.7), right = nearest(seen, 0.85, 1, 0.3, 0.7);
    const double above = nearest(seen, 0.3, 0.7, 0, 0.15), below = nearest(seen, 0.3, 0.7, 0.85, 1);
    SearchAction action;
    action.reports = heat_.update(seen);
    SearchCommand& c = action.command;
    if (seen.stopped || ahead < kRoom) {
      blocked_ = std::min(blocked_ + 1, 40);
      c.turn = rules_.turn_rate;
      if (blocked_ > 10) c.velocity = {-0.3 * rules_.speed, 0, 0};  // in a corner
      if (blocked_ == 40) blocked_ = 0;
      return action;
    }
    blocked_ = 0;
    c.velocity = {rules_.speed, 0, std::clamp(0.5 * (std::min(above, 1.0) - std::min(below, 1.0)), -0.2, 0.2)};
    c.turn = std::clamp(2 * (kBeside - right), -0.6, 0.6) * rules_.turn_rate;
    return action;
  }

 private:
  static constexpr double kRoom = 0.5;    // ahead; unit: m
  static constexpr double kBeside = 0.6;  // to the right, at the picture's edge; unit: m

  // The least depth in a part of the picture, given in shares of its sides.
  double nearest(const SearchObservation& seen, double left, double right, double top, double bottom) const {
    double least = rules_.max_range;
    for (int v = int(top * rules_.height); v < int(bottom * rules_.height); ++v)
      for (int u = int(left * rules_.width); u < int(right * rules_.width); ++u)
        least = std::min(least, double(seen.depth[std::size_t(v * rules_.width + u)]));
    return least;
  }

  SearchRules rules_;
  HeatReports heat_;
  int blocked_ = 0;  // steps without room ahead
};

}  // namespace

double wrapped(double angle) {
  while (angle > portable::kPi) angle -= 2 * portable::kPi;
  while (angle < -portable::kPi) angle += 2 * portable::kPi;
  return angle;
}

SearchCommand fly_towards(const SearchPose& pose, const Vec3& place, const SearchRules& rules) {
  const Vec3 away = place - pose.position;
  const double flat = std::sqrt(away.x * away.x + away.y * away.y);
  SearchCommand command;
  const double off = flat > 0.05 ? wrapped(portable::atan2(away.y, away.x) - pose.yaw) : 0;
  command.turn = std::clamp(off / rules.period, -rules.turn_rate, rules.turn_rate);
  if (std::fabs(off) > 0.6) return command;
  const double turned = pose.yaw + command.turn * rules.period;  // the robot turns first, then flies
  const double c = portable::cos(turned), s = portable::sin(turned);
  const Vec3 velocity = away * (1 / rules.period);
  command.velocity = {c * velocity.x + s * velocity.y, c * velocity.y - s * velocity.x, velocity.z};
  return command;
}

std::unique_ptr<SearchAgent> make_random_walk(const SearchBriefing& briefing) {
  return std::make_unique<RandomWalk>(briefing);
}
std::unique_ptr<SearchAgent> make_wall_follower(const SearchBriefing& briefing) {
  return std::make_unique<WallFollower>(briefing);
}

std::vector<std::string> baseline_names() { return {"random", "wall", "frontier", "octomap", "oracle"}; }

InputError unknown_baseline(const std::string& name) {
  std::string expected;
  const std::vector<std::string> names = baseline_names();
  for (const std::string& known : names) expected += (expected.empty() ? "" : known == names.back() ? " or " : ", ") + known;
  return InputError({"", 0, "--baseline", "no such baseline", expected, "\"" + name + "\"", ""});
}

std::unique_ptr<SearchAgent> make_baseline(const std::string& name, const SearchBriefing& briefing,
                                           const SearchWorld& world) {
  if (name == "random") return make_random_walk(briefing);
  if (name == "wall") return make_wall_follower(briefing);
  if (name == "frontier") return make_frontier_explorer(briefing);
  if (name == "octomap") return make_octomap_explorer(briefing);
  if (name == "oracle") return make_oracle(briefing, world);
  throw unknown_baseline(name);
}

}  // namespace rubble
