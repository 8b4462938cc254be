#include "app/navigate_ros1/topic_navigator.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace rubble {

const std::vector<RobotKindOfNavigator>& known_robots() {
  static const std::vector<RobotKindOfNavigator> kinds{
      {"crawler", {{0.2, 0.46, 0.33}, {0.3, 0.57, 0.33}}, 0.36, 0.4},
      {"rover", {{0.5, 0.26, 0.25}}, 0.3, 0.4},
  };
  return kinds;
}

namespace {

constexpr double kMargin = 8;                      // of the map, around start and waypoints; unit: m
constexpr double kLowest = -0.3, kHighest = 1.3;   // of the map; unit: m
constexpr double kPlanarHeight = 0.3;              // of what a 2-D scanner sees: it stands upright, as far as is known; unit: m
constexpr double kReach = 6;                       // of points that are mapped; unit: m
// Of points that are matched: farther away the robot has not seen everything yet, and would find most of what it sees again
// where it came from; unit: m.
constexpr double kMatchReach = 4;
constexpr double kBesideRobot = 0.12;              // nearer to its shape, points are the robot itself, with noise; unit: m
constexpr double kCell = 0.05;                      // one point of each is matched; unit: m
constexpr double kMoved = 0.005, kTurned = 0.003;  // less is not matched again; unit: m, rad
// What is matched is mapped so far apart: errors too small to be seen from one scan to the next are seen from there.
constexpr double kMapMoved = 0.25, kMapTurned = 0.1;  // unit: m, rad
// Without a cloud or a pose for so long it stops: of the robot's time, and of the wall's where its time stands still; unit: s
constexpr double kSilence = 0.5, kDeadSilence = 2;
constexpr double kPatience = 10;                   // without a cloud, once there were some; of the wall's time; unit: s
constexpr double kPatienceForPoses = 0.1;          // of a cloud, for poses until its end; of the wall's time; unit: s
constexpr double kShortestPeriod = 0.01;           // of clouds; unit: s
constexpr std::size_t kMostWaiting = 5;            // clouds; older ones go
constexpr double kWallLimit = 10;                  // times the limit of the robot's time

std::int64_t end_of(const HeardCloud& cloud) {
  float last = 0;
  for (const HeardPoint& p : cloud.points) last = std::max(last, p.time);
  return cloud.stamp_ns + std::int64_t(1e9 * double(std::min(last, 1.0f)));
}

NavigationRules make_rules(const TopicNavigatorOptions& options) {
  NavigationRules rules;
  rules.plans = options.plans, rules.plan_radius = options.robot.plan_radius;
  return rules;
}

Aabb make_bounds(const TopicNavigatorOptions& options) {
  Aabb bounds;
  std::vector<Vec3> places = options.waypoints;
  places.push_back({0, 0, 0});
  for (const Vec3& place : places) {
    bounds.include(place + Vec3{-kMargin, -kMargin, kLowest});
    bounds.include(place + Vec3{kMargin, kMargin, kHighest});
  }
  return bounds;
}

PilotOptions make_pilot_options(const TopicNavigatorOptions& options, const Aabb& bounds) {
  PilotOptions pilot;
  pilot.rules = make_rules(options), pilot.bounds = bounds, pilot.shape = options.robot.shape;
  pilot.waypoints = options.waypoints, pilot.cache_folder = options.cache_folder;
  return pilot;
}

bool is_apart(const PlanarPose& a, const PlanarPose& b, double moved, double turned) {
  const PlanarPose step = inverse(a) * b;
  return std::hypot(step.x, step.y) > moved || std::fabs(step.yaw) > turned;
}

bool is_robot(const Vec3& p, const std::vector<NavigatorSlice>& shape) {
  for (const NavigatorSlice& slice : shape)
    if (std::fabs(p.x) < slice.half_length + kBesideRobot && std::fabs(p.y) < slice.half_width + kBesideRobot) return true;
  return false;
}

// Of what stands upright, one point of each cell seen from above, in their order. A point that is alone among the cells
// around is left out: beams that meet an edge have echoes in the air behind it.
std::vector<Vec3> thinned(const std::vector<Vec3>& points, double reach) {
  VoxelGrid grid;
  grid.voxel = kCell, grid.corner = {-kReach, -kReach, 0};
  grid.size = {int(2 * kReach / kCell), int(2 * kReach / kCell), 1};
  std::vector<std::uint8_t> count(grid.count(), 0), taken(grid.count(), 0);
  std::vector<std::pair<Cell, Vec3>> upright;
  for (const Vec3& p : points) {
    const Cell cell = grid.find_cell({p.x, p.y, 0.5 * kCell});
    if (!PlanarMap::holds(p) || p.x * p.x + p.y * p.y > reach * reach || !grid.contains(cell)) continue;
    std::uint8_t& here = count[grid.index(cell)];
    here = std::uint8_t(std::min(here + 1, 2));
    upright.push_back({cell, p});
  }
  std::vector<Vec3> kept;
  for (const auto& [cell, p] : upright) {
    if (taken[grid.index(cell)]) continue;
    taken[grid.index(cell)] = 1;
    int around = 0;
    for (int y = std::max(0, cell[1] - 1); y <= std::min(grid.size[1] - 1, cell[1] + 1); ++y)
      for (int x = std::max(0, cell[0] - 1); x <= std::min(grid.size[0] - 1, cell[0] + 1); ++x)
        around += count[grid.index({x, y, 0})];
    if (around > 1) kept.push_back(p);
  }
  return kept;
}

}  // namespace

