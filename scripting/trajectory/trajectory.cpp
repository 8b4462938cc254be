#include "scripting/trajectory/trajectory.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/number_text.h"
#include "kernel/base/portable_math.h"
#include "scripting/trajectory/curves.h"
#include "scripting/values/value.h"

namespace rubble {
namespace {

constexpr double kDegree = portable::kPi / 180.0;
constexpr double kNearestTarget = 1e-3;  // unit: m; closer, a direction means nothing
constexpr double kMostFrames = 10'000'000;
constexpr double kShortestLeg = 1e-6;  // shorter, speeds are no numbers any more; unit: s
constexpr double kSoftest = 0.4;  // smoothing that max_jerk may ask for by itself; unit: s
constexpr double kUnknownWay = 1e-3;  // unit: m; of a leg to a void, for the order of times

std::string waypoint_key(std::size_t i, const char* name) {
  return "trajectory.waypoints[" + std::to_string(i + 1) + "]" + name;
}

bool finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

class Checker {
 public:
  explicit Checker(const TrajectorySpec& spec) : spec_(spec) {}

  std::vector<Diagnostic> run() {
    if (!(spec_.rate_hz > 0) || !std::isfinite(spec_.rate_hz))
      add("trajectory.rate_hz", "out of range", "a number above 0", plain_text(spec_.rate_hz));
    if (spec_.plan == Plan::avoid && spec_.waypoints.size() < 2)
      add("trajectory.waypoints", "the plan needs a destination", "at least two waypoints for the plan \"avoid\"",
          std::to_string(spec_.waypoints.size()));
    if (!(spec_.speed > 0) || !std::isfinite(spec_.speed))
      add("trajectory.speed", "out of range", "a number above 0", plain_text(spec_.speed));
    if (spec_.waypoints.empty())
      add("trajectory.waypoints", "no waypoint", "at least one", "an empty list");
    for (std::size_t i = 0; i < spec_.waypoints.size(); ++i) {
      check_numbers(i);
      check_view(i);
      check_time(i);
    }
    if (spec_.duration) time_ = *spec_.duration;
    if (spec_.duration && !(*spec_.duration >= kShortestLeg))
      add("trajectory.duration", "too short", "at least a microsecond",
          exact_text(*spec_.duration) + " s");
    if (spec_.smoothing && !(*spec_.smoothing >= 0 && *spec_.smoothing <= 2))
      add("trajectory.smoothing", "out of range", "a number from 0 to 2",
          plain_text(*spec_.smoothing));
    const bool smooth = spec_.limits.max_jerk || spec_.rest_at_ends;
    if (spec_.smoothing && *spec_.smoothing == 0 && smooth)
      add("trajectory.smoothing",
          std::string("contradicts ") + (spec_.limits.max_jerk ? "max_jerk" : "rest_at_ends"),
          "a number above 0, or nothing", "0");
    if (mistakes_.empty() && !(time_ * spec_.rate_hz < kMostFrames))
      add("trajectory", "too long", "at most 10000000 frames", plain_text(time_ * spec_.rate_hz));
    return std::move(mistakes_);
  }

 private:
  void add(std::string key, std::string message, std::string expected, std::string found,
           std::string hint = {}) {
    mistakes_.push_back({"", 0, std::move(key), std::move(message), std::move(expected),
                         std::move(found), std::move(hint)});
  }

  void check_numbers(std::size_t i) {
    const Waypoint& w = spec_.waypoints[i];
    const auto check = [&](bool ok, const char* name) {
      if (!ok) add(waypoint_key(i, name), "not finite", "finite numbers", "");
    };
    check(finite(w.position), ".position");
    check(finite(w.rpy_deg), ".rpy_deg");
    check(!w.look_at || finite(*w.look_at), ".look_at");
    check(!w.t || std::isfinite(*w.t), ".t");
    if (w.speed && (!(*w.speed > 0) || !std::isfinite(*w.speed)))
      add(waypoint_key(i, ".speed"), "out of range", "a number above 0", plain_text(*w.speed));
  }

