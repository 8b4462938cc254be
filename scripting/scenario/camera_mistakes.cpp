// What is wrong with the cameras of a mission, and with the names of its sensors, beyond ranges.
#include "scripting/scenario/camera_mistakes.h"

#include <algorithm>
#include <map>
#include <string>

#include "kernel/base/portable_math.h"
#include "render/streams/image_streams.h"
#include "scripting/scenario/mission_form.h"
#include "scripting/scenario/part_schemas.h"
#include "scripting/schema/schema.h"

namespace rubble {
namespace {

// at: what the keys of the camera begin with: "camera.", "cameras.front."
void check_channels(const CameraScenario& camera, const std::string& at,
                    std::vector<Diagnostic>& mistakes) {
  const std::vector<std::string> names = channel_names();
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "one of " : ", ") + name;
  for (std::size_t i = 0; i < camera.channels.size(); ++i) {
    const std::string& written = camera.channels[i];
    if (std::find(names.begin(), names.end(), written) != names.end()) continue;
    const std::string near = nearest_name(written, names);
    mistakes.push_back({"", 0, at + "channels[" + std::to_string(i + 1) + "]",
                        "unknown channel `" + written + "`", near.empty() ? list : "", "",
                        near.empty() ? "" : "did you mean `" + near + "`?"});
  }
}

// Smallest value over [0, fov / 2] of the slope of a fisheye's curve: the image must grow with it.
bool fisheye_grows(const CameraScenario& camera) {
  const LensScenario& l = camera.lens;
  const double edge = camera.fov_deg * (portable::kPi / 360.0);
  for (int i = 0; i <= 200; ++i) {
    const double a = edge * i / 200, a2 = a * a;
    if (1 + a2 * (3 * l.k1 + a2 * (5 * l.k2 + a2 * (7 * l.k3 + a2 * 9 * l.k4))) <= 0) return false;
  }
  return true;
}

// From the principal point to the farther edge of the image, at a focal length of 1; the corners are farther away.
double edge_of(const Intrinsics& in) {
  return std::max(std::max(in.cx + 0.5, in.width - 0.5 - in.cx) / in.fx, std::max(in.cy + 0.5, in.height - 0.5 - in.cy) / in.fy);
}

// How far from the middle rays of a plumb_bob come, at a focal length of 1, up to `edge`: beyond, its curve turns back.
double plumb_bob_reach(const LensScenario& l, double edge) {
  double reach = 0;
  for (double r = 0; reach < edge && r < 50; r += 1e-3) {
    const double r2 = r * r;
    if (1 + r2 * (3 * l.k1 + r2 * (5 * l.k2 + r2 * 7 * l.k3)) <= 0) break;
    reach = r * (1 + r2 * (l.k1 + r2 * (l.k2 + r2 * l.k3)));
  }
  return reach;
}

constexpr double kWidestEdge = 11.43;  // tan(85 degrees)

constexpr double kMostNoiseEvents = 1e8;  // of an event camera from one frame to the next: 1.6 GB

// trajectory_hz: of a camera without a rate of its own.
void check_camera(const MountedCamera& camera, double trajectory_hz, std::vector<Diagnostic>& mistakes) {
  const std::string at = camera.key() + ".", beside = camera.named ? at : "";  // of what is in its place
  const CameraScenario& c = camera.camera;
  check_channels(c, at, mistakes);
  const auto add = [&](const std::string& key, const std::string& message,
                       const std::string& expected, const std::string& hint) {
    mistakes.push_back({"", 0, key, message, expected, "", hint});
  };
  const LensScenario& l = c.lens;
  if (l.model != LensKind::fisheye && c.fov_deg > 170)
    add(at + "fov_deg", "too wide for a flat image", "at most 170",
        "or " + at + "lens.model = \"fisheye\"");
  if (l.model == LensKind::fisheye && !fisheye_grows(c))
    add(at + "lens", "the lens folds back within the field of view",
        "a curve that grows up to " + at + "fov_deg / 2", "");
  const double edge = edge_of(c.intrinsics());
  if (l.model != LensKind::fisheye && l.fx && edge > kWidestEdge)
    add(at + "lens.fx", "too short for a flat image of this size", "at most 170 degrees of view", "or " + at + "lens.model = \"fisheye\"");
  if (l.model == LensKind::plumb_bob && edge <= kWidestEdge && plumb_bob_reach(l, edge) < 0.99 * edge)
    add(at + "lens", "the lens folds back within the image", "coefficients whose curve grows up to its edges",
        "pixels beyond would see nothing");
  const bool bent = l.k1 != 0 || l.k2 != 0 || l.k3 != 0 || l.k4 != 0 || l.p1 != 0 || l.p2 != 0;
  if (l.model == LensKind::pinhole && bent)
    add(at + "lens.model", "a pinhole has no distortion", "\"plumb_bob\" or \"fisheye\"", "");
  if (l.model == LensKind::plumb_bob && l.k4 != 0)
    add(at + "lens.k4", "only a fisheye has it", "0", "");
  if (l.model == LensKind::fisheye && (l.p1 != 0 || l.p2 != 0))
    add(at + "lens.p1", "a fisheye has no tangential distortion", "p1 and p2 of 0", "");
  if (c.shutter.motion_blur && c.exposure.mode == ExposureMode::ideal)
    add(at + "shutter.motion_blur", "an ideal image has no exposure time",
        at + "exposure.mode of \"fixed\" or \"automatic\"", "");
  if (c.exposure.mode == ExposureMode::automatic && c.exposure.highest_iso < c.exposure.iso)
    add(at + "exposure.highest_iso", "below the lowest ISO speed", "at least " + at + "exposure.iso", "");
  const EventCameraSpec& events = camera.event_camera;
  const double noise_in_frame = events.background_hz / camera.rate_hz.value_or(trajectory_hz) * c.width * c.height;
  if (events.on && noise_in_frame > kMostNoiseEvents)
    add(beside + "event_camera.background_hz", "more noise events from one frame to the next than memory holds",
        "at most 1e8 in all pixels", "or more frames per second, or fewer pixels");
  check_optics(c, at, mistakes);
  if (camera.depth_sensor.min_range >= camera.depth_sensor.max_range)
    add(beside + "depth_sensor.max_range", "the range is empty",
        "more than " + beside + "depth_sensor.min_range", "");
}

// The first of the short form's keys that does not have its default; empty: none.
std::string find_key_of_one_camera(const MissionForm& form) {
  MissionForm given = form, usual;
  const Schema is = make_scenario_schema(given), was = make_scenario_schema(usual);
  for (const Key& key : is.keys()) {
    const std::string group = key.path.substr(0, key.path.find('.'));
    if (group != "camera" && group != "depth_sensor" && group != "event_camera") continue;
    if (key.kind != KeyKind::value) continue;
    if (slot_to_json(key.bind(0)) != slot_to_json(was.find(key.path)->bind(0)))
      return key.path;
  }
  return "";
}

bool is_name(const std::string& text) {
  const auto plain = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  return !text.empty() && text.size() <= 32 && text[0] >= 'a' && text[0] <= 'z' &&
         std::all_of(text.begin(), text.end(), plain);
}

// at: the key of a sensor, such as "imus.head"; what: "an inertial unit".
bool check_name(const std::string& name, const std::string& at, const std::string& what, std::vector<Diagnostic>& mistakes) {
  if (is_name(name)) return true;
  mistakes.push_back({"", 0, at, "not a name of " + what,
                      "a lower-case letter, then such letters, digits and underscores, 32 at most", "\"" + name + "\"", ""});
  return false;
}

// A name of ROS 1 and ROS 2 with a slash before each word; without any of TF.
bool is_ros_name(const std::string& text, bool topic) {
  if (text.empty() || text.back() == '/' || text.size() > 200 || (text[0] == '/') != topic) return false;
  char before = topic ? 0 : '/';
  for (const char c : text) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    const bool inside = letter || (c >= '0' && c <= '9') || c == '_';
    if (before == '/' ? !letter : before != 0 && !inside && c != '/') return false;
    before = c;
  }
  return true;
}

