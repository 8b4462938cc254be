#include "scripting/scenario/scenario_schema.h"

#include <limits>

#include "scripting/scenario/camera_schema.h"
#include "scripting/scenario/lidar_schema.h"
#include "scripting/scenario/pile_schema.h"

namespace rubble {
namespace {

void add_top(Schema& k, Scenario& s) {
  k.value("seed", s.seed, "Everything random follows from it.")
      .between(0, std::numeric_limits<double>::infinity());
  k.value("start_ns", s.start_ns, "Stamp of the first frame; ROS takes 0 for an invalid time.")
      .between(1, 4294967295e9)
      .unit("ns");
  k.value("packs", s.packs,
          "Folders of asset packs, relative to the script; none: the bundled pack `concrete`.");
  k.value("wetness", s.wetness, "Of all surfaces: darker, and glossy where they face up.")
      .between(0, 1);
}

void add_settle(Schema& k, SettleOptions& o) {
  k.group("settle", "How the pile comes to rest.");
  k.choice("settle.schedule", o.schedule, {"layers", "planes"},
           "When a layer falls: once the one before rests, or once it has landed (a steady rain).");
  k.value("settle.gravity", o.gravity, "Downwards.").between(0, 100).unit("m/s2");
  k.value("settle.step", o.step, "Time step.").between(0.001, 1.0 / 30.0).unit("s");
  k.value("settle.rest_speed", o.rest_speed, "A piece rests when slower than this and ...")
      .above(0, 10)
      .unit("m/s");
  k.value("settle.rest_angular_speed", o.rest_angular_speed, "... turning slower than this.")
      .above(0, 100)
      .unit("rad/s");
  k.value("settle.rest_overlap", o.rest_overlap,
          "A pile in which two pieces reach deeper into each other has not settled.")
      .above(0, 1)
      .unit("m");
  k.value("settle.layer_time_limit", o.layer_time_limit, "The next layer comes at the latest then.")
      .above(0, 3600)
      .unit("s");
  k.value("settle.final_time_limit", o.final_time_limit, "Settling ends at the latest then.")
      .above(0, 3600)
      .unit("s");
  k.value("settle.lost_below", o.lost_below, "A piece lower than this has left the world.")
      .between(-1000, -0.01)
      .unit("m");
  k.value("settle.lost_beyond", o.lost_beyond, "A piece farther than this from the Z axis has left the world.")
      .above(0, 10000)
      .unit("m");
}

void add_light(Schema& k, LightScenario& l) {
  k.group("light", "The main light.");
  k.choice(
      "light.type", l.spec.type, {"directional", "spot", "point", "sun"},
      "A beam from afar, a floodlight, a bulb; or the sun, whose strength, colour and sky follow "
      "from where it stands.");
  k.value("light.intensity", l.spec.intensity,
          "Directional: illuminance (clear sun: 100 klx); spot and point: kcd.")
      .between(0, 1000)
      .unit("klx or kcd");
  k.value("light.rpy_deg", l.spec.rpy_deg, "Direction of the beam: roll, pitch (down), yaw.")
      .between(-360, 360)
      .unit("degree");
  k.value("light.random_rotation", l.random_rotation,
          "Draw the direction from the seed instead: 20 to 80 degrees down, any yaw.");
  k.value("light.position", l.spec.position, "Of a spot or point light, in the world.")
      .between(-1000, 1000)
      .unit("m");
  k.value("light.cone_deg", l.spec.cone_deg, "Full angle of a spot's cone.")
      .between(1, 170)
      .unit("degree");
  k.value("light.elevation_deg", l.spec.elevation_deg,
          "Of the sun above the horizon; just below it is dusk, at -18 night.")
      .between(-18, 90)
      .unit("degree");
  k.value("light.azimuth_deg", l.spec.azimuth_deg, "Of the sun, from X towards Y.")
      .between(-360, 360)
      .unit("degree");
  k.value("light.random_position", l.random_position,
          "Draw the position from the seed instead: in a box around `position`.");
  k.value("light.position_bounds", l.position_bounds, "Full edge lengths of that box.")
      .between(0, 1000)
      .unit("m");
}

void add_more_lights(Schema& k, std::vector<LightSpec>& lights) {
  k.list("lights", lights,
         "Lights besides the main one, three at most; the sky is the main one's.");
  k.add("lights[].type", "A beam from afar, a floodlight or a bulb.", [&lights](std::size_t i) {
    return Schema::choice_slot(lights[i].type, {"directional", "spot", "point"});
  });
  k.item("lights[].intensity", lights, &LightSpec::intensity,
         "Directional: illuminance; spot and point: kcd.")
      .between(0, 1000)
      .unit("klx or kcd");
  k.item("lights[].rpy_deg", lights, &LightSpec::rpy_deg,
         "Direction of the beam: roll, pitch (down), yaw.")
      .between(-360, 360)
      .unit("degree");
  k.item("lights[].position", lights, &LightSpec::position, "Of a spot or point light.")
      .between(-1000, 1000)
      .unit("m");
  k.item("lights[].cone_deg", lights, &LightSpec::cone_deg, "Full angle of a spot's cone.")
      .between(1, 170)
      .unit("degree");
}

void add_dust(Schema& k, DustSpec& dust) {
  k.group("air.dust", "Dust that bursts out now and then, as when debris shifts.");
  k.value("air.dust.period", dust.period, "Mean time between bursts; 0: none.")
      .between(0, 3600)
      .unit("s");
  k.value("air.dust.irregularity", dust.irregularity,
          "How far a burst may be off its beat, in periods.")
      .between(0, 1);
  k.value("air.dust.position", dust.position, "Bursts start in the box around this point ...")
      .between(-1000, 1000)
      .unit("m");
  k.value("air.dust.bounds", dust.bounds, "... of these full edge lengths.")
      .between(0, 1000)
      .unit("m");
  k.value("air.dust.density", dust.density, "Extinction in the middle of a fresh plume.")
      .between(0, 100)
      .unit("1/m");
  k.value("air.dust.radius", dust.radius, "Of a fresh plume.").between(0.01, 10).unit("m");
  k.value("air.dust.speed", dust.speed, "At which it is thrown out.").between(0, 50).unit("m/s");
  k.value("air.dust.spread", dust.spread, "Turbulent diffusivity.").between(0, 10).unit("m2/s");
  k.value("air.dust.fall", dust.fall, "Speed at which it settles.").between(0, 10).unit("m/s");
  k.value("air.dust.half_life", dust.half_life, "Until half of it is gone from the air.")
      .between(0.1, 3600)
      .unit("s");
  k.value("air.dust.asymmetry", dust.asymmetry, "As `air.fog_asymmetry`, of the dust.")
      .between(-0.99, 0.99);
}

void add_air_and_lamp(Schema& k, AirSpec& air, LampSpec& lamp) {
  k.group("air", "What hangs in the air.");
  k.value("air.fog_density", air.fog_density, "Extinction: transmittance is exp(-density d).")
      .between(0, 10)
      .unit("1/m");
  k.value("air.fog_intensity", air.fog_intensity, "Brightness of the fog.").between(0, 1);
  k.value("air.fog_asymmetry", air.fog_asymmetry,
          "Mean cosine of the angle by which light is scattered (Henyey-Greenstein): 0 evenly, near 1 "
          "almost straight on. Smoke 0.75, droplets 0.85.")
      .between(-0.99, 0.99);
  k.value("air.fog_height", air.fog_height,
          "Density falls by e over so much height above the ground; 0: it does not.")
      .between(0, 1000)
      .unit("m");
  k.value("air.fog_noise", air.fog_noise, "Billows: 0 even, 1 from nothing to double.")
      .between(0, 1);
  k.value("air.fog_noise_size", air.fog_noise_size, "Size of the largest billows.")
      .between(0.05, 100)
      .unit("m");
  k.value("air.wind", air.wind, "Carries billows and dust.").between(-50, 50).unit("m/s");
  add_dust(k, air.dust);
  k.group("lamp", "A lamp on the camera.");
  k.value("lamp.on", lamp.on, "Whether it shines.");
  k.value("lamp.intensity_cd", lamp.intensity_cd, "On its axis.").between(0, 100000).unit("cd");
  k.value("lamp.cone_deg", lamp.cone_deg, "Full angle where it has fallen to half.")
      .between(5, 170)
      .unit("degree");
  k.choice("lamp.shape", lamp.shape, {"point", "ring", "cluster"},
           "A small bright spot, or diodes in a ring or all over a disc.");
  k.value("lamp.size", lamp.size, "Diameter of the ring or disc.").between(0, 1).unit("m");
  k.value("lamp.position", lamp.position, "In the camera frame: X forward, Y left, Z up.")
      .between(-10, 10)
      .unit("m");
}

void add_trajectory(Schema& k, TrajectorySpec& t) {
  k.group("trajectory", "Where the camera goes.");
  k.value("trajectory.rate_hz", t.rate_hz, "Frames per second.").between(0.001, 1000).unit("Hz");
  k.choice("trajectory.interpolation", t.interpolation, {"automatic", "spline", "linear"},
           "A smooth curve through the waypoints, or straight legs; with the plan \"avoid\", the "
           "way that was found made smooth, or its legs. Automatic: the curve, or those legs.");
  k.value("trajectory.speed", t.speed, "To a waypoint that has neither `t` nor `speed`.")
      .above(0, 1000)
      .unit("m/s");
  k.choice("trajectory.plan", t.plan, {"ghost", "refuse", "avoid"},
           "Fly through pieces; stop at the first contact; or find a way around them.");
  k.value("trajectory.radius", t.radius, "Of the sphere that is the camera's body, for the plan.")
      .between(0.005, 10)
      .unit("m");
  k.value("trajectory.duration", t.duration,
          "The whole path takes this long, instead of what its times and speeds add up to.")
      .above(0, 86400)
      .unit("s");
  k.value("trajectory.max_speed", t.limits.max_speed, "Slows the path down where it is faster.")
      .above(0, 1000)
      .unit("m/s");
  k.value("trajectory.max_acceleration", t.limits.max_acceleration,
          "Slows the path down where it accelerates more, also in bends; straight legs then nearly stop at their "
          "corners.")
      .above(0, 10000)
      .unit("m/s2");
  k.value("trajectory.max_turn_rate_deg", t.limits.max_turn_rate_deg,
          "Slows the path down where the view turns faster.")
      .above(0, 36000)
      .unit("degree/s");
  k.value("trajectory.max_jerk", t.limits.max_jerk,
          "Bounds the third derivative: the path is made smooth, softer where that is needed, and "
          "slower where that is not enough.")
      .above(0, 1e6)
      .unit("m/s3");
  k.value("trajectory.smoothing", t.smoothing,
          "Rounds corners in place and in view over about this long, so that the acceleration has no "
          "jumps; 0: leaves them. Not given: 0.1 where an inertial unit is on, with `max_jerk`, "
          "with `rest_at_ends`, and for a spline with the plan \"avoid\"; otherwise 0.")
      .between(0, 2)
      .unit("s");
  k.value("trajectory.rest_at_ends", t.rest_at_ends,
          "It begins and ends standing still, and takes four times `smoothing` longer.");
  k.group("trajectory.ride", "A robot carries the camera, and all that rides with it, instead of waypoints.");
  k.value("trajectory.ride.robot", t.ride.robot,
          "Its name; frames are taken as long as it is driven.");
  k.value("trajectory.ride.link", t.ride.link, "Of the robot; not given: its first.");
  k.value("trajectory.ride.position", t.ride.position,
          "Of the rig in the link's frame: X forward, Y left, Z up.")
      .between(-10, 10)
      .unit("m");
  k.value("trajectory.ride.rpy_deg", t.ride.rpy_deg, "Of the rig in the link's frame.")
      .between(-360, 360)
      .unit("degree");
  k.list("trajectory.waypoints", t.waypoints,
         "Where the camera passes, in order; one gives a single frame.");
  auto& list = t.waypoints;
  k.add("trajectory.waypoints[].position", "In the world.",
        [&list](std::size_t i) {
          return Slot(PlaceSlot{&list[i].position, nullptr, &list[i].position_in_void});
        })
      .between(-1000, 1000)
      .unit("m")
      .must();
  k.item("trajectory.waypoints[].t", list, &Waypoint::t, "When, from the start; the first has 0.")
      .between(0, 86400)
      .unit("s");
  k.item("trajectory.waypoints[].speed", list, &Waypoint::speed,
         "Instead of `t`: from the one before, along the straight line.")
      .above(0, 1000)
      .unit("m/s");
  k.item("trajectory.waypoints[].rpy_deg", list, &Waypoint::rpy_deg,
         "Roll, pitch (positive: nose down) and yaw.")
      .between(-3600, 3600)
      .unit("degree");
  k.add("trajectory.waypoints[].look_at",
        "Instead of pitch and yaw: the point in the middle of the view.",
        [&list](std::size_t i) {
          return Slot(PlaceSlot{nullptr, &list[i].look_at, &list[i].look_at_in_void});
        })
      .between(-10000, 10000)
      .unit("m");
}

void add_imu(Schema& k, ImuScenario& s) {
  ImuModel& m = s.model;
  k.group("imu", "An inertial unit on the rig, of a single camera in its body, with white noise and wandering "
          "biases.");
  k.value("imu.on", s.on, "Whether it is recorded.");
  k.value("imu.rate_hz", m.rate_hz, "Samples per second.").between(1, 10000).unit("Hz");
  k.value("imu.gyroscope_noise", m.gyroscope_noise, "Density of the white noise.")
      .between(0, 10)
      .unit("rad/s/sqrt(Hz)");
  k.value("imu.gyroscope_walk", m.gyroscope_walk, "Density of the bias's steps.")
      .between(0, 10)
      .unit("rad/s2/sqrt(Hz)");
  k.value("imu.accelerometer_noise", m.accelerometer_noise, "Density of the white noise.")
      .between(0, 100)
      .unit("m/s2/sqrt(Hz)");
  k.value("imu.accelerometer_walk", m.accelerometer_walk, "Density of the bias's steps.")
      .between(0, 100)
      .unit("m/s3/sqrt(Hz)");
  k.value("imu.position", s.position, "Where it sits on the rig: X forward, Y left, Z up.")
      .between(-10, 10)
      .unit("m");
  k.value("imu.rpy_deg", s.rpy_deg, "Of its axes in the rig: roll, pitch (positive: down), yaw.")
      .between(-360, 360)
      .unit("degree");
  k.value("imu.topic", s.topic, "ROS: its topic; not given: `/imu`.");
  k.value("imu.frame_id", s.frame_id,
          "TF: its frame; not given: that of the rig where it sits there, else `imu_link`.");
}

void add_record_settling(Schema& k, RecordSettlingScenario& r) {
  k.group("record_settling",
          "The pile seen settling: before its flight the camera stands and watches the layers fall "
          "(docs/moving_worlds.md).")
      .on_when_written();
  k.value("record_settling.on", r.on,
          "Whether it is recorded; a table that does not say so, even an empty one, means true.");
  k.value("record_settling.from", r.from, "When it begins, in simulated time since the first step.")
      .between(0, 86400)
      .unit("s");
  k.value("record_settling.to", r.to, "When it ends; not given: when the pile rests.")
      .between(0, 86400)
      .unit("s");
  k.value("record_settling.rate_hz", r.rate_hz,
          "Frames per second of cameras without a rate of their own; not given: those of the trajectory.")
      .between(0.001, 1000)
      .unit("Hz");
  k.value("record_settling.position", r.position,
          "Where the camera stands, or the rig of several; not given: where its flight begins.")
      .between(-1000, 1000)
      .unit("m");
  k.value("record_settling.look_at", r.look_at, "The point in the middle of its view.")
      .between(-10000, 10000)
      .unit("m");
}

void add_outputs(Schema& k, OutputScenario& o) {
  k.group("outputs", "What is written; each format is described in docs/formats.md.");
  k.value("outputs.rawlog", o.rawlog, "MRPT rawlog: mission.rawlog.");
  k.value("outputs.rawlog_gzip", o.rawlog_gzip,
          "How much it is compressed: 1 halves it and takes 3.5 times as long.")
      .between(0, 9);
  k.value("outputs.simplemap", o.simplemap,
          "MRPT key frames with points and true poses: mission.simplemap.");
  k.value("outputs.bag", o.bag, "ROS 1 bag: mission.bag.");
  k.value("outputs.mcap", o.mcap, "ROS 2 recording: mission.mcap.");
  k.value("outputs.tum", o.tum, "TUM RGB-D sequence: the folder tum.");
  k.value("outputs.euroc", o.euroc, "EuRoC MAV sequence, grey pictures: the folder euroc.");
  k.value("outputs.colmap", o.colmap, "COLMAP model with the true poses: the folder colmap.");
  k.value("outputs.frames", o.frames, "Every channel as PNG, EXR or text: the folder frames.");
  k.value("outputs.pcd", o.pcd, "Each scan of each LiDAR as a PCD file, and its true motion: the folder pcd.");
  k.value("outputs.kitti", o.kitti,
          "Each scan of each LiDAR as KITTI's binary, with times and poses: the folder kitti.");
  k.value("outputs.stl", o.stl, "The settled pile as a mesh: pile.stl.");
  k.value("outputs.track", o.track,
          "Who moved when while the pile settled: track.bin, and track.glb, a glTF animation.");
  k.value("outputs.meshes", o.meshes,
          "The settled pile in further formats: any of `ply`, `obj`, `glb`, `sdf`.");
  k.value("outputs.groundtruth", o.groundtruth, "The camera's poses in TUM format.");
  k.value("outputs.preview", o.preview, "A contact sheet of colour and depth: preview.png.");
  k.choice("outputs.depth", o.depth, {"16UC1", "32FC1"},
           "Depth in bag and MCAP file: millimetres (0: none) or metres (NaN: none).");
  k.choice(
      "outputs.pictures", o.pictures, {"raw", "png", "jpeg"},
      "Pictures there: raw, or CompressedImage; `jpeg` loses detail of colour, never of depth.");
}

void add_voids(Schema& k, VoidScenario& v) {
  k.group("voids", "The voids of the settled pile as metrics, which suites and batches list.");
  k.value("voids.on", v.on, "Whether they are measured; `rubble voids` draws them at any time.");
  k.value("voids.voxel", v.voxel, "Edge of a voxel; half of it: eight times the memory.")
      .between(0.01, 1)
      .unit("m");
  k.value("voids.radius", v.radius, "Of the robot that has to fit in; at least a voxel.")
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

Schema make_scenario_schema(Scenario& s) {
  Schema keys;
  add_top(keys, s);
  add_pile_keys(keys, s.pile);
  add_victim_keys(keys, s.victims);
  add_settle(keys, s.settle);
  add_light(keys, s.light);
  add_more_lights(keys, s.lights);
  add_air_and_lamp(keys, s.air, s.lamp);
  add_camera_keys(keys, s);
  add_trajectory(keys, s.trajectory);
  add_imu(keys, s.imu);
  add_lidar_keys(keys, s);
  add_record_settling(keys, s.record_settling);
  add_voids(keys, s.voids);
  add_robot_keys(keys, s);
  add_outputs(keys, s.outputs);
  add_aliases(keys);
  return keys;
}

}  // namespace rubble