  void check_view(std::size_t i) {
    const Waypoint& w = spec_.waypoints[i];
    if (!w.look_at && !w.look_at_in_void) return;
    if (w.look_at && !w.position_in_void && distance(*w.look_at, w.position) < kNearestTarget)
      add(waypoint_key(i, ".look_at"), "nothing to look at", "a point away from the camera",
          "the camera's own position");
    if (w.rpy_deg.y != 0 || w.rpy_deg.z != 0)
      add(waypoint_key(i, ".rpy_deg"), "contradicts look_at", "{roll, 0, 0} beside look_at",
          "a pitch or a yaw", "keep one of the two");
  }

  void check_time(std::size_t i) {
    const Waypoint& w = spec_.waypoints[i];
    if (w.t && w.speed)
      add(waypoint_key(i, ".speed"), "contradicts t", "one of t and speed", "both");
    if (i == 0) {
      if (w.t && *w.t != 0)
        add(waypoint_key(i, ".t"), "the first waypoint is the start", "0", plain_text(*w.t));
      if (w.speed)
        add(waypoint_key(i, ".speed"), "the first waypoint has no speed", "nothing",
            plain_text(*w.speed));
      return;
    }
    if (w.t && spec_.plan == Plan::avoid)
      return add(waypoint_key(i, ".t"), "contradicts the plan \"avoid\"",
                 "`speed`, because the length of the path is not known yet", plain_text(*w.t));
    const bool unknown = w.position_in_void || spec_.waypoints[i - 1].position_in_void;
    const double length =
        unknown ? kUnknownWay : distance(w.position, spec_.waypoints[i - 1].position);
    const double next = w.t ? *w.t : time_ + length / w.speed.value_or(spec_.speed);
    if (w.t && !(*w.t > time_))
      add(waypoint_key(i, ".t"), "times do not increase", "a time after " + plain_text(time_) + " s",
          plain_text(*w.t));
    else if (!w.t && length == 0)
      add(waypoint_key(i, ""), "no time passes", "a `t` where the camera stays in place",
          "the position of the waypoint before");
    else if (!std::isfinite(next))
      add(waypoint_key(i, ""), "never reached", "a speed at which the way takes less than 1e300 s",
          plain_text(w.speed.value_or(spec_.speed)) + " m/s");
    else if (!(next - time_ >= kShortestLeg))
      add(waypoint_key(i, w.t ? ".t" : ""), "too soon after the waypoint before",
          "at least a microsecond between two waypoints", exact_text(next - time_) + " s");
    if (std::isfinite(next) && next > time_) time_ = next;
  }