// Of topics and frames: what a mission sets, and that nothing has the name of another.
class SensorNames {
 public:
  explicit SensorNames(std::vector<Diagnostic>& mistakes) : mistakes_(mistakes) {}

  void check(const std::string& key, const std::optional<std::string>& given, bool topic) {
    if (!given) return;
    if (!is_ros_name(*given, topic))
      mistakes_.push_back({"", 0, key, topic ? "not a name of a topic" : "not a name of a frame",
                           topic ? "words of letters, digits and underscores, such as \"/front\""
                                 : "words of letters, digits and underscores, such as \"front_optical\"",
                           "\"" + *given + "\"", ""});
    else if (!taken_.emplace(*given, key).second)
      mistakes_.push_back({"", 0, key, "the name is taken", "a name of its own", "\"" + *given + "\"",
                           taken_[*given] + " has it"});
    else if (const std::string* owner = topic ? find_owner(*given) : nullptr)
      mistakes_.push_back({"", 0, key, "the name is taken", "a name of its own", "\"" + *given + "\"", *owner + " has it"});
  }
  // A name that nothing else may have, of something that is no key.
  void reserve(const std::string& name, const std::string& owner) { taken_.emplace(name, owner); }
  // Topics that begin with these words and a slash.
  void reserve_below(const std::string& topic, const std::string& owner) { owners_.emplace(topic, owner); }
  // A label of a rawlog.
  void label(const std::string& key, const std::string& text) {
    const auto [at, is_new] = labels_.emplace(text, key);
    if (!is_new)
      mistakes_.push_back({"", 0, key, "two observations of the rawlog would have one label", "another name",
                           "\"" + text + "\"", at->second + " has it"});
  }

