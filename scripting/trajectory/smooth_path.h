// A path made four times continuously differentiable, so that an inertial unit on it measures what
// the poses do.
//
// The path is sampled every `knot` seconds, and the samples are the control points of a uniform
// quintic B-spline (de Boor, "A Practical Guide to Splines", ch. IX). That is the path averaged over
// time with a bell of standard deviation knot / sqrt 2: a straight line at constant speed stays as
// it is, a corner where the velocity jumps by dv is passed at up to 0.23 dv knot from its point with
// an acceleration of up to 0.67 dv / knot, and neither speed nor acceleration grows anywhere. Orientations
// are the same average of unit quaternions, normalized; a turn about one axis at constant rate stays
// as it is.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

// How the camera moves at one instant: exact derivatives of the path.
struct CameraMotion {
  Pose world_from_camera;  // camera body; unit: m
  Vec3 velocity;           // in the world; unit: m/s
  Vec3 acceleration;       // in the world; unit: m/s2
  Vec3 angular_velocity;   // in the camera body frame; unit: rad/s
};

enum class PathEnds {
  moving,  // the path begins and ends with the speed it has there, at its first and last pose
  at_rest,  // it stands still before and after, and takes 4 knots longer
};

class SmoothPath {
 public:
  // path: the pose at a time from 0 to duration. duration, knot: above 0; unit: s. The knots are as
  // close as is needed for the last to be at the end.
  SmoothPath(const std::function<Pose(double)>& path, double duration, double knot, PathEnds ends);

  double duration() const;                     // unit: s
  double delay() const { return delay_; }      // of what was at 0; unit: s
  CameraMotion motion_at(double t) const;      // t: from 0 to the duration
  Pose at(double t) const;

  // The largest third derivative of the position, to within a hundredth; unit: m/s3
  double largest_jerk() const;
  // Where the view turns so far between two knots that no average of it means anything (more than
  // 90 degrees), on the path's own time; nothing: nowhere.
  struct Turn {
    double time = 0;       // unit: s
    double angle_deg = 0;  // within a knot
  };
  std::optional<Turn> wildest_turn() const;

 private:
  void align_signs();

  double knot_ = 0, delay_ = 0;
  std::size_t intervals_ = 0;
  std::vector<Vec3> positions_;  // control points from two knots before 0 to two after the end
  std::vector<Quat> rotations_;  // likewise, each in the half space of the one before
};

// How something that carries sensors moves: a path that was asked for, or a motion that was simulated.
class MotionPath {
 public:
  virtual ~MotionPath() = default;
  virtual double duration() const = 0;  // unit: s
  // t: s after the start; before it and after the end the carrier stands still.
  virtual Pose at(double t) const = 0;
  // t: from 0 to the duration.
  virtual CameraMotion motion_at(double t) const = 0;
  // Whether it comes from the steps of a simulation: accelerations are those of the steps, and an inertial
  // unit takes their mean over the period of its readings.
  virtual bool is_simulated() const { return false; }
};

}  // namespace rubble