  const TrajectorySpec& spec_;
  std::vector<Diagnostic> mistakes_;
  double time_ = 0;
};

Quat rotation_of(const Vec3& rpy_deg) {
  return portable::quat_from_rpy(rpy_deg.x * kDegree, rpy_deg.y * kDegree, rpy_deg.z * kDegree);
}

// X to the target, no part of Y along the world's Z but for the roll. Straight up or down the yaw
// is 0.
Quat rotation_towards(const Vec3& direction, double roll_deg) {
  const double level = std::sqrt(direction.x * direction.x + direction.y * direction.y);
  return portable::quat_from_rpy(roll_deg * kDegree, portable::atan2(-direction.z, level),
                                 portable::atan2(direction.y, direction.x));
}

Quat rotation_at(const Waypoint& w) {
  return w.look_at ? rotation_towards(*w.look_at - w.position, w.rpy_deg.x)
                   : rotation_of(w.rpy_deg);
}

// What the camera looks at; without a look_at a point ahead of it, which only shapes the curve.
Vec3 target_of(const Waypoint& w) {
  return w.look_at ? *w.look_at : w.position + rotation_at(w).rotate({2, 0, 0});
}

std::vector<double> times_of(const TrajectorySpec& spec) {
  std::vector<double> times{0.0};
  for (std::size_t i = 1; i < spec.waypoints.size(); ++i) {
    const Waypoint& w = spec.waypoints[i];
    const double length = distance(w.position, spec.waypoints[i - 1].position);
    times.push_back(w.t ? *w.t : times.back() + length / w.speed.value_or(spec.speed));
  }
  return times;
}

template <typename F>
auto collect(const TrajectorySpec& spec, F get) {
  std::vector<decltype(get(spec.waypoints[0]))> all;
  for (const Waypoint& w : spec.waypoints) all.push_back(get(w));
  return all;
}

// The body's angular velocity while it turns by rotation_towards: `direction` changes at
// `direction_rate`, the roll is `roll` and changes at `roll_rate`. unit: rad.
// From R = Rz(yaw) Ry(pitch) Rx(roll), yaw = atan2(y, x), pitch = atan2(-z, level).
Vec3 turning_rate(const Vec3& direction, const Vec3& direction_rate, double roll,
                  double roll_rate) {
  const Vec3 &d = direction, &r = direction_rate;
  const double level2 = d.x * d.x + d.y * d.y, level = std::sqrt(level2);
  if (level < kNearestTarget) return {roll_rate, 0, 0};  // straight up or down: yaw is undefined
  const double length = norm(d), level_rate = (d.x * r.x + d.y * r.y) / level;
  const double yaw_rate = (d.x * r.y - d.y * r.x) / level2;
  const double pitch_rate = (d.z * level_rate - r.z * level) / (length * length);
  const double sin_pitch = -d.z / length, cos_pitch = level / length;
  const portable::SinCos turn = portable::sincos(roll);
  return {roll_rate - yaw_rate * sin_pitch, pitch_rate * turn.cos + yaw_rate * turn.sin * cos_pitch,
          yaw_rate * turn.cos * cos_pitch - pitch_rate * turn.sin};
}

}  // namespace

Waypoint default_view() {
  Waypoint w;
  w.position = {-9, 0, 4};
  w.look_at = Vec3{0, 0, 0.5};
  return w;
}

Pose Ride::link_from_rig() const { return {rotation_of(rpy_deg), position}; }

std::vector<Diagnostic> find_mistakes(const TrajectorySpec& spec) { return Checker(spec).run(); }

class CameraPath::Curves {
 public:
  explicit Curves(const TrajectorySpec& spec)
      : waypoints_(spec.waypoints),
        times_(times_of(spec)),
        positions_(collect(spec, [](const Waypoint& w) { return w.position; }), times_,
                   spec.interpolation),
        targets_(collect(spec, target_of), times_, spec.interpolation),
        rolls_(collect(spec,
                       [](const Waypoint& w) {
                         return Vec3{w.rpy_deg.x, 0, 0};
                       }),
               times_, spec.interpolation),
        rotations_(collect(spec, rotation_at), times_, spec.interpolation) {}

  double duration() const { return times_.back(); }
  const std::vector<double>& times() const { return times_; }

  Pose at(double t) const {
    if (times_.size() == 1) return {rotation_at(waypoints_[0]), waypoints_[0].position};
    const std::size_t leg = leg_at(t);
    const Vec3 position = positions_.at(leg, t);
    if (!looks(leg, t)) return {rotations_.at(leg, t), position};
    return {rotation_towards(targets_.at(leg, t) - position, rolls_.at(leg, t).x), position};
  }

  CameraMotion motion_at(double t) const {
    CameraMotion motion;
    motion.world_from_camera = at(t);
    if (times_.size() == 1) return motion;
    const std::size_t leg = leg_at(t);
    motion.velocity = positions_.rate(leg, t);
    motion.acceleration = positions_.second(leg, t);
    if (!looks(leg, t)) {
      motion.angular_velocity = rotations_.angular_velocity(leg, t);
      return motion;
    }
    motion.angular_velocity = turning_rate(
        targets_.at(leg, t) - positions_.at(leg, t), targets_.rate(leg, t) - motion.velocity,
        rolls_.at(leg, t).x * kDegree, rolls_.rate(leg, t).x * kDegree);
    return motion;
  }

 private:
  std::size_t leg_at(double t) const {
    const auto after = std::upper_bound(times_.begin() + 1, times_.end() - 1, t);
    return std::size_t(after - times_.begin()) - 1;
  }

  // Whether a target leads the view there, rather than the waypoints' own rotations.
  bool looks(std::size_t leg, double t) const {
    return waypoints_[leg].look_at && waypoints_[leg + 1].look_at &&
           distance(targets_.at(leg, t), positions_.at(leg, t)) >= kNearestTarget;
  }