  std::vector<std::string> frames() const {
    std::vector<std::string> frames;
    for (const auto& [name, key] : taken_)
      if (name[0] != '/' && name != "base_link") frames.push_back(name);
    return frames;
  }

 private:
  const std::string* find_owner(const std::string& topic) const {
    for (const auto& [above, owner] : owners_)
      if (topic.compare(0, above.size() + 1, above + "/") == 0) return &owner;
    return nullptr;
  }

  std::vector<Diagnostic>& mistakes_;
  std::map<std::string, std::string> taken_;   // name to key
  std::map<std::string, std::string> owners_;  // of topics below another: that one to key
  std::map<std::string, std::string> labels_;  // to key
};

// Topics or frames of robots, which no sensor may have.
void reserve_robot_names(const Scenario& scenario, bool topics, SensorNames& names) {
  const std::vector<std::string> robots = robot_names(scenario.robots);
  if (!topics && !robots.empty() && scenario.names_cameras()) names.reserve("rig_link", "the rig");
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const std::string owner = "robots[" + std::to_string(i + 1) + "]";
    const std::string prefix = robots.size() > 1 ? robots[i] + "/" : "";
    if (!topics) names.reserve(prefix + "odom", owner);
    for (const char* topic : {"joint_states", "odom", "ground_truth/odom", "contacts", "robot_description"})
      if (topics) names.reserve("/" + prefix + topic, owner);
  }
}

// What rawlogs call observations (io/mrpt).
void check_labels(const Scenario& scenario, SensorNames& names) {
  if (!scenario.outputs.rawlog) return;
  for (const char* label : {"ground_truth", "ground_truth_depth"}) names.label("the rig", label);
  for (const MountedCamera& camera : scenario.cameras) {
    const std::string at = camera.key();
    names.label(at, camera.name);
    if (camera.camera.stereo_baseline > 0) names.label(at, camera.name + "_right");
    if (camera.ride.on()) names.label(at, camera.name + "_ground_truth");
    if (camera.depth_sensor.type != DepthSensorType::none && scenario.cameras.size() > 1)
      names.label(at, camera.name + "_ground_truth_depth");
  }
  for (const ImuScenario& imu : scenario.imus) names.label(imu.key(), imu.name);
  for (const SensorItem& sensor : scenario.sensors) names.label(sensor.key(), sensor.name);
  const std::vector<std::string> robots = robot_names(scenario.robots);
  for (std::size_t i = 0; i < robots.size(); ++i)
    for (const char* what : {"_odometry", "_ground_truth"})
      names.label("robots[" + std::to_string(i + 1) + "].name", robots[i] + what);
}