std::string name_of(TopicEnd end) {
  switch (end) {
    case TopicEnd::driving:
      return "driving";
    case TopicEnd::arrived:
      return "arrived";
    case TopicEnd::gave_up:
      return "gave up";
    case TopicEnd::time_up:
      return "time up";
    case TopicEnd::no_data:
      return "no data";
    case TopicEnd::lost:
      return "lost";
    case TopicEnd::restarted:
      return "restarted";
    case TopicEnd::stopped:
      return "stopped";
  }
  return "";
}

TopicNavigator::TopicNavigator(const TopicNavigatorOptions& options, std::function<void(double, double)> drive)
    : options_(options), rules_(make_rules(options)), bounds_(make_bounds(options)),
      pilot_(make_pilot_options(options, bounds_)), upright_(bounds_, rules_.voxel),
      drive_(std::move(drive)),
      track_(options.pose == PoseSource::odometry ? options.robot.turn_share : 1), base_frame_(options.base_frame) {}

void TopicNavigator::hear(const HeardRobot& heard, double wall) {
  if (!called_) called_ = wall;
  if (has_ended()) return;
  const int poses = report_.poses;
  hear_poses(heard);
  if (report_.poses > poses) pose_at_ = wall;
  for (const HeardCloud& cloud : heard.clouds)
    if (!has_ended()) hear_cloud(cloud, wall);
  if (!has_ended()) work_off(wall);
  if (!has_ended()) watch(wall);
}

void TopicNavigator::hear_poses(const HeardRobot& heard) {
  for (const HeardTransform& transform : heard.transforms) {
    frames_.add(transform);
    if (options_.pose != PoseSource::transforms) continue;
    // Frames of another rate are of other stamps: the base's own say when it was where.
    if (transform.child != options_.base_frame) continue;
    if (const auto pose = frames_.find(options_.fixed_frame, options_.base_frame)) hear_pose(transform.stamp_ns, *pose);
  }
  if (options_.pose != PoseSource::odometry) return;
  for (const HeardOdometry& odometry : heard.odometry) {
    base_frame_ = odometry.child;
    hear_pose(odometry.stamp_ns, odometry.frame_from_child);
  }
}

void TopicNavigator::hear_pose(std::int64_t stamp_ns, const Pose& fixed_from_base) {
  if (has_ended()) return;
  const PlanarPose before = track_.empty() ? PlanarPose{} : track_.last();
  const OdometryTrack::Heard heard = track_.add(stamp_ns, fixed_from_base);
  if (heard == OdometryTrack::Heard::restarted)
    return end(TopicEnd::restarted, "stamps or poses jumped: the drive was started again, or its robot was put elsewhere; "
                                    "start this program again, for a goal seen from where the robot is now");
  if (heard == OdometryTrack::Heard::ignored) return;
  ++report_.poses;
  if (report_.clouds == 0) return;
  report_.way += std::hypot(track_.last().x - before.x, track_.last().y - before.y);
}

