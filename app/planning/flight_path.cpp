#include "app/planning/flight_path.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/planning/steep_views.h"
#include "kernel/voids/void_path.h"

namespace rubble {
namespace {

constexpr double kLookAhead = 0.8;  // along the way; unit: m
constexpr double kStepOfCheck = 0.004;
constexpr double kTouch = 1e-6;     // a sphere may be this much nearer than its radius; unit: m
constexpr int kRoundings = 4;       // passes of corner cutting

std::string words(const Vec3& v) {
  char text[96];
  std::snprintf(text, sizeof text, "{%.2f, %.2f, %.2f}", v.x, v.y, v.z);
  return text;
}

std::string centimetres(double metres) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f m", metres);
  return text;
}

std::string key_of(std::size_t waypoint) {
  return "trajectory.waypoints[" + std::to_string(waypoint + 1) + "]";
}

class LegPlanner {
 public:
  LegPlanner(const PileGeometry& geometry, const PileSpace& space, double radius)
      : geometry_(geometry), pile_space_(space), radius_(radius) {}

  // From a to b, both included.
  std::vector<Vec3> plan(const Vec3& a, const Vec3& b, std::size_t goal) const {
    const Vec3 from = place(a, goal - 1), to = place(b, goal);
    if (is_straight_free(from, to)) return {from, to};
    std::vector<Vec3> points = search(from, to, goal);
    for (int pass = 0; pass < kRoundings; ++pass) points = rounded(points);
    return points;
  }

 private:
  const VoidSpace& space() const { return pile_space_.map().space; }
  bool inside(const Vec3& p) const {
    const VoxelGrid& grid = space().grid;
    const Vec3 low = grid.corner, high = far_corner();
    return p.x > low.x && p.y > low.y && p.z > low.z && p.x < high.x && p.y < high.y &&
           p.z < high.z;
  }
  Vec3 far_corner() const {
    const VoxelGrid& grid = space().grid;
    return grid.corner + Vec3(grid.size[0], grid.size[1], grid.size[2]) * grid.voxel;
  }
  // The nearest point of the grid: outside of it there is nothing but the ground.
  Vec3 clamped(const Vec3& p) const {
    const double inset = 1.5 * space().grid.voxel;
    const Vec3 margin{inset, inset, inset};
    return min(max(p, space().grid.corner + margin), far_corner() - margin);
  }

  // Where the sphere has room at a waypoint: there, or very near.
  Vec3 place(const Vec3& p, std::size_t waypoint) const {
    if (geometry_.queries.clearance(p, radius_ + 0.01) >= radius_ || !inside(p)) return p;
    const NearestPlace near = find_nearest_place(space(), p, radius_ + 0.5 * space().grid.voxel, 0.5);
    if (near.found) return near.position;
    throw InputError({"", 0, key_of(waypoint) + ".position", "the camera's body does not fit there",
                      centimetres(radius_) + " to the nearest surface",
                      centimetres(geometry_.queries.clearance(p)) + " at " + words(p),
                      "move it, or make trajectory.radius smaller"});
  }

  bool is_straight_free(const Vec3& a, const Vec3& b) const {
    const double length = distance(a, b);
    for (double s = 0; s < length;) {
      const double room =
          geometry_.queries.clearance(a + (b - a) * (s / length), radius_ + 2.0) - radius_;
      if (room < -kTouch) return false;
      s += std::max(room, kStepOfCheck);
    }
    return geometry_.queries.clearance(b, radius_ + 0.01) >= radius_ - kTouch;
  }

  std::vector<Vec3> search(const Vec3& from, const Vec3& to, std::size_t goal) const {
    const Vec3 entry = clamped(from), exit = clamped(to);
    // Cells are asked at their centres, so a little more than the radius is kept.
    FoundPath found;
    for (const double extra : {0.25, 0.5, 0.75, 1.0}) {
      found = find_path(space(), entry, exit, radius_ + extra * space().grid.voxel);
      if (!found.found) break;
      std::vector<Vec3> points = found.points;
      // From the place itself, not from the middle of its cell.
      if (inside(from)) points.erase(points.begin());
      if (inside(to)) points.pop_back();
      points.insert(points.begin(), from);
      points.push_back(to);
      if (is_free(points)) return points;
    }
    fail(found, from, to, goal);
  }

