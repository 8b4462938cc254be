#include "kernel/model/track.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/hash_pose.h"
#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

// How far the way between two keys may be from the mean of their velocities for a free flight: what
// single precision leaves of the velocities, and no more. unit: m; share of the way
constexpr double kFlightTolerance = 1e-6;
constexpr double kFlightShare = 1e-6;
constexpr double kFarthest = 1e6;  // of a body from the origin; unit: m

// A rotation as an axis of length 1 and an angle.
struct Turn {
  Vec3 axis{0, 0, 1};
  double angle = 0;  // unit: rad
};

Turn turn_between(const Quat& from, const Quat& to) {
  Quat q = to * from.conjugate();
  if (q.w < 0) q = {-q.w, -q.x, -q.y, -q.z};
  const Vec3 v{q.x, q.y, q.z};
  const double sine = norm(v);
  if (sine == 0) return {};
  return {v * (1 / sine), 2 * portable::atan2(sine, q.w)};
}

// The turn from one key to the next that comes nearest to what their angular velocities ask for.
Turn turn_between(const TrackKey& a, const TrackKey& b, double seconds) {
  constexpr double kWhole = 2 * portable::kPi;
  Turn turn = turn_between(a.world_from_body.rotation, b.world_from_body.rotation);
  const Vec3 asked = Vec3(a.angular_velocity + b.angular_velocity) * (0.5 * seconds);
  if (norm(asked) < portable::kPi) return turn;  // the shortest one is meant
  if (turn.angle < 1e-9) turn = {normalized(asked), 0};
  turn.angle += kWhole * std::floor((dot(asked, turn.axis) - turn.angle) / kWhole + 0.5);
  return turn;
}

Quat make_rotation(const Vec3& axis, double angle) {
  const portable::SinCos half = portable::sincos(0.5 * angle);
  const Vec3 v = axis * half.sin;
  return {half.cos, v.x, v.y, v.z};
}

// The motion of a body's centre between two keys, `share` of the time in.
struct CentreMotion {
  Vec3 position, velocity;
};

CentreMotion centre_between(const TrackBody& body, const TrackKey& a, const TrackKey& b,
                            double seconds, double share) {
  const Vec3 from = a.world_from_body * body.centre;
  const Vec3 way = b.world_from_body * body.centre - from;
  const Vec3 v0(a.linear_velocity), v1(b.linear_velocity);
  const Vec3 flown = (v0 + v1) * (0.5 * seconds);
  const double tolerance = kFlightTolerance + kFlightShare * norm(flown);
  if (distance(way, flown) > tolerance) return {from + way * share, way * (1 / seconds)};
  // What rounding left is spread evenly, so that the end is met.
  const Vec3 rest = way - flown;
  const Vec3 gain = v1 - v0;
  return {from + (v0 * share + gain * (0.5 * share * share)) * seconds + rest * share,
          v0 + gain * share + rest * (1 / seconds)};
}

bool finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

std::string find_fault_of(const TrackKey& key) {
  const Quat& q = key.world_from_body.rotation;
  const Vec3& p = key.world_from_body.translation;
  const double length = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  if (!finite(p) || !std::isfinite(length) || !finite(Vec3(key.linear_velocity)) ||
      !finite(Vec3(key.angular_velocity))) {
    return "a key has a number that is not finite";
  }
  if (std::abs(length - 1) > 0.01) return "a key has no rotation of length 1";
  for (int i = 0; i < 3; ++i)
    if (std::abs(p[i]) > kFarthest) return "a key is too far away";
  return {};
}

std::string find_fault_of(const TrackBody& body, std::size_t samples) {
  if (body.id < 0) return "a body has a negative number";
  if (!finite(body.centre) || norm(body.centre) > kFarthest) return "a body has no sensible centre";
  if (body.keys.empty()) return "a body has no key";
  for (std::size_t i = 0; i < body.keys.size(); ++i) {
    const TrackKey& key = body.keys[i];
    if (key.sample >= samples) return "a key is at a sample that the track does not have";
    if (i > 0 && key.sample <= body.keys[i - 1].sample) return "the keys of a body are out of order";
    if (std::string fault = find_fault_of(key); !fault.empty()) return fault;
  }
  if (body.gone == TrackBody::kStays) return {};
  if (body.gone >= samples || body.gone <= body.keys.back().sample) {
    return "a body goes at a sample that is before its last key or not in the track";
  }
  return {};
}