void TopicNavigator::hear_cloud(const HeardCloud& cloud, double wall) {
  if (report_.clouds > 0 && cloud.stamp_ns <= last_stamp_) {
    if (last_stamp_ - cloud.stamp_ns > 500'000'000)
      end(TopicEnd::restarted, "the stamps of clouds jumped back: the drive was started again; start this program again");
    return;
  }
  if (report_.clouds > 0) {
    const double gap = seconds_of(cloud.stamp_ns - last_stamp_);
    cloud_period_ = std::min(cloud_period_, std::max(gap, kShortestPeriod));
    report_.clouds_dropped += std::max(0, int(std::lround(gap / cloud_period_)) - 1);
  }
  last_stamp_ = cloud.stamp_ns;
  ++report_.clouds;
  report_.points_left_out += long(cloud.left_out);
  if (cloud.points.empty()) {
    ++report_.clouds_empty;
    return;
  }
  waiting_.push_back(cloud), cloud_at_ = wall;
  if (waiting_.size() > kMostWaiting) waiting_.pop_front();
}

// Poses that are sent after a cloud may be of before its last ray.
bool TopicNavigator::is_complete(const HeardCloud& cloud, double wall) const {
  if (track_.empty()) return false;
  return track_.last_stamp() >= end_of(cloud) || wall - cloud_at_ > kPatienceForPoses;
}

void TopicNavigator::work_off(double wall) {
  while (!waiting_.empty() && !has_ended() && is_complete(waiting_.front(), wall) &&
         frames_.find(base_frame_, waiting_.front().frame)) {
    const HeardCloud cloud = std::move(waiting_.front());
    waiting_.pop_front();
    step(cloud, wall);
  }
}

void TopicNavigator::step(const HeardCloud& cloud, double wall) {
  const auto before = std::chrono::steady_clock::now();
  const std::int64_t end_stamp = end_of(cloud);
  if (report_.periods == 0) first_stamp_ = end_stamp, began_ = wall;
  report_.clouds_late += seconds_of(track_.last_stamp() - end_stamp) > rules_.period;
  take_cloud(cloud);
  cloud_time_ = track_.last_stamp();
  report_.time = seconds_of(end_stamp - first_stamp_), report_.wall = wall - began_;
  if (seconds_of(end_stamp - track_.last_stamp()) > kSilence) return stop();  // nobody knows where it is
  // Of several that came at once, the newest is driven by.
  if (!waiting_.empty() && is_complete(waiting_.front(), wall)) return;
  const PlanarPose pose = pose_now(), velocity = track_.velocity();
  const Vec3& goal = options_.waypoints.back();
  report_.pose = pose, report_.left = std::hypot(pose.x - goal.x, pose.y - goal.y);
  if (!(pose.x > bounds_.min.x && pose.x < bounds_.max.x && pose.y > bounds_.min.y && pose.y < bounds_.max.y))
    return end(TopicEnd::lost, "the robot is farther than 8 m from start and goal: it drives elsewhere than it is told to, or "
                               "its poses are wrong; look at the topic of its pose, and at `--robot`");
  const Vec3 moving = PlanarPose{0, 0, pose.yaw} * Vec3{velocity.x, velocity.y, 0};
  const NavigatorOutput output = pilot_.step({report_.time, {pose.x, pose.y, 0}, pose.yaw, moving, velocity.yaw});
  report_.plans = pilot_.plans(), report_.plans_failed = pilot_.plans_failed();
  drive_(output.linear, output.angular / options_.robot.turn_share);
  moving_ = true;
  const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  ++report_.periods;
  report_.deadlines_missed += took > rules_.period;
  report_.slowest = std::max(report_.slowest, took);
  report_.course.push_back({track_.last_stamp(), pose, track_.last(), ground_, output.linear, output.angular, took});
  if (output.state == NavigatorState::arrived) end(TopicEnd::arrived, "");
  if (output.state == NavigatorState::gave_up)
    end(TopicEnd::gave_up, "no progress for 30 s: there is no way that the navigator sees, or nobody hears the velocities; "
                           "try `--planner ompl`, or another goal");
}

std::vector<Vec3> TopicNavigator::in_base(const HeardCloud& cloud, const Pose& base_from_sensor) const {
  const PlanarPose base_from_track = inverse(track_.last());
  std::vector<Vec3> points;
  points.reserve(cloud.points.size());
  float time = -1;
  PlanarPose now_from_then;
  for (const HeardPoint& p : cloud.points) {
    if (p.time != time) now_from_then = base_from_track * track_.at(cloud.stamp_ns + std::int64_t(1e9 * double(p.time)));
    time = p.time;
    const Vec3 place = base_from_sensor * Vec3(p.place);
    if (!is_robot(place, options_.robot.shape)) points.push_back(now_from_then * place);
  }
  return points;
}