  std::vector<Waypoint> waypoints_;
  std::vector<double> times_;
  VectorCurve positions_, targets_, rolls_;
  RotationCurve rotations_;
};

bool TrajectorySpec::needs_pile() const {
  for (const Waypoint& w : waypoints)
    if (w.position_in_void || w.look_at_in_void) return true;
  return plan != Plan::ghost;
}

// Fine enough that a limit is kept to a thousandth between its entries; unit: s.
static double table_step(double duration, double rate_hz) {
  constexpr double kMostEntries = 1e6;
  return std::max(duration / kMostEntries, std::min(duration / 2000, 0.125 / rate_hz));
}

// Before a list of so many entries is made.
static void check_size_of_path(const TrajectorySpec& spec, double duration, double knot) {
  const double frames = duration * spec.rate_hz, knots = knot > 0 ? duration / knot : 0;
  if (frames < kMostFrames && knots < kMostFrames) return;
  const SpeedLimits& limits = spec.limits;
  const char* const key = frames < kMostFrames       ? "trajectory.smoothing"
                          : limits.max_speed         ? "trajectory.max_speed"
                          : limits.max_turn_rate_deg ? "trajectory.max_turn_rate_deg"
                          : limits.max_acceleration  ? "trajectory.max_acceleration"
                          : limits.max_jerk          ? "trajectory.max_jerk"
                                                     : "trajectory";
  throw InputError({"", 0, key, "the path takes too long", "at most 10000000 frames, and as many steps of smoothing",
                    exact_text(duration) + " s, " + exact_text(std::floor(frames)) + " frames at " +
                        exact_text(spec.rate_hz) + " Hz",
                    limits.any() ? "the limits slow the path down; speeds are in m/s" : ""});
}

CameraPath::CameraPath(const TrajectorySpec& spec) {
  std::vector<Diagnostic> mistakes = find_mistakes(spec);
  for (std::size_t i = 0; i < spec.waypoints.size(); ++i)
    if (spec.waypoints[i].position_in_void || spec.waypoints[i].look_at_in_void)
      mistakes.push_back({"", 0, waypoint_key(i, ""), "a place in a void",
                          "a place that is known before the pile has settled", "", ""});
  if (!mistakes.empty()) throw InputError(std::move(mistakes));
  curves_ = std::make_unique<const Curves>(spec);
  asked_duration_ = curves_->duration();
  if (spec.duration && asked_duration_ > 0) asked_duration_ = *spec.duration;
  const double stretch = asked_duration_ > 0 ? curves_->duration() / asked_duration_ : 1;
  std::vector<double> corners = curves_->times();
  for (double& t : corners) t /= stretch;
  scale_ = TimeScale([&](double t) { return curves_->at(t * stretch); }, corners, asked_duration_,
                     table_step(asked_duration_, spec.rate_hz), spec.limits, spec.rest_at_ends);
  const bool smooth = spec.limits.max_jerk || spec.rest_at_ends;
  knot_ = spec.smoothing.value_or(smooth ? kUsualSmoothing : 0);
  check_size_of_path(spec, scale_.duration(asked_duration_), knot_);
  if (!(knot_ > 0) || !(asked_duration_ > 0)) return;
  make_smooth(spec);
  if (spec.limits.max_jerk) fit_jerk(spec);
}

CameraPath::~CameraPath() = default;

// The path before smoothing is walked at 1 / slower_ of its speed.
void CameraPath::make_smooth(const TrajectorySpec& spec) {
  const double length = scale_.duration(asked_duration_);
  check_size_of_path(spec, length * slower_, knot_);
  smooth_.emplace(
      [&](double t) { return curves_->at(own_time(std::min(t / slower_, length)).time); },
      length * slower_, knot_, spec.rest_at_ends ? PathEnds::at_rest : PathEnds::moving);
  const auto wild = smooth_->wildest_turn();
  if (!wild) return;
  throw InputError({"", 0, "trajectory", "the view turns too fast to be made smooth",
                    "at most 90 degrees within " + plain_text(knot_) + " s",
                    plain_text(std::round(wild->angle_deg)) + " degrees at " + plain_text(wild->time) + " s",
                    "an inertial unit or max_jerk needs a smooth path: turn slower, look at a point "
                    "that is not passed straight above or below, or set trajectory.smoothing"});
}

// Softer corners first, then a slower path.
void CameraPath::fit_jerk(const TrajectorySpec& spec) {
  constexpr int kMostTries = 60;
  const double most = *spec.limits.max_jerk;
  for (int i = 0; i < kMostTries && smooth_->largest_jerk() > most; ++i) {
    if (!spec.smoothing && knot_ < kSoftest)
      knot_ = std::min(kSoftest, 1.2 * knot_);
    else
      slower_ *= std::min(2.0, std::max(1.02, std::sqrt(smooth_->largest_jerk() / most)));
    make_smooth(spec);
  }
  if (smooth_->largest_jerk() > most)
    throw InputError({"", 0, "trajectory.max_jerk", "cannot be kept on this path",
                      plain_text(most) + " m/s3", plain_text(smooth_->largest_jerk()) + " m/s3 at best",
                      "make it larger, or give trajectory.smoothing"});
}

double CameraPath::duration() const {
  return smooth_ ? smooth_->duration() : scale_.duration(asked_duration_);
}

std::vector<double> CameraPath::waypoint_times() const {
  std::vector<double> times;
  const double stretch = asked_duration_ > 0 ? asked_duration_ / curves_->duration() : 1;
  for (const double t : curves_->times())
    times.push_back(scale_.when(t * stretch) * slower_ + (smooth_ ? smooth_->delay() : 0));
  return times;
}

double CameraPath::asked_duration() const { return asked_duration_; }

// The curves' own time at t: slowed down by the limits, then stretched to the asked duration.
AskedTime CameraPath::own_time(double t) const {
  AskedTime own = scale_.at(std::min(std::max(t, 0.0), scale_.duration(asked_duration_)));
  if (asked_duration_ == curves_->duration()) return own;
  const double stretch = curves_->duration() / asked_duration_;
  own.time *= stretch, own.rate *= stretch, own.change *= stretch;
  return own;
}

Pose CameraPath::at(double t) const {
  return smooth_ ? smooth_->at(t) : curves_->at(own_time(t).time);
}

CameraMotion CameraPath::motion_at(double t) const {
  return smooth_ ? smooth_->motion_at(t) : sharp_motion_at(t);
}

CameraMotion CameraPath::sharp_motion_at(double t) const {
  const AskedTime own = own_time(t);
  CameraMotion motion = curves_->motion_at(own.time);
  motion.acceleration = motion.acceleration * (own.rate * own.rate) + motion.velocity * own.change;
  motion.velocity *= own.rate;
  motion.angular_velocity *= own.rate;
  return motion;
}

std::vector<CameraPose> sample_trajectory(const TrajectorySpec& spec, std::int64_t epoch_ns) {
  return sample_path(CameraPath(spec), spec.rate_hz, epoch_ns);
}

std::vector<CameraPose> sample_path(const MotionPath& path, double rate_hz, std::int64_t epoch_ns) {
  // A waypoint at 3.0 s gets its frame although 3.0 * 30 may round to just under 90.
  constexpr double kSlack = 1e-6;
  if (!(path.duration() * rate_hz < kMostFrames))
    throw InputError({"", 0, "rate_hz", "too many frames", "at most 10000000",
                      exact_text(rate_hz) + " Hz for " + exact_text(path.duration()) + " s", ""});
  const auto last = static_cast<std::int64_t>(std::floor(path.duration() * rate_hz + kSlack));
  std::vector<CameraPose> poses;
  poses.reserve(std::size_t(last) + 1);
  for (std::int64_t k = 0; k <= last; ++k) {
    const double t = std::min(double(k) / rate_hz, path.duration());
    const auto offset = static_cast<std::int64_t>(std::floor(double(k) * 1e9 / rate_hz + 0.5));
    poses.push_back({epoch_ns + offset, path.at(t)});
  }
  return poses;
}

}  // namespace rubble
