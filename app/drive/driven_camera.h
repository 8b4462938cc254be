// How the camera moves while it is driven: one fixed simulation step after another.
//
// It turns about its own three axes at once and goes along its optical axis, as the paper's camera.
// The same inputs give the same bits on every machine.
#pragma once

#include "app/drive/drive_input.h"
#include "kernel/queries/queries.h"
#include "scripting/trajectory/trajectory.h"

namespace rubble {

// A place as a waypoint of a mission states it, so that what is driven can be written down exactly.
struct DrivenPose {
  Vec3 position;  // in the world; unit: m
  Vec3 rpy_deg;   // as Waypoint::rpy_deg

  Pose world_from_camera() const;
};

DrivenPose make_driven_pose(const Pose& world_from_camera);

struct DriveLimits {
  double speed = 0.5;                         // at the start; unit: m/s
  double least_speed = 0.02, most_speed = 5;  // that a person can choose; unit: m/s
  double turn_rate_deg = 60;                  // of each held axis; unit: degree/s
  double most_turn_rate_deg = 180;            // of what is asked for in figures; unit: degree/s
  double reach = 1000;                        // farthest from the origin along each axis; unit: m
};

class DrivenCamera {
 public:
  // plan: ghost goes through everything; refuse stops a millimetre before the body, a sphere of
  // `radius`, would touch anything; avoid slides along it. queries: must outlive the camera; not
  // asked by a ghost.
  DrivenCamera(const DrivenPose& start, Plan plan, double radius, const PileQueries& queries,
               const DriveLimits& limits = {});

  // seconds: of the step; the actions of the input are not looked at.
  void step(const DriveInput& input, double seconds);
  void change_speed(int notches);  // a quarter more, or a fifth less, each
  void put(const DrivenPose& pose) { pose_ = pose, held_back_ = false; }

  const DrivenPose& pose() const { return pose_; }
  double speed() const { return speed_; }           // unit: m/s
  bool held_back() const { return held_back_; }     // in the last step, by something in the way
  // Whether the body has room where it is now. A ghost always has.
  bool has_room() const;

 private:
  void turn(const DriveInput& input, double seconds);
  void move(const Vec3& way);
  double free_share(const Vec3& from, const Vec3& way) const;

  DrivenPose pose_;
  Plan plan_;
  double radius_;
  const PileQueries* queries_;
  DriveLimits limits_;
  double speed_;
  bool held_back_ = false;
};

}  // namespace rubble