void TopicNavigator::take_cloud(const HeardCloud& cloud) {
  const Pose base_from_sensor = *frames_.find(base_frame_, cloud.frame);
  std::vector<Vec3> points = in_base(cloud, base_from_sensor);
  if (!options_.planar) ground_ = find_ground(points, ground_);
  const Pose level_from_base = ground_.level_from_base();
  for (Vec3& p : points) p = options_.planar ? Vec3{p.x, p.y, kPlanarHeight} : level_from_base * p;
  points.erase(std::remove_if(points.begin(), points.end(),
                              [](const Vec3& p) { return p.x * p.x + p.y * p.y > kReach * kReach || p.z > kHighest; }),
               points.end());
  if (options_.matches) localize(points);
  const PlanarPose map_from_base = pose_now();
  Vec3 sensor = base_from_sensor.translation;
  sensor = map_from_base * (options_.planar ? Vec3{sensor.x, sensor.y, kPlanarHeight} : level_from_base * sensor);
  for (Vec3& p : points) p = map_from_base * p;
  pilot_.see(sensor, points);
}

void TopicNavigator::localize(const std::vector<Vec3>& points) {
  if (has_upright_ && !is_apart(matched_at_, track_.last(), kMoved, kTurned)) return;
  matched_at_ = track_.last();
  if (has_upright_) {
    const ScanMatch match = match_scan(upright_, thinned(points, kMatchReach), pose_now());
    report_.matches_failed += !match.found;
    correction_ = match.pose * inverse(track_.last());
    if (!is_apart(mapped_at_, track_.last(), kMapMoved, kMapTurned)) return;
  }
  for (const Vec3& p : thinned(points, kReach)) upright_.add(pose_now() * p);
  has_upright_ = true, mapped_at_ = track_.last();
}

void TopicNavigator::watch(double wall) {
  if (report_.periods == 0) {
    if (wall - *called_ > options_.wait) end(TopicEnd::no_data, describe_silence());
    return;
  }
  watch_for_silence(wall);
  if (report_.time > options_.time_limit || wall - began_ > kWallLimit * options_.time_limit)
    end(TopicEnd::time_up, "the robot had " + std::to_string(int(options_.time_limit)) + " s; `--time-limit` gives it more");
}

void TopicNavigator::watch_for_silence(double wall) {
  const double silence = wall - std::min(cloud_at_, pose_at_);
  const bool blind = seconds_of(track_.last_stamp() - cloud_time_) > kSilence;
  if (moving_ && (blind || silence > kDeadSilence)) stop();
  if (silence > kPatience)
    end(TopicEnd::no_data, std::string(pose_at_ < cloud_at_ ? "poses" : "clouds with points") +
                               " do not come any more: the drive has ended or is paused; start both again");
}

std::string TopicNavigator::describe_silence() const {
  if (report_.poses == 0)
    return options_.pose == PoseSource::odometry
               ? "no odometry came: is the robot driven with --ros1, and is the topic called otherwise (`--odom TOPIC`)? "
                 "`rostopic list` shows the topics that there are"
               : "no transform from " + options_.fixed_frame + " to " + options_.base_frame +
                     " came on /tf: name other frames by `--fixed-frame` and `--base-frame`";
  if (report_.clouds == 0)
    return "poses came, and no cloud or scan: does the robot scan, and is its topic called otherwise (`--topic TOPIC`, "
           "`--sensor scan`)? `rostopic list` shows the topics that there are";
  if (report_.clouds == report_.clouds_empty) return "clouds came without one finite point: the scanner sees nothing";
  if (!waiting_.empty() && !frames_.find(base_frame_, waiting_.front().frame))
    return "no chain of transforms leads from " + base_frame_ + " to " + waiting_.front().frame +
           ", the frame of the clouds: /tf_static must have one";
  return "poses and clouds came, but not at the same time";
}

void TopicNavigator::stop() {
  drive_(0, 0);
  moving_ = false;
}

void TopicNavigator::end(TopicEnd how, const std::string& message) {
  if (has_ended()) return;
  report_.end = how, report_.message = message;
  stop();
}

}  // namespace rubble
