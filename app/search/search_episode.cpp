#include "app/search/search_episode.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/error.h"

namespace rubble {
namespace {

constexpr int kSeenStride = 4;        // of the pixels whose rays show cells, each way
constexpr double kProbe = 0.25;       // of the radius: how finely a way is looked at for what stands in it

void expect_finite(const char* key, double value) {
  if (!std::isfinite(value)) throw InputError({"", 0, key, "not a finite number", "finite numbers", "nan or inf", ""});
}

double cut(double value, double limit) { return std::min(limit, std::max(-limit, value)); }

}  // namespace

SearchEpisode::SearchEpisode(const SearchWorld& world, std::uint64_t seed)
    : world_(world), noise_(seed, "search/thermal"), seen_cells_(world.voids().space.grid, world.reachable_cells()),
      reported_(world.targets().size(), -1) {
  const SearchRules& rules = world.rules();
  const auto pixels = std::size_t(rules.width) * std::size_t(rules.height);
  seen_.pose = world.start();
  seen_.depth.resize(pixels), seen_.thermal.resize(pixels), pieces_.resize(pixels);
  score_.victims = int(world.targets().size());
  seen_.reports_left = rules.reports_each * score_.victims;
  look();
}

void SearchEpisode::step(const SearchAction& action) {
  const SearchCommand& command = action.command;
  for (int k = 0; k < 3; ++k) expect_finite("velocity", command.velocity[k]);
  expect_finite("turn", command.turn);
  for (const Vec3& place : action.reports) {
    for (int k = 0; k < 3; ++k) expect_finite("report", place[k]);
    take_report(place);
  }
  done_ = done_ || action.done;
  if (over()) return;
  seen_.stopped = !fly(command);
  score_.collisions += seen_.stopped;
  ++steps_;
  seen_.time = steps_ * world_.rules().period;
  look();
}

// The nearest that was not found yet counts; a report of one that was found costs nothing but itself.
void SearchEpisode::take_report(const Vec3& place) {
  if (seen_.reports_left == 0) return;
  --seen_.reports_left;
  int nearest = -1;
  bool near_any = false;
  double best = world_.rules().report_within;
  for (std::size_t i = 0; i < reported_.size(); ++i) {
    const double d = distance(place, world_.targets()[i].victim.trunk);
    near_any = near_any || d <= world_.rules().report_within;
    if (reported_[i] < 0 && d <= best) best = d, nearest = int(i);
  }
  if (nearest >= 0) {
    reported_[std::size_t(nearest)] = score_.path;
    seen_.found = ++score_.found;
  } else if (!near_any) {
    ++score_.false_reports;
  }
}

bool SearchEpisode::fly(const SearchCommand& command) {
  const SearchRules& rules = world_.rules();
  seen_.pose.yaw += cut(command.turn, rules.turn_rate) * rules.period;
  Vec3 velocity = command.velocity;
  if (norm(velocity) > rules.speed) velocity = velocity * (rules.speed / norm(velocity));
  const Vec3 way = seen_.pose.world_from_body().rotation.rotate(velocity) * rules.period;
  const double length = norm(way);
  const int parts = std::max(1, int(std::ceil(length / (kProbe * rules.radius))));
  const Vec3 from = seen_.pose.position;
  for (int i = 1; length > 0 && i <= parts; ++i) {
    const Vec3 place = from + way * (double(i) / parts);
    if (!world_.is_free(place)) return false;
    score_.path += length / parts;
    seen_.pose.position = place;
  }
  return true;
}

void SearchEpisode::look() {
  const SearchRules& rules = world_.rules();
  const Pose pose = seen_.pose.world_from_body();
  world_.look(pose, seen_.depth, pieces_);
  for (std::size_t i = 0; i < pieces_.size(); ++i)
    seen_.thermal[i] = float((world_.is_victim(pieces_[i]) ? rules.body : rules.ambient) +
                             rules.thermal_noise * noise_.normal());
  mark_seen(pose);
}

void SearchEpisode::mark_seen(const Pose& world_from_camera) {
  const SearchRules& rules = world_.rules();
  for (int v = kSeenStride / 2; v < rules.height; v += kSeenStride)
    for (int u = kSeenStride / 2; u < rules.width; u += kSeenStride) {
      const auto pixel = std::size_t(v) * std::size_t(rules.width) + std::size_t(u);
      const Vec3 along = world_from_camera.rotation.rotate(world_.rays().direction(pixel));
      const double range = std::min(rules.max_range, double(seen_.depth[pixel]) / world_.rays().cosine(pixel));
      seen_cells_.mark(world_from_camera.translation, along, range);
    }
}

bool SearchEpisode::over() const {
  return done_ || score_.found == score_.victims || seen_.time >= world_.rules().time_limit - 1e-9;
}

SearchScore SearchEpisode::score() const {
  SearchScore score = score_;
  score.time = seen_.time;
  score.coverage = seen_cells_.share();
  for (std::size_t i = 0; i < reported_.size(); ++i) {
    const double shortest = world_.targets()[i].shortest;
    if (reported_[i] < 0 || !std::isfinite(shortest)) continue;
    const double longest = std::max(shortest, reported_[i]);
    score.spl += longest > 0 ? shortest / longest : 1;
  }
  score.spl /= double(reported_.size());
  return score;
}

}  // namespace rubble