  bool is_free(const std::vector<Vec3>& points) const {
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
      if (!is_straight_free(points[i], points[i + 1])) return false;
    return true;
  }

  [[noreturn]] void fail(const FoundPath& found, const Vec3& from, const Vec3& to,
                         std::size_t goal) const {
    const std::string way = "from " + words(from) + " to " + words(to);
    throw InputError(
        {"", 0, key_of(goal) + ".position", "no path " + way, "a path for a radius of " + centimetres(radius_),
         found.narrowest_radius > 0 ? "a path for " + centimetres(found.narrowest_radius) +
                                          " at most, narrowest at " + words(found.narrowest)
                                    : "no path for any radius",
         "make trajectory.radius smaller, or move the waypoint"});
  }

  // Cuts each corner a quarter of the way along its legs (Chaikin 1974), where there is room.
  std::vector<Vec3> rounded(const std::vector<Vec3>& points) const {
    if (points.size() < 3) return points;
    std::vector<Vec3> result{points.front()};
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      const Vec3 before = points[i] + (points[i - 1] - points[i]) * 0.25;
      const Vec3 after = points[i] + (points[i + 1] - points[i]) * 0.25;
      if (is_straight_free(before, after)) {
        result.push_back(before);
        result.push_back(after);
      } else {
        result.push_back(points[i]);
      }
    }
    result.push_back(points.back());
    return result;
  }

  const PileGeometry& geometry_;
  const PileSpace& pile_space_;
  double radius_;
};

// The point `ahead` metres further along the way from its point i; beyond the end straight on.
Vec3 look_ahead(const std::vector<Vec3>& points, std::size_t i, double ahead) {
  for (; i + 1 < points.size(); ++i) {
    const double length = distance(points[i], points[i + 1]);
    if (length >= ahead) return points[i] + (points[i + 1] - points[i]) * (ahead / length);
    ahead -= length;
  }
  Vec3 last = points.back() - points.front();
  for (std::size_t k = points.size(); k-- > 1;)
    if (distance(points[k], points[k - 1]) > 1e-6) {
      last = points[k] - points[k - 1];
      break;
    }
  return points.back() + normalized(last) * ahead;
}

// A leg as waypoints, without its first; the last is the user's own, moved to where there is room. What both ends look at,
// as those of an orbit, the camera looks at in between. ahead: gets, for each of the new waypoints, whether it looks ahead.
void append_leg(const std::vector<Vec3>& points, const Waypoint& start, const Waypoint& goal, TrajectorySpec& spec,
                std::vector<bool>& ahead) {
  const bool one_target = start.look_at && goal.look_at && *start.look_at == *goal.look_at;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (distance(points[i], spec.waypoints.back().position) < 1e-4) continue;
    Waypoint w;
    const bool last = i + 1 == points.size();
    if (last) w = goal;
    if (one_target) w.look_at = goal.look_at;
    w.position = points[i];
    w.speed = goal.speed;
    ahead.push_back(!w.look_at && w.rpy_deg == Vec3{});
    if (ahead.back()) w.look_at = look_ahead(points, i, kLookAhead);
    spec.waypoints.push_back(w);
  }
}

}  // namespace

double plan_around(const PileGeometry& geometry, const PileSpace& space, TrajectorySpec& spec) {
  const LegPlanner planner(geometry, space, spec.radius);
  const std::vector<Waypoint> asked = spec.waypoints;
  std::vector<bool> ahead;
  double length = 0;
  spec.waypoints.clear();
  spec.interpolation = Interpolation::linear;
  Vec3 here = asked.front().position;
  for (std::size_t i = 1; i < asked.size(); ++i) {
    const std::vector<Vec3> points = planner.plan(here, asked[i].position, i);
    if (i == 1) {
      Waypoint start = asked.front();
      start.position = points.front();
      ahead.push_back(!start.look_at && start.rpy_deg == Vec3{});
      if (ahead.back()) start.look_at = look_ahead(points, 0, kLookAhead);
      spec.waypoints.push_back(start);
    }
    append_leg(points, asked[i - 1], asked[i], spec, ahead);
    for (std::size_t k = 0; k + 1 < points.size(); ++k) length += distance(points[k], points[k + 1]);
    here = points.back();
  }
  turn_steep_views(ahead, spec.waypoints);
  return length;
}