// Of all topics and frames.
void check_all_names(const Scenario& scenario, SensorNames& names, std::vector<Diagnostic>& mistakes) {
  for (const char* taken : {"/clock", "/tf", "/tf_static", "/ground_truth"}) names.check(taken, taken, true);
  names.reserve_below("/ground_truth", "ground truth");
  for (const char* taken : {"world", "base_link"}) names.check(taken, taken, false);
  reserve_robot_names(scenario, false, names);
  for (const MountedCamera& camera : scenario.cameras) {
    const std::string at = camera.key(), topic = camera.topic();
    const std::string& name = camera.name;
    if (!is_name(name)) continue;
    names.check(camera.camera.topic ? at + ".topic" : at, topic, true);
    names.check(camera.camera.frame_id ? at + ".frame_id" : at, camera.frame_id(), false);
    names.check(at, name + "_link", false);
    if (camera.camera.stereo_baseline > 0) names.check(at, name + "_right_optical_frame", false);
    for (const char* below : {"/rgb", "/depth_registered", "/right", "/ground_truth"}) names.reserve_below(topic + below, at);
    names.reserve(topic + "/events", at);
  }
  reserve_robot_names(scenario, true, names);  // a camera's topics lie below its own: no clash with these
  for (const ImuScenario& imu : scenario.imus) {
    const std::string at = imu.key();
    if (!check_name(imu.name, at, "an inertial unit", mistakes)) continue;
    names.check(imu.topic ? at + ".topic" : at, imu.ros_topic(), true);
    // Without a name or a pose of its own, it has the frame of its carrier.
    if (!imu.named && !imu.frame_id && imu.is_rig()) continue;
    names.check(imu.frame_id ? at + ".frame_id" : at, imu.frame_id.value_or(imu.name + "_link"), false);
  }
  for (const SensorItem& sensor : scenario.sensors) {
    if (!check_name(sensor.name, sensor.key(), "a sensor", mistakes)) continue;
    const std::string topic = topic_of(scenario.sensors, sensor);
    names.check(sensor.topic ? sensor.key() + ".topic" : sensor.key(), topic, true);
    names.check(sensor.frame_id ? sensor.key() + ".frame_id" : sensor.key(), sensor.frame(), false);
    if (sensor.figures->topics().size() > 1) names.reserve_below(topic, sensor.key());
  }
}

}  // namespace

void check_cameras(const Scenario& scenario, std::vector<Diagnostic>& mistakes) {
  for (const MountedCamera& camera : scenario.cameras) {
    check_name(camera.name, camera.key(), "a camera", mistakes);
    check_camera(camera, scenario.trajectory.rate_hz, mistakes);
  }
}

void check_forms(const MissionForm& form, std::vector<Diagnostic>& mistakes) {
  if (const std::string key = find_key_of_one_camera(form); !form.rest.cameras.empty() && !key.empty())
    mistakes.push_back({"", 0, key, "contradicts cameras", "the key in a table of `cameras`", "both",
                        "each of `cameras` has keys of its own"});
  if (form.imu_on && !form.rest.imus.empty())
    mistakes.push_back({"", 0, "imu.on", "contradicts imus", "one of both", "both", ""});
  // A unit that is off is in no list.
  if (const Carrier& ride = form.imu.ride; !form.imu_on && !ride.on() && !ride.link.empty())
    mistakes.push_back({"", 0, "imu.ride.link", "a link without a robot", "imu.ride.robot as well", "\"" + ride.link + "\"", ""});
}

void check_sensor_names(const Scenario& scenario, std::vector<Diagnostic>& mistakes) {
  SensorNames names(mistakes);
  check_all_names(scenario, names, mistakes);
  check_labels(scenario, names);
}

std::vector<std::string> list_sensor_frames(const Scenario& scenario) {
  std::vector<Diagnostic> mistakes;  // that were reported before
  SensorNames names(mistakes);
  check_all_names(scenario, names, mistakes);
  return names.frames();
}

}  // namespace rubble
