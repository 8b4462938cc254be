#include "scripting/scenario/scenario.h"

#include <algorithm>

#include "kernel/base/number_text.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"
#include "scripting/robots/robot_kind.h"
#include "scripting/scenario/camera_mistakes.h"
#include "scripting/scenario/mission_form.h"
#include "scripting/scenario/part_schemas.h"
#include "scripting/values/value.h"

namespace rubble {
namespace {

constexpr double kLeastSmoothing = 0.01;  // of a path with an inertial unit; unit: s

// A mix of which nothing can be drawn.
void check_mix(const PileScenario& pile, std::vector<Diagnostic>& mistakes) {
  double sum = 0;
  for (const MixItem& item : pile.mix) sum += item.weight;
  if (!pile.mix.empty() && sum == 0)
    mistakes.push_back(
        {"", 0, "pile.mix", "all weights are 0", "a weight above 0", "only weights of 0", ""});
  for (std::size_t i = 0; i < pile.mix.size(); ++i) {
    double materials = 0;
    for (const MixMaterial& m : pile.mix[i].materials) materials += m.weight;
    if (!pile.mix[i].materials.empty() && materials == 0)
      mistakes.push_back({"", 0, "pile.mix[" + std::to_string(i + 1) + "].materials",
                          "all weights are 0", "a weight above 0", "only weights of 0", ""});
  }
}

void check_density(const SpawnDensity& d, std::vector<Diagnostic>& mistakes) {
  double sum = 0;
  for (const double weight : d.weights) sum += weight;
  const auto add = [&](std::string message, std::string expected, std::string found) {
    mistakes.push_back({"", 0, "pile.spawn_density.weights", std::move(message),
                        std::move(expected), std::move(found), "rubble.density makes such grids"});
  };
  if (d.weights.size() != std::size_t(d.columns) * std::size_t(d.rows))
    add("not a whole grid", "columns * rows = " + std::to_string(d.columns * d.rows) + " numbers",
        std::to_string(d.weights.size()));
  else if (!d.weights.empty() && sum == 0)
    add("all weights are 0", "a weight above 0", "only weights of 0");
}

void check_terrain(const TerrainScenario& t, std::vector<Diagnostic>& mistakes) {
  const auto add = [&](const char* key, std::string message, std::string expected,
                       std::string found) {
    mistakes.push_back({"", 0, std::string("pile.terrain.") + key, std::move(message),
                        std::move(expected), std::move(found), "rubble.terrain makes such grids"});
  };
  if (!t.given()) return;
  if (!t.file.empty() && !t.heights.empty())
    return add("file", "contradicts heights", "one of file and heights", "both");
  if (!t.file.empty()) return;
  if (t.columns < 2 || t.rows < 2 ||
      t.heights.size() != std::size_t(t.columns) * std::size_t(t.rows))
    return add("heights", "not a whole grid",
               "columns * rows numbers, 2 or more each way",
               std::to_string(t.heights.size()) + " for " + std::to_string(t.columns) + " by " +
                   std::to_string(t.rows));
  const double lowest = *std::min_element(t.heights.begin(), t.heights.end()) + t.position.z;
  if (lowest < 0)
    add("heights", "below the ground", "z of 0 m or more", brief_text(lowest) + " m");
}

std::string item_key(const char* list, std::size_t i, const char* name = "") {
  return std::string(list) + "[" + std::to_string(i + 1) + "]" + name;
}

void check_box(const PlacedItem& item, std::size_t i, std::vector<Diagnostic>& mistakes) {
  if (item.box && !item.asset.empty())
    mistakes.push_back({"", 0, item_key("pile.placed", i, ".box"), "contradicts asset",
                        "one of asset and box", "both", ""});
  static const std::vector<std::string> kFaces{"+x", "-x", "+y", "-y", "+z", "-z"};
  for (const std::string& face : item.broken)
    if (std::find(kFaces.begin(), kFaces.end(), face) == kFaces.end())
      mistakes.push_back({"", 0, item_key("pile.placed", i, ".broken"), "no such face",
                          "some of \"+x\", \"-x\", \"+y\", \"-y\", \"+z\", \"-z\"",
                          "\"" + face + "\"", ""});
}

void check_names(const PileScenario& pile, std::vector<Diagnostic>& mistakes) {
  if (!pile.furniture.empty() && !pile.building.given())
    mistakes.push_back({"", 0, "pile.building.furniture", "no building", "pile.building.storeys above 0", "0",
                        "rubble.building{ furniture = {...} } makes one of four storeys"});
  for (std::size_t i = 0; i < pile.mix.size(); ++i)
    if (pile.mix[i].asset.empty())
      mistakes.push_back({"", 0, item_key("pile.mix", i, ".asset"), "no name",
                          "the name of an asset", "an empty string", ""});
  for (std::size_t i = 0; i < pile.placed.size(); ++i) {
    const PlacedItem& item = pile.placed[i];
    if (item.asset.empty() && !item.box)
      mistakes.push_back({"", 0, item_key("pile.placed", i), "no piece",
                          "`asset = NAME` or `box = {x, y, z}`", "neither", ""});
    check_box(item, i, mistakes);
  }
}

void check_meshes(const OutputScenario& outputs, std::vector<Diagnostic>& mistakes) {
  const std::vector<std::string> names = export_names();
  for (std::size_t i = 0; i < outputs.meshes.size(); ++i) {
    const std::string& written = outputs.meshes[i];
    if (std::find(names.begin(), names.end(), written) != names.end()) continue;
    mistakes.push_back({"", 0, "outputs.meshes[" + std::to_string(i + 1) + "]",
                        "unknown format `" + written + "`", "one of ply, obj, glb, sdf, mjcf, usd, urdf", "", ""});
  }
}

// KITTI's pictures are rectified, and each has a scan.
void check_kitti_odometry(const Scenario& scenario, std::vector<Diagnostic>& mistakes) {
  for (const MountedCamera& camera : scenario.cameras) {
    const Intrinsics k = camera.camera.intrinsics();
    const std::string at = camera.key();
    if (k.lens == LensModel::fisheye || k.distortion != std::array<double, 5>{})
      mistakes.push_back({"", 0, at + ".lens", "outputs.kitti_odometry has no place for a distorted lens",
                          "a pinhole without distortion", "a lens with distortion", ""});
    const double rate = camera.rate_hz.value_or(scenario.trajectory.rate_hz);
    for (const SensorItem& sensor : scenario.sensors) {
      const auto spec = sensor.figures->scan_spec();
      if (!spec || spec->planar()) continue;
      if (sensor.rate() != rate)
        mistakes.push_back({"", 0, sensor.key() + ".rate_hz",
                            "outputs.kitti_odometry has one scan for each picture", exact_text(rate) + " Hz, the rate of " + at,
                            exact_text(sensor.rate()) + " Hz", ""});
      break;  // the first one is recorded
    }
  }
}

void check_datasets(const Scenario& scenario, std::vector<Diagnostic>& mistakes) {
  const OutputScenario& outputs = scenario.outputs;
  const std::vector<MountedCamera>& cameras = scenario.cameras;
  if (outputs.kitti_odometry) check_kitti_odometry(scenario, mistakes);
  if (outputs.lerobot && scenario.record_settling.on)
    mistakes.push_back({"", 0, "outputs.lerobot", "an episode has one rate", "no record_settling", "record_settling.on = true", ""});
  const bool fisheye = cameras.front().camera.intrinsics().lens == LensModel::fisheye;
  for (const MountedCamera& camera : cameras) {
    const std::string at = camera.key();
    if (outputs.coco && !camera.camera.has_channel("instance"))
      mistakes.push_back({"", 0, at + ".channels", "outputs.coco needs the numbers of the pieces in the picture",
                          "a list with `instance`", "no `instance`", ""});
    if (outputs.nerfstudio && (camera.camera.intrinsics().lens == LensModel::fisheye) != fisheye)
      mistakes.push_back({"", 0, at + ".lens.model", "outputs.nerfstudio has one lens model for all cameras",
                          fisheye ? "fisheye, as the first camera" : "pinhole or plumb_bob, as the first camera",
                          fisheye ? "another one" : "fisheye", ""});
    if (outputs.lerobot && camera.rate_hz.value_or(scenario.trajectory.rate_hz) !=
                               cameras.front().rate_hz.value_or(scenario.trajectory.rate_hz))
      mistakes.push_back({"", 0, at + ".rate_hz", "outputs.lerobot has one rate for all cameras",
                          exact_text(cameras.front().rate_hz.value_or(scenario.trajectory.rate_hz)) + " Hz",
                          exact_text(camera.rate_hz.value_or(scenario.trajectory.rate_hz)) + " Hz", ""});
  }
}

void check_rawlog(const Scenario& scenario, std::vector<Diagnostic>& mistakes) {
  if (scenario.outputs.rawlog_format == RawlogFormat::observations) return;
  const auto has_odometry = [](const RobotItem& robot) { return kind_of(robot).has_sides(robot); };
  const auto count = std::count_if(scenario.robots.begin(), scenario.robots.end(), has_odometry);
  if (count == 1) return;
  mistakes.push_back({"", 0, "outputs.rawlog_format", "actions need one robot with odometry",
                      "one robot with odometry: a crawler, a rover, or a URDF robot with left_wheels or left_tracks",
                      std::to_string(count) + " of them", "\"observations\" has the odometry of every robot"});
}

void check_record_settling(const RecordSettlingScenario& r, std::vector<Diagnostic>& mistakes) {
  const auto add = [&](const char* key, const char* message, std::string expected, std::string found) {
    mistakes.push_back({"", 0, std::string("record_settling.") + key, message, std::move(expected),
                        std::move(found), ""});
  };
  if (r.to && *r.to <= r.from)
    add("to", "nothing lies between", "more than record_settling.from = " + exact_text(r.from),
        exact_text(*r.to));
  if (r.position.has_value() != r.look_at.has_value())
    add(r.position ? "look_at" : "position", "missing",
        "both of position and look_at, or neither", "one of them");
  if (r.position && r.look_at && distance(*r.position, *r.look_at) < 0.01)
    add("look_at", "is the position of the camera", "a point 0.01 m away or farther", "");
}

// A run that reaches the limit later ends there with an error.
void check_stamps(const Scenario& scenario, std::vector<Diagnostic>& mistakes) {
  constexpr std::int64_t kEnd = std::int64_t{1} << 31;  // builtin_interfaces/Time has 32 bits with a sign; unit: s
  if (!scenario.outputs.mcap || scenario.start_ns / 1000000000 < kEnd) return;
  mistakes.push_back({"", 0, "start_ns", "too late for the stamps of ROS 2, which outputs.mcap holds",
                      "before 2147483648000000000 (19 January 2038)", std::to_string(scenario.start_ns),
                      "begin earlier, or set outputs.mcap = false"});
}

// What can be told before there is a pile.
void check_smoothness(const Scenario& scenario, std::vector<Diagnostic>& mistakes) {
  const TrajectorySpec spec = flown_trajectory(scenario);
  if (scenario.has_unit_on_rig() && spec.smoothing && *spec.smoothing < kLeastSmoothing)
    mistakes.push_back({"", 0, "trajectory.smoothing", "too small for an inertial measurement unit",
                        "at least " + exact_text(kLeastSmoothing) + " s, or no such key",
                        exact_text(*spec.smoothing) + " s",
                        "at corners without smoothing the velocity jumps, which an accelerometer cannot measure"});
  if (!mistakes.empty() || !spec.smoothing || spec.needs_pile()) return;
  try {
    CameraPath{spec};
  } catch (const InputError& error) {
    for (const Diagnostic& d : error.diagnostics()) mistakes.push_back(d);
  }
}

// Files of scans need a sensor that scans.
void check_scans(const Scenario& scenario, std::vector<Diagnostic>& mistakes) {
  const OutputScenario& outputs = scenario.outputs;
  std::string kinds;
  for (const SensorKind* kind : sensor_kinds())
    if (kind->most_points() > 0) kinds += (kinds.empty() ? "`" : " or `") + kind->key() + "`";
  for (const auto& [key, wanted] : {std::pair{"outputs.pcd", outputs.pcd}, {"outputs.kitti", outputs.kitti}})
    if (wanted && std::none_of(scenario.sensors.begin(), scenario.sensors.end(), scans))
      mistakes.push_back({"", 0, key, "there is nothing to write", "a mission with " + kinds, "none", ""});
}

}  // namespace

std::vector<std::string> export_names() { return {"ply", "obj", "glb", "sdf", "mjcf", "usd", "urdf"}; }

std::vector<Diagnostic> find_mistakes(const Scenario& scenario) { return find_mistakes(MissionForm(scenario)); }

std::vector<Diagnostic> find_mistakes(const MissionForm& form) {
  MissionForm copy = form;  // a schema binds members that can be written
  const Scenario scenario = form.normalized();
  std::vector<Diagnostic> mistakes = check_ranges(make_scenario_schema(copy));
  if (!mistakes.empty()) return mistakes;  // what follows relies on finite numbers
  check_names(scenario.pile, mistakes);
  check_mix(scenario.pile, mistakes);
  check_density(scenario.pile.spawn_density, mistakes);
  check_terrain(scenario.pile.terrain, mistakes);
  check_sky(scenario.lights.front(), mistakes);
  check_forms(form, mistakes);
  check_cameras(scenario, mistakes);
  check_sensors(scenario.sensors, mistakes);
  check_scans(scenario, mistakes);
  // What a unit is called is wrong before it is switched on.
  copy.imu_on = form.imu_on || (form.rest.imus.empty() && (form.imu.topic || form.imu.frame_id));
  check_sensor_names(copy.normalized(), mistakes);
  check_meshes(scenario.outputs, mistakes);
  check_datasets(scenario, mistakes);
  check_stamps(scenario, mistakes);
  check_rawlog(scenario, mistakes);
  check_record_settling(scenario.record_settling, mistakes);
  check_robots(scenario, mistakes);
  check_fines(scenario.fines, mistakes);
  check_surroundings(scenario, mistakes);
  if (scenario.victims.count > 0 && needs_track(scenario))
    mistakes.push_back({"", 0, "victims.count", "victims are placed after the pile has settled",
                        "no record_settling and no outputs.track, or 0", std::to_string(scenario.victims.count), ""});
  if (scenario.voids.radius < scenario.voids.voxel)
    mistakes.push_back({"", 0, "voids.radius", "smaller than a voxel",
                        "at least voids.voxel = " + exact_text(scenario.voids.voxel),
                        exact_text(scenario.voids.radius), ""});
  if (scenario.lights.size() > kMostLights)
    mistakes.push_back({"", 0, "lights", "too many lights",
                        "at most " + std::to_string(kMostLights - 1) + " besides the main one",
                        std::to_string(scenario.lights.size() - 1), ""});
  for (Diagnostic& d : find_mistakes(scenario.trajectory)) mistakes.push_back(std::move(d));
  if (mistakes.empty()) check_smoothness(scenario, mistakes);
  return mistakes;
}

// As long as the ride, and as many frames.
static TrajectorySpec stand_in_for_ride(const Scenario& scenario) {
  TrajectorySpec spec;
  spec.rate_hz = scenario.trajectory.rate_hz;
  spec.ride = scenario.trajectory.ride;
  spec.waypoints.assign(2, default_view());
  spec.waypoints[0].t = 0;
  spec.waypoints[1].t = scenario.robot_run.duration;
  return spec;
}

TrajectorySpec flown_trajectory(const Scenario& scenario) {
  TrajectorySpec spec = scenario.trajectory;
  if (spec.ride.on()) return stand_in_for_ride(scenario);
  const bool curved_way = spec.plan == Plan::avoid && spec.interpolation == Interpolation::spline;
  if (!spec.smoothing && !spec.limits.max_jerk && (scenario.has_unit_on_rig() || curved_way))
    spec.smoothing = kUsualSmoothing;
  return spec;
}

bool Scenario::has_unit_on_rig() const {
  return std::any_of(imus.begin(), imus.end(), [](const ImuScenario& imu) { return !imu.ride.on(); });
}

bool needs_track(const Scenario& scenario) {
  return scenario.record_settling.on || scenario.outputs.track;
}

void Scenario::validate() const {
  std::vector<Diagnostic> mistakes = find_mistakes(*this);
  if (!mistakes.empty()) throw InputError(std::move(mistakes));
}

LightSpec resolve_light(const Scenario& scenario) {
  const LightScenario& main = scenario.lights.front();
  LightSpec light = main.spec;
  if (main.random_position) {
    RandomStream random(scenario.seed, "light/position");
    for (int i = 0; i < 3; ++i)
      light.position[i] += random.uniform(-0.5, 0.5) * main.position_bounds[i];
  }
  place_sun(main, light);
  if (!main.random_rotation) return light;
  RandomStream random(scenario.seed, "light/rotation");
  const double pitch = random.uniform(20, 80);
  light.rpy_deg = {0, pitch, random.uniform(-180, 180)};
  light.elevation_deg = random.uniform(5, 70);
  light.azimuth_deg = random.uniform(-180, 180);
  return light;
}

}  // namespace rubble
