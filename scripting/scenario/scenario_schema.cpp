#include "scripting/scenario/mission_form.h"

#include <limits>

#include "scripting/scenario/part_schemas.h"
#include "scripting/scenario/robot_scenario.h"

namespace rubble {
namespace {

void add_top(Schema& k, Scenario& s) {
  k.value("seed", s.seed, "Seed of all random numbers.")
      .between(0, std::numeric_limits<double>::infinity());
  k.value("start_ns", s.start_ns, "Stamp of the first frame. ROS takes 0 for an invalid time.")
      .between(1, 4294967295e9)
      .unit("ns");
  k.value("packs", s.packs,
          "Asset packs: names of bundled packs, or folders relative to the script; empty: `concrete`.");
  k.choice("device", s.device, device_names(),
           "What draws the cameras' images. `software`: this program on the processor, with the same bits on every machine and "
           "without any driver. `gl`: a graphics card; colours differ by a step of 8 bits here and there. `--device` and the "
           "environment variable RUBBLE_DEVICE override it.");
  k.value("wetness", s.wetness,
          "Wetness of all surfaces. Wet surfaces are darker, and glossy where they face up.")
      .between(0, 1);
}

void add_settle(Schema& k, SettleOptions& o) {
  k.group("settle", "Settling of the pile.");
  k.choice("settle.schedule", o.schedule, {"layers", "planes"},
           "When the next layer falls. `layers`: when the previous one rests. `planes`: when the previous one has "
           "landed.");
  k.value("settle.gravity", o.gravity, "Acceleration of gravity, downwards.").between(0, 100).unit("m/s2");
  k.value("settle.step", o.step, "Time step.").between(0.001, 1.0 / 30.0).unit("s");
  k.value("settle.rest_speed", o.rest_speed, "Largest speed of a piece at rest.")
      .above(0, 10)
      .unit("m/s");
  k.value("settle.rest_angular_speed", o.rest_angular_speed, "Largest angular speed of a piece at rest.")
      .above(0, 100)
      .unit("rad/s");
  k.value("settle.rest_overlap", o.rest_overlap,
          "Largest overlap of two pieces in a settled pile.")
      .above(0, 1)
      .unit("m");
  k.value("settle.layer_time_limit", o.layer_time_limit, "Longest time before the next layer falls.")
      .above(0, 3600)
      .unit("s");
  k.value("settle.final_time_limit", o.final_time_limit,
          "Longest time of settling after the last layer.")
      .above(0, 3600)
      .unit("s");
  k.value("settle.lost_below", o.lost_below, "A piece lower than this has left the world.")
      .between(-1000, -0.01)
      .unit("m");
  k.value("settle.lost_beyond", o.lost_beyond, "A piece farther than this from the Z axis has left the world.")
      .above(0, 10000)
      .unit("m");
}

void add_trajectory(Schema& k, TrajectorySpec& t) {
  k.group("trajectory", "The path of the camera.");
  k.value("trajectory.rate_hz", t.rate_hz, "Frames per second.").between(0.001, 1000).unit("Hz");
  k.choice("trajectory.interpolation", t.interpolation, {"automatic", "spline", "linear"},
           "`spline`: a smooth curve through the waypoints. `linear`: straight legs. `automatic`: `linear` with the "
           "plan `avoid`, otherwise `spline`.");
  k.value("trajectory.speed", t.speed, "Speed towards a waypoint that has neither `t` nor `speed`.")
      .above(0, 1000)
      .unit("m/s");
  k.choice("trajectory.plan", t.plan, {"ghost", "refuse", "avoid"},
           "Behaviour at obstacles. `ghost`: fly through pieces. `refuse`: stop the run before the first frame if "
           "the path touches anything. `avoid`: plan the shortest path around obstacles.");
  k.value("trajectory.radius", t.radius, "Radius of the camera body, a sphere, for `plan`.")
      .between(0.005, 10)
      .unit("m");
  k.value("trajectory.duration", t.duration,
          "Duration of the whole path. It overrides the times and speeds of waypoints.")
      .above(0, 86400)
      .unit("s");
  k.value("trajectory.max_speed", t.limits.max_speed, "Largest speed. The path slows down to keep it.")
      .above(0, 1000)
      .unit("m/s");
  k.value("trajectory.max_acceleration", t.limits.max_acceleration,
          "Largest acceleration, also in curves. Straight legs then nearly stop at corners.")
      .above(0, 10000)
      .unit("m/s2");
  k.value("trajectory.max_turn_rate_deg", t.limits.max_turn_rate_deg,
          "Largest turn rate of the view.")
      .above(0, 36000)
      .unit("degree/s");
  k.value("trajectory.max_jerk", t.limits.max_jerk,
          "Largest jerk. The path is smoothed more and, if necessary, slowed down.")
      .above(0, 1e6)
      .unit("m/s3");
  k.value("trajectory.smoothing", t.smoothing,
          "Time over which corners in position and view are rounded, so that the acceleration has no jumps; 0: none. "
          "Not given: 0.1 with an IMU on the rig, `max_jerk`, `rest_at_ends`, or a spline with the plan `avoid`; otherwise 0.")
      .between(0, 2)
      .unit("s");
  k.value("trajectory.rest_at_ends", t.rest_at_ends,
          "The path begins and ends at rest. It takes longer by four times `smoothing`.");
  k.group("trajectory.ride", "The robot that carries the rig, instead of waypoints.");
  k.value("trajectory.ride.robot", t.ride.robot,
          "Name of the robot. Frames are taken while the robot is driven.");
  k.value("trajectory.ride.link", t.ride.link,
          "Link that carries the rig; not given: the first link.");
  k.value("trajectory.ride.position", t.ride.position,
          "Position of the rig in the frame of the link: X forward, Y left, Z up.")
      .between(-10, 10)
      .unit("m");
  k.value("trajectory.ride.rpy_deg", t.ride.rpy_deg, "Orientation of the rig in the frame of the link.")
      .between(-360, 360)
      .unit("degree");
  k.list("trajectory.waypoints", t.waypoints,
         "Points of the path, in order. One point gives one frame.");
  auto& list = t.waypoints;
  k.add("trajectory.waypoints[].position", "Position in the world.",
        [&list](std::size_t i) {
          return Slot(PlaceSlot{&list[i].position, nullptr, &list[i].position_in_void});
        })
      .between(-1000, 1000)
      .unit("m")
      .must();
  k.item("trajectory.waypoints[].t", list, &Waypoint::t, "Time from the start; 0 at the first waypoint.")
      .between(0, 86400)
      .unit("s");
  k.item("trajectory.waypoints[].speed", list, &Waypoint::speed,
         "Instead of `t`: speed along the straight line from the previous waypoint.")
      .above(0, 1000)
      .unit("m/s");
  k.item("trajectory.waypoints[].rpy_deg", list, &Waypoint::rpy_deg,
         "Roll, pitch (positive: nose down) and yaw.")
      .between(-3600, 3600)
      .unit("degree");
  k.add("trajectory.waypoints[].look_at",
        "Instead of pitch and yaw: point in the centre of the view.",
        [&list](std::size_t i) {
          return Slot(PlaceSlot{nullptr, &list[i].look_at, &list[i].look_at_in_void});
        })
      .between(-10000, 10000)
      .unit("m");
}

// at: what the keys begin with: "imu.", or nothing.
void add_imu_figures(Schema& k, const std::string& at, ImuScenario& s) {
  ImuModel& m = s.model;
  k.value(at + "rate_hz", m.rate_hz, "Samples per second.").between(1, 10000).unit("Hz");
  k.value(at + "gyroscope_noise", m.gyroscope_noise, "Noise density of the gyroscope.")
      .between(0, 10)
      .unit("rad/s/sqrt(Hz)");
  k.value(at + "gyroscope_walk", m.gyroscope_walk, "Random walk of the gyroscope's bias.")
      .between(0, 10)
      .unit("rad/s2/sqrt(Hz)");
  k.value(at + "accelerometer_noise", m.accelerometer_noise, "Noise density of the accelerometer.")
      .between(0, 100)
      .unit("m/s2/sqrt(Hz)");
  k.value(at + "accelerometer_walk", m.accelerometer_walk, "Random walk of the accelerometer's bias.")
      .between(0, 100)
      .unit("m/s3/sqrt(Hz)");
  add_ride_keys(k, at, s.ride);
  k.value(at + "position", s.position, "Position on the rig, or on the link of `ride`: X forward, Y left, Z up.")
      .between(-10, 10)
      .unit("m");
  k.value(at + "rpy_deg", s.rpy_deg, "Orientation in the same frame: roll, pitch (positive: down), yaw.")
      .between(-360, 360)
      .unit("degree");
  k.value(at + "topic", s.topic, "ROS topic; not given: `/imu`, or `/NAME` for one of `imus`.");
  k.value(at + "frame_id", s.frame_id,
          "TF frame; not given: the frame of the rig if the IMU has no pose of its own, else `imu_link`, or "
          "`NAME_link` for one of `imus`.");
}

Schema named_imu_schema(ImuScenario& s) {
  Schema k;
  add_imu_figures(k, "", s);
  return k;
}

void add_imu(Schema& k, MissionForm& form) {
  k.group("imu",
          "An inertial measurement unit (IMU) on the rig, with white noise and random-walk biases. The rig of a "
          "single `camera` is the camera body.");
  k.value("imu.on", form.imu_on, "Switches the IMU on.");
  add_imu_figures(k, "imu.", form.imu);
  k.add("imus",
        "Several IMUs instead of `imu`: `imus = { head = { ride = { robot = \"snake\" } } }`. Names have lower-case "
        "letters, digits and underscores. Each IMU has every key of `imu` except `on`.",
        [&form](std::size_t) {
          return Schema::named_tables(form.rest.imus, &ImuScenario::name, "head", named_imu_schema);
        });
}

void add_record_settling(Schema& k, RecordSettlingScenario& r) {
  k.group("record_settling",
          "Records the pile while it settles. The camera stands still and sees the layers fall, before its flight "
          "(docs/explanation/moving_worlds.md).")
      .on_when_written();
  k.value("record_settling.on", r.on,
          "Switches the recording on. A table without this key, even an empty one, also does.");
  k.value("record_settling.from", r.from, "Start of the recording, in simulated time since the first step.")
      .between(0, 86400)
      .unit("s");
  k.value("record_settling.to", r.to, "End of the recording; not given: when the pile rests.")
      .between(0, 86400)
      .unit("s");
  k.value("record_settling.rate_hz", r.rate_hz,
          "Frames per second of cameras without a rate of their own; not given: that of the trajectory.")
      .between(0.001, 1000)
      .unit("Hz");
  k.value("record_settling.position", r.position,
          "Position of the camera, or of the rig; not given: the start of its flight.")
      .between(-1000, 1000)
      .unit("m");
  k.value("record_settling.look_at", r.look_at, "Point in the centre of the view.")
      .between(-10000, 10000)
      .unit("m");
}

void add_outputs(Schema& k, OutputScenario& o) {
  k.group("outputs", "Output files. The formats are described in docs/reference/formats.md.");
  k.value("outputs.rawlog", o.rawlog, "MRPT rawlog: mission.rawlog.");
  k.choice("outputs.rawlog_format", o.rawlog_format, {"observations", "actions"},
           "`observations`: one after another, with odometry and true poses. `actions`: odometry increments of the "
           "one robot and sensory frames in turn, for rbpf-slam (docs/how_to/mrpt_slam.md).");
  k.value("outputs.rawlog_gzip", o.rawlog_gzip,
          "Level of compression; 1 halves the size and takes 3.5 times as long.")
      .between(0, 9);
  k.value("outputs.simplemap", o.simplemap,
          "MRPT key frames with points and true poses: mission.simplemap.");
  k.value("outputs.bag", o.bag, "ROS 1 bag: mission.bag.");
  k.value("outputs.mcap", o.mcap, "ROS 2 recording: mission.mcap.");
  k.value("outputs.tum", o.tum, "TUM RGB-D sequence: the folder tum.");
  k.value("outputs.euroc", o.euroc, "EuRoC MAV sequence, grey pictures: the folder euroc.");
  k.value("outputs.colmap", o.colmap, "COLMAP model with the true poses: the folder colmap.");
  k.value("outputs.frames", o.frames, "Every channel as PNG, EXR or text: the folder frames.");
  k.value("outputs.pcd", o.pcd, "Each scan as a PCD file, and the true motion of its sensor: the folder pcd.");
  k.value("outputs.kitti", o.kitti,
          "Each scan as a KITTI binary file, with times and poses: the folder kitti.");
  k.value("outputs.kitti_odometry", o.kitti_odometry,
          "A KITTI odometry sequence: rectified pictures, the first LiDAR's scans, calibration and poses: the folder "
          "kitti_odometry.");
  k.value("outputs.nerfstudio", o.nerfstudio,
          "Pictures, depth, true poses and points for radiance fields and splats: the folder nerfstudio.");
  k.value("outputs.coco", o.coco,
          "Boxes and masks of all pieces in COCO's format; each camera needs the channel `instance`: the folder coco.");
  k.value("outputs.webdataset", o.webdataset, "Every channel of a camera in tar files of WebDataset: the folder webdataset.");
  k.value("outputs.lerobot", o.lerobot,
          "A LeRobot v3 dataset of one episode, with the states of the robots and videos: the folder lerobot.");
  k.value("outputs.stl", o.stl, "The settled pile as a mesh: pile.stl.");
  k.value("outputs.track", o.track,
          "The motion of every piece while the pile settled: track.bin, and track.glb, a glTF animation.");
  k.value("outputs.meshes", o.meshes,
          "The settled pile in further formats: any of `ply`, `obj`, `glb`, `sdf`, `mjcf`, `usd`, `urdf`. The last four are "
          "scenes for simulators, with all pieces fixed; `rubble export --dynamic` frees pieces.");
  k.value("outputs.groundtruth", o.groundtruth, "Poses of the camera in TUM format: groundtruth.txt.");
  k.value("outputs.sensors", o.sensors, "Readings of range finders, bumpers and so on: sensors/NAME.csv, where the mission has any.");
  k.value("outputs.preview", o.preview, "A contact sheet of colour, depth and the scans of the first sensor that scans, from above: preview.png.");
  k.choice("outputs.depth", o.depth, {"16UC1", "32FC1"},
           "Depth in bag and MCAP files: millimetres (0: none) or metres (NaN: none).");
  k.choice(
      "outputs.pictures", o.pictures, {"raw", "png", "jpeg"},
      "Pictures in bag and MCAP files: raw, or CompressedImage; `jpeg` is lossy for colour, never for depth.");
  k.choice("outputs.vectors", o.vectors, {"values", "colours"},
           "`normals`, `flow` and `position` in bag and MCAP files: 32FC2 and 32FC3, which hold every value, or rgb8, which every "
           "viewer shows.");
}

void add_voids(Schema& k, VoidScenario& v) {
  k.group("voids", "Metrics of the voids of the settled pile, for suites and batches.");
  k.value("voids.on", v.on, "Switches the metrics on. `rubble voids` maps the voids of any finished run.");
  k.value("voids.voxel", v.voxel, "Edge of a voxel. Half the edge needs eight times the memory.")
      .between(0.01, 1)
      .unit("m");
  k.value("voids.radius", v.radius, "Radius of the robot; at least one voxel.")
      .between(0.02, 5)
      .unit("m");
}

// The parameters of the published Unity simulator, under its names. Axes are ours: Z is up.
void add_aliases(Schema& k) {
  for (const std::string axis : {"x", "y", "z"}) {
    k.alias("spawnpos" + axis, "pile.spawn_position." + axis);
    k.alias("spawnbound" + axis, "pile.spawn_bounds." + axis);
    k.alias("lightrot" + axis, "light.rpy_deg." + axis);
    k.alias("lightpos" + axis, "light.position." + axis);
  }
  k.alias("numlayers", "pile.layers");
  k.alias("numobjs", "pile.pieces_per_layer");
  k.alias("setlightrot", "light.random_rotation", true);
  k.alias("lighttype", "light.type");
  k.alias("lightintensity", "light.intensity");
  k.alias("fogdensity", "air.fog_density");
  k.alias("fogintensity", "air.fog_intensity");
  k.alias("randomseed", "seed");
  k.alias("exportstl", "outputs.stl");
}

}  // namespace

Schema make_scenario_schema(MissionForm& form) {
  Scenario& s = form.rest;
  Schema keys;
  add_top(keys, s);
  add_pile_keys(keys, s.pile);
  add_victim_keys(keys, s.victims);
  add_fine_keys(keys, s.fines);
  add_surroundings_keys(keys, s.surroundings);
  add_settle(keys, s.settle);
  add_light_keys(keys, form);
  add_camera_keys(keys, form);
  add_trajectory(keys, s.trajectory);
  add_imu(keys, form);
  add_sensor_keys(keys, s.sensors);
  add_record_settling(keys, s.record_settling);
  add_voids(keys, s.voids);
  add_robot_keys(keys, s);
  add_outputs(keys, s.outputs);
  add_aliases(keys);
  return keys;
}

}  // namespace rubble