// Calls visit(t, position, room) along the path, nowhere farther apart than the room allows; visit
// gives whether to go on.
template <typename Visit>
void walk(const PileGeometry& geometry, const TrajectorySpec& spec, const Visit& visit) {
  const CameraPath trajectory(spec);
  const double duration = trajectory.duration(), frame = 1 / spec.rate_hz;
  for (double t = 0;;) {
    const Vec3 p = trajectory.at(t).translation;
    const double room = geometry.queries.clearance(p, spec.radius + 3.0);
    if (!visit(t, p, room) || t >= duration) return;
    // The next place that is not surely free: far from everything, the path is walked in long steps.
    const double slack = std::max(room - spec.radius, kStepOfCheck);
    double step = std::min(frame, duration - t);
    while (step > 1e-7 && distance(trajectory.at(t + step).translation, p) > slack) step *= 0.5;
    t = std::min(duration, t + step);
  }
}

NearestApproach check_contact(const PileGeometry& geometry, const TrajectorySpec& spec,
                              const PileState& pile) {
  NearestApproach nearest_approach;
  walk(geometry, spec, [&](double t, const Vec3& p, double room) {
    if (room < nearest_approach.clearance) nearest_approach = {room, p};
    if (room >= spec.radius - kTouch) return true;
    const auto nearest = geometry.queries.find_closest(p, 1000);
    char when[48];
    std::snprintf(when, sizeof when, "%.3f s (frame %d)", t, int(t * spec.rate_hz + 0.5));
    std::string what = "the ground";
    if (nearest && nearest->piece >= kFirstFineHeap)
      what = "fines, piece " + std::to_string(nearest->piece);
    else if (nearest && nearest->piece != kGroundPiece)
      what = pile.types[std::size_t(pile.pieces[std::size_t(nearest->piece)].type)] + ", piece " +
             std::to_string(nearest->piece);
    throw InputError({"", 0, "trajectory.plan", "the camera's body touches something",
                      "a clearance of " + centimetres(spec.radius) + " on the whole path",
                      centimetres(room) + " at " + when + ", at " + words(p) + ": " + what,
                      "move the waypoints, or use plan = \"avoid\" or \"ghost\""});
  });
  return nearest_approach;
}

namespace {

std::vector<Vec3> find_contacts(const PileGeometry& geometry, const TrajectorySpec& spec) {
  std::vector<Vec3> contacts;
  walk(geometry, spec, [&](double, const Vec3& p, double room) {
    if (room < spec.radius - kTouch) contacts.push_back(p);
    return true;
  });
  return contacts;
}

double distance_to_leg(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 way = b - a;
  const double length2 = dot(way, way);
  const double s = length2 > 0 ? std::min(std::max(dot(p - a, way) / length2, 0.0), 1.0) : 0;
  return distance(p, a + way * s);
}

// Halves the speed of the legs that shape the path near the contacts.
void slow_down_at(const std::vector<Vec3>& contacts, TrajectorySpec& spec) {
  const double reach = 3 * *spec.smoothing;  // unit: s
  for (std::size_t i = 1; i < spec.waypoints.size(); ++i) {
    Waypoint& w = spec.waypoints[i];
    const double speed = w.speed.value_or(spec.speed);
    for (const Vec3& p : contacts) {
      if (distance_to_leg(p, spec.waypoints[i - 1].position, w.position) > reach * speed) continue;
      w.speed = 0.5 * speed;
      break;
    }
  }
}

}  // namespace

bool fit_smoothing(const PileGeometry& geometry, bool fixed, TrajectorySpec& spec) {
  constexpr int kMostTries = 10;
  constexpr double kLeastSmoothing = 0.02;  // 4 samples of a unit of 200 Hz; unit: s
  const bool may_slow = spec.plan == Plan::avoid;
  for (int i = 0;; ++i) {
    const std::vector<Vec3> contacts = find_contacts(geometry, spec);
    if (contacts.empty()) return true;
    if (i == kMostTries) return false;
    if (may_slow)
      slow_down_at(contacts, spec);
    else if (!fixed && *spec.smoothing >= 2 * kLeastSmoothing)
      *spec.smoothing *= 0.5;
    else
      return false;
  }
}

}  // namespace rubble
