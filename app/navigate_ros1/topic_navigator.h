// Drives a robot to a goal by what it says over topics: poses, frames, and what a scanner in three dimensions or in two sees.
//
//   cloud -> without motion during the scan -> level with the ground -> matched to the map -> Pilot -> velocity
//
// It knows neither ROS nor a clock of its own: messages, and the wall's clock, are given to it.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/navigate/pilot.h"
#include "app/navigate_ros1/frame_tree.h"
#include "app/navigate_ros1/ground_plane.h"
#include "app/navigate_ros1/odometry_track.h"
#include "app/navigate_ros1/scan_matcher.h"
#include "io/live/ros1_robot.h"
#include "io/mrpt/reactive_navigator.h"

namespace rubble {

// What the navigator has to know of a robot before it drives it.
struct RobotKindOfNavigator {
  std::string name;
  std::vector<NavigatorSlice> shape;
  double plan_radius = 0.36;  // of the disc that a global planner plans for; unit: m
  // What skids turns by this share of what tracks or wheels would give (docs/reference/robots.md): commands are divided by it, and
  // turns of odometry multiplied.
  double turn_share = 1;
};

// The bundled robots that have odometry: crawler, with its flippers up, and rover.
const std::vector<RobotKindOfNavigator>& known_robots();

enum class PoseSource { odometry, transforms };

struct TopicNavigatorOptions {
  // Driven to one after the other, ahead (X) and to the left (Y) of where the robot is first heard of; the last is the
  // goal; at least one; unit: m
  std::vector<Vec3> waypoints{{0, 0, 0}};
  RobotKindOfNavigator robot = known_robots().front();
  bool planar = false;            // a 2-D scanner: no ground is looked for
  bool plans = false;             // a global planner, as NavigationRules::plans
  PoseSource pose = PoseSource::odometry;
  std::string fixed_frame = "odom", base_frame = "base_link";  // of PoseSource::transforms
  bool matches = true;            // poses are corrected by scans
  double time_limit = 120;        // of the robot's time; unit: s
  double wait = 30;               // for the first messages, of the wall's time; unit: s
  std::string cache_folder;       // as NavigatorOptions
};

enum class TopicEnd { driving, arrived, gave_up, time_up, no_data, lost, restarted, stopped };
std::string name_of(TopicEnd end);

// One period, for a person who wants to know why it drove so.
struct TopicPeriod {
  std::int64_t stamp_ns = 0;    // of the pose
  PlanarPose pose, odometry;    // matched, and as it was heard, from the start
  GroundPlane ground;
  double linear = 0, angular = 0;  // that the robot was asked for; unit: m/s, rad/s
  double took = 0;              // unit: s
};

struct TopicReport {
  TopicEnd end = TopicEnd::driving;
  std::string message;       // what to do, where it did not arrive
  PlanarPose pose;           // where the navigator thinks it is, from where it started
  double left = 0;           // from the goal; unit: m
  double way = 0;            // driven; unit: m
  double time = 0;           // of the robot, from the first cloud to the last; unit: s
  double wall = 0;           // the same of the wall's clock; unit: s
  int periods = 0;           // of map and navigator: one for each cloud that is the newest
  int deadlines_missed = 0;  // of these, that took longer than NavigationRules::period of the wall's clock
  double slowest = 0;        // unit: s
  int clouds = 0;
  int clouds_dropped = 0;    // that are missing between the stamps of two that came
  int clouds_late = 0;       // whose last ray was more than a period old when they were turned to
  int clouds_empty = 0;      // without one finite point
  long points_left_out = 0;  // that are not finite
  int poses = 0;
  int matches_failed = 0;    // clouds in which too little of the map was found again
  int plans = 0, plans_failed = 0;
  std::vector<TopicPeriod> course;
};

class TopicNavigator {
 public:
  // drive: told of each velocity; unit: m/s, rad/s. Throws as Pilot does.
  TopicNavigator(const TopicNavigatorOptions& options, std::function<void(double, double)> drive);

  // What was heard until now. wall: of a clock that never jumps; unit: s
  void hear(const HeardRobot& heard, double wall);
  // Somebody asks it to stop, or reports an end that it cannot know.
  void end(TopicEnd how, const std::string& message);

  bool has_ended() const { return report_.end != TopicEnd::driving; }
  const TopicReport& report() const { return report_; }

 private:
  void hear_poses(const HeardRobot& heard);
  void hear_pose(std::int64_t stamp_ns, const Pose& fixed_from_base);
  void hear_cloud(const HeardCloud& cloud, double wall);
  bool is_complete(const HeardCloud& cloud, double wall) const;
  void work_off(double wall);
  void take_cloud(const HeardCloud& cloud);
  void localize(const std::vector<Vec3>& points);
  void step(const HeardCloud& cloud, double wall);
  void watch(double wall);
  void watch_for_silence(double wall);
  std::vector<Vec3> in_base(const HeardCloud& cloud, const Pose& base_from_sensor) const;
  PlanarPose pose_now() const { return correction_ * track_.last(); }
  std::string describe_silence() const;
  void stop();

  TopicNavigatorOptions options_;
  NavigationRules rules_;
  Aabb bounds_;
  Pilot pilot_;
  PlanarMap upright_;
  std::function<void(double, double)> drive_;
  FrameTree frames_;
  OdometryTrack track_;
  GroundPlane ground_;
  PlanarPose correction_;  // map_from_track
  PlanarPose matched_at_, mapped_at_;  // of the track, when it was matched last, and when what it matches was mapped
  bool has_upright_ = false;
  std::string base_frame_;
  std::deque<HeardCloud> waiting_;  // for the poses until their ends
  std::int64_t first_stamp_ = 0, last_stamp_ = 0;  // of clouds
  double cloud_period_ = 1e9;                      // the shortest time between two; unit: s
  double began_ = 0;                 // unit: s, of the wall
  std::optional<double> called_;     // when hear() was first called
  double pose_at_ = 0, cloud_at_ = 0;  // when a pose, and a cloud with points came
  std::int64_t cloud_time_ = 0;      // the robot's time when the last cloud was used
  bool moving_ = false;
  TopicReport report_;
};

}  // namespace rubble