void add(StateHash& hash, const TrackBody& body) {
  hash.add(body.id);
  add(hash, body.centre);
  hash.add(body.gone);
  hash.add(std::uint64_t(body.keys.size()));
  for (const TrackKey& key : body.keys) {
    hash.add(key.sample);
    add(hash, key.world_from_body);
    add(hash, key.linear_velocity);
    add(hash, key.angular_velocity);
  }
}

}  // namespace

const TrackBody* Track::find(std::int32_t id) const {
  const auto at = std::lower_bound(bodies.begin(), bodies.end(), id,
                                   [](const TrackBody& b, std::int32_t i) { return b.id < i; });
  return at != bodies.end() && at->id == id ? &*at : nullptr;
}

std::optional<BodyMotion> Track::motion_at(const TrackBody& body, double time) const {
  const auto after =
      std::upper_bound(body.keys.begin(), body.keys.end(), time,
                       [this](double t, const TrackKey& key) { return t < times[key.sample]; });
  if (after == body.keys.begin()) return {};
  if (body.gone != TrackBody::kStays && time >= times[body.gone]) return {};
  const TrackKey& a = *(after - 1);
  if (after == body.keys.end() || a.world_from_body == after->world_from_body) {
    return BodyMotion{a.world_from_body, {}, {}};
  }
  const double start = times[a.sample], seconds = times[after->sample] - start;
  const double share = (time - start) / seconds;
  const CentreMotion centre = centre_between(body, a, *after, seconds, share);
  const Turn turn = turn_between(a, *after, seconds);
  BodyMotion motion;
  motion.world_from_body = a.world_from_body;
  motion.angular_velocity = turn.axis * (turn.angle / seconds);
  if (share > 0) {
    Pose& pose = motion.world_from_body;
    pose.rotation = normalized(make_rotation(turn.axis, share * turn.angle) * pose.rotation);
    pose.translation = centre.position - pose.rotation.rotate(body.centre);
  }
  const Vec3 arm = motion.world_from_body.rotation.rotate(body.centre);
  motion.linear_velocity = centre.velocity - cross(motion.angular_velocity, arm);
  return motion;
}

std::vector<std::optional<BodyMotion>> Track::poses_at(double time) const {
  std::vector<std::optional<BodyMotion>> out;
  out.reserve(bodies.size());
  for (const TrackBody& body : bodies) out.push_back(motion_at(body, time));
  return out;
}

bool Track::rests_throughout(const TrackBody& body, double from, double to) const {
  if (times[body.keys.front().sample] > from) return false;
  if (body.gone != TrackBody::kStays && times[body.gone] <= to) return false;
  for (std::size_t i = 1; i < body.keys.size(); ++i) {
    const TrackKey &a = body.keys[i - 1], &b = body.keys[i];
    if (times[a.sample] >= to) break;
    if (times[b.sample] > from && !(a.world_from_body == b.world_from_body)) return false;
  }
  return true;
}

std::uint64_t Track::hash() const {
  StateHash hash;
  hash.add(std::uint64_t(times.size()));
  for (const double time : times) hash.add(time);
  hash.add(std::uint64_t(bodies.size()));
  for (const TrackBody& body : bodies) add(hash, body);
  return hash.digest();
}

std::string Track::find_fault() const {
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!std::isfinite(times[i])) return "a sample has a time that is not finite";
    if (i > 0 && !(times[i] > times[i - 1])) return "the samples are out of order";
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (i > 0 && bodies[i].id <= bodies[i - 1].id) return "the bodies are out of order";
    if (std::string fault = find_fault_of(bodies[i], times.size()); !fault.empty()) return fault;
  }
  return {};
}

}  // namespace rubble
