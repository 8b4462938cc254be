// Where the camera goes: from a few waypoints to one pose for every frame.
//
// Positions are a cubic Hermite spline in time whose velocity at a waypoint is that of the parabola
// through it and its neighbours (non-uniform Catmull-Rom: Catmull and Rom 1974, "A class of local
// interpolating splines"; the weights are Bessel's, de Boor, "A Practical Guide to Splines", ch.
// IV). It passes through every waypoint, is C1, reproduces constant speed on a straight line, and
// stands still between two waypoints at one place. Orientations are a C1 quaternion curve through
// the waypoints' rotations (cumulative Bezier form: Kim, Kim and Shin 1995, "A general construction
// scheme for unit quaternion curves with simple high order derivatives"). Between two waypoints
// that look at targets, the target moves along a spline of its own and stays in the view's centre.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kernel/base/error.h"
#include "kernel/base/math.h"
#include "scripting/trajectory/curves.h"
#include "scripting/trajectory/smooth_path.h"
#include "scripting/trajectory/time_scale.h"

namespace rubble {

// A place in a void of the settled pile, which is known only once it has settled.
struct VoidPlace {
  enum class Order { volume, depth };  // depth: how far the way into it is
  enum class Point {
    entrance,  // the sphere's centre where the widest entrance is widest
    approach,  // `distance` outside of it
    deepest,   // the farthest that the sphere gets from the entrances
    widest,    // where the largest sphere fits
  };
  double radius = 0.2;            // of the sphere that must enter; unit: m; range: 0.02 to 10
  int rank = 1;                   // 1: the first of the voids in this order that it can enter
  Order order = Order::volume;    // by which voids are ranked, largest first
  Point point = Point::entrance;  // which place of the void
  double distance = 1;            // unit: m; range: 0 to 100
  // Outside is what a sphere of this radius reaches from the sky; unit: m; range: 0.2 to 10
  double outside_radius = 2;
};

// A link of a robot that carries something.
struct Carrier {
  std::string robot{};  // its name; empty: no robot does
  std::string link{};   // empty: the first, whose frame is the robot's

  bool on() const { return !robot.empty(); }
  bool operator==(const Carrier& o) const { return robot == o.robot && link == o.link; }
};

// A link of a robot that carries the cameras and all that rides with them; none: the camera flies.
struct Ride : Carrier {
  Vec3 position;  // of the rig, in the link's frame; unit: m; range: -10 to 10
  Vec3 rpy_deg;   // of the rig, likewise; unit: degree

  Pose link_from_rig() const;
};

enum class Plan {
  ghost,   // fly through pieces
  refuse,  // stop before the first frame when the camera's body would touch anything
  avoid,   // find a way around everything from each waypoint to the next
};

struct Waypoint {
  // When the camera is here; unit: s after the start. The first one's is 0. Without it, the camera
  // comes from the waypoint before at `speed` along the straight line.
  std::optional<double> t;
  std::optional<double> speed;  // unit: m/s; range: > 0; default: the trajectory's
  Vec3 position;                // of the camera, in the world; unit: m
  // Roll, pitch (positive: nose down) and yaw, R = Rz(yaw) Ry(pitch) Rx(roll) (REP 103); unit:
  // degree. With look_at only the roll counts, and pitch and yaw must be 0.
  Vec3 rpy_deg;
  std::optional<Vec3> look_at;  // the camera's X axis points here, Z up; unit: m
  // Instead of the numbers above, until resolved; see app/planning/flight.h.
  std::optional<VoidPlace> position_in_void{}, look_at_in_void{};
};

// From 9 m in front of the pile's middle and 4 m up, looking at it.
Waypoint default_view();

struct TrajectorySpec {
  double rate_hz = 30;  // frames per second of simulation time; range: 0.001 to 1000
  Interpolation interpolation = Interpolation::automatic;  // between waypoints
  double speed = 0.5;  // where a waypoint has neither t nor speed; unit: m/s; range: > 0
  // At least one; a single one gives a single frame.
  std::vector<Waypoint> waypoints{default_view()};
  Plan plan = Plan::ghost;  // what happens where the path meets the pile
  double radius = 0.1;      // of the sphere that is the camera's body; unit: m; range: 0.005 to 10
  // The whole path takes this long instead of what its times and speeds add up to; unit: s; > 0
  std::optional<double> duration;
  SpeedLimits limits;  // kept by slowing down; none by default
  // The path is averaged over about this long, in place and in view, until it is smooth enough for an
  // inertial unit: the knots of SmoothPath. 0: not at all. Not given: see flown_trajectory(),
  // max_jerk and rest_at_ends. unit: s; range: 0 to 2
  std::optional<double> smoothing;
  bool rest_at_ends = false;  // of a smoothed path, see PathEnds
  Ride ride;  // instead of all but rate_hz: the way is that of a robot

  // Whether it can be flown only over a settled pile: see app/planning/flight.h.
  bool needs_pile() const;
};

struct CameraPose {
  std::int64_t stamp_ns = 0;  // simulation time; unit: ns
  Pose world_from_camera;     // camera body: X forward, Y left, Z up
};

// The camera's pose at any time, not only at the frames'.
class CameraPath : public MotionPath {
 public:
  // Throws InputError (find_mistakes), also for places in voids. The plan is not looked at.
  explicit CameraPath(const TrajectorySpec& spec);
  ~CameraPath() override;
  double duration() const override;  // unit: s
  double asked_duration() const;  // what it was before the limits slowed it down; unit: s
  Pose at(double t) const override;
  // Without smoothing the path is C1 at best, and the acceleration jumps
  // at waypoints.
  CameraMotion motion_at(double t) const override;
  // When each waypoint is passed, or where the path is smoothed, passed by; unit: s
  std::vector<double> waypoint_times() const;
  double smoothing() const { return smooth_ ? knot_ : 0; }  // as it was chosen; unit: s

 private:
  class Curves;
  AskedTime own_time(double t) const;
  CameraMotion sharp_motion_at(double t) const;  // before smoothing
  void make_smooth(const TrajectorySpec& spec);
  void fit_jerk(const TrajectorySpec& spec);

  std::unique_ptr<const Curves> curves_;
  double asked_duration_ = 0;
  TimeScale scale_;
  double slower_ = 1;  // than all this, so that max_jerk is kept
  double knot_ = 0;    // unit: s
  std::optional<SmoothPath> smooth_;
};

// Of the knots where nothing else is asked for; unit: s. An inertial unit of 200 Hz takes 20 samples
// in it, so that what is lost between two of them does not show.
inline constexpr double kUsualSmoothing = 0.1;

// Every mistake in a trajectory, keyed "trajectory.waypoints[2].t" and so on; empty: none.
std::vector<Diagnostic> find_mistakes(const TrajectorySpec& spec);

// One pose per frame: frame k is at k / rate_hz seconds and has the stamp epoch_ns + k * 1e9 /
// rate_hz, rounded to the nearest nanosecond, so that nothing drifts. The last frame is at or
// before the last waypoint. The same bits on every machine. Throws InputError (find_mistakes).
std::vector<CameraPose> sample_trajectory(const TrajectorySpec& spec, std::int64_t epoch_ns);

// Frames along a path that is made already.
// As sample_trajectory(), of the path of that trajectory, or of a ride. rate_hz: of the frames; unit: Hz;
// above 0.
std::vector<CameraPose> sample_path(const MotionPath& path, double rate_hz, std::int64_t epoch_ns);

}  // namespace rubble
