#include "scripting/scenario/idle_keys.h"

#include <algorithm>

#include "scripting/robots/robot_kind.h"
#include "scripting/schema/idle_key_list.h"
#include "scripting/schema/override_text.h"
#include "scripting/schema/schema.h"

namespace rubble {
namespace {

void add_main_light(const LightScenario& light, std::vector<IdleKey>& keys) {
  IdleKeys k("light.", keys);
  const LightType type = light.spec.type;
  const bool sun = type == LightType::sun, placed = type == LightType::spot || type == LightType::point;
  k.against(sun, "the sun has the illuminance of its elevation and sky", {"intensity"});
  k.against(sun, "elevation_deg and azimuth_deg give the direction of the sun", {"rpy_deg"});
  k.against(type == LightType::point, "light.type is \"point\"", {"rpy_deg", "random_rotation"});
  k.against(!placed, "only a spot or point light has it", {"position", "random_position", "position_bounds"});
  k.against(type != LightType::spot, "only a spot light has a cone", {"cone_deg"});
  k.against(!sun, "only the light type `sun` has it", {"elevation_deg", "azimuth_deg", "cloud_cover"});
  k.against(sun && light.time.has_value(), "place and time give the position of the sun", {"elevation_deg", "azimuth_deg"});
  k.against(light.random_rotation, "light.random_rotation draws it", {"rpy_deg", "elevation_deg", "azimuth_deg"});
  k.against(sun && light.sky.type != SkyType::cloudy, "light.sky is not \"cloudy\"", {"cloud_cover"});
  k.off(placed && !light.random_position, "random_position", "false", {"position_bounds"});
}

void add_more_lights(const std::vector<LightScenario>& lights, std::vector<IdleKey>& keys) {
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const std::string at = "lights[" + std::to_string(i + 1) + "].";
    IdleKeys k(at, keys);
    const LightType type = lights[i].spec.type;
    k.against(type == LightType::directional, at + "type is \"directional\"", {"position", "cone_deg"});
    k.against(type == LightType::point, at + "type is \"point\"", {"rpy_deg", "cone_deg"});
  }
}

void add_air(const AirSpec& air, const LampSpec& lamp, std::vector<IdleKey>& keys) {
  IdleKeys k("air.", keys);
  k.off(air.fog_density <= 0, "fog_density", "0", {"fog_asymmetry", "fog_height"});
  k.off(air.fog_density <= 0 && air.dust.period <= 0, "fog_density", "0, and there is no dust", {"fog_noise", "fog_noise_size"});
  k.off(air.fog_noise <= 0, "fog_noise", "0", {"fog_noise_size"});
  IdleKeys("air.dust.", keys).off(air.dust.period <= 0, "period", "0");
  IdleKeys l("lamp.", keys);
  l.off(!lamp.on, "on", "false");
  l.against(lamp.on && lamp.shape == LampShape::point, "lamp.shape is \"point\"", {"size"});
}

// at: "camera.", or "cameras.NAME."
void add_camera(const std::string& at, const CameraScenario& camera, std::vector<IdleKey>& keys) {
  IdleKeys k(at, keys);
  const ExposureMode mode = camera.exposure.mode;
  const ImageSensorSpec& sensor = camera.sensor;
  k.off(camera.colour.quality != RenderQuality::reference, "quality", "not \"reference\"", {"samples", "denoise"});
  k.against(camera.lens.fx.has_value(), at + "lens.fx gives the focal length", {"fov_deg"});
  k.off(!camera.shutter.motion_blur, "shutter.motion_blur", "false", {"shutter.most_samples"});
  k.off(mode == ExposureMode::ideal, "exposure.mode", "\"ideal\"", {"exposure", "sensor"});
  k.against(mode == ExposureMode::automatic, "it is automatic", {"exposure.time"});
  k.against(mode == ExposureMode::fixed, at + "exposure.mode is \"fixed\"",
            {"exposure.compensation", "exposure.longest_time", "exposure.highest_iso", "exposure.time_constant", "exposure.delay"});
  if (mode == ExposureMode::ideal) return;
  k.against(sensor.response != Response::gamma, at + "sensor.response is not \"gamma\"", {"sensor.gamma"});
  k.off(sensor.hot_pixels <= 0, "sensor.hot_pixels", "0", {"sensor.hot_current"});
  k.off(!sensor.noise, "sensor.noise", "false", {"sensor.read_noise"});
}

// at: as above, without "camera.".
void add_depth_sensor(const std::string& at, const DepthSensorSpec& sensor, std::vector<IdleKey>& keys) {
  IdleKeys k(at + "depth_sensor.", keys);
  const DepthSensorType type = sensor.type;
  k.off(type == DepthSensorType::none, "type", "\"none\"");
  if (type == DepthSensorType::none) return;
  k.against(type != DepthSensorType::structured_light, "only structured light has it", {"baseline", "disparity_step", "disparity_noise"});
  k.against(type != DepthSensorType::time_of_flight, "only a time-of-flight sensor has it",
            {"modulation_mhz", "signal", "background", "emitter_offset", "least_amplitude", "step"});
  k.against(type == DepthSensorType::ideal, "an ideal sensor returns the exact depth", {"noise", "reflectance"});
}

void add_cameras(const MissionForm& form, std::vector<IdleKey>& keys) {
  add_camera("camera.", form.camera.camera, keys);
  add_depth_sensor("", form.camera.depth_sensor, keys);
  IdleKeys("event_camera.", keys).off(!form.camera.event_camera.on, "on", "false");
  for (const MountedCamera& camera : form.rest.cameras) {
    const std::string at = "cameras." + camera.name + ".";
    add_camera(at, camera.camera, keys);
    add_depth_sensor(at, camera.depth_sensor, keys);
    IdleKeys(at + "event_camera.", keys).off(!camera.event_camera.on, "on", "false");
  }
}

void add_placed(const std::vector<PlacedItem>& placed, std::vector<IdleKey>& keys) {
  for (std::size_t i = 0; i < placed.size(); ++i) {
    IdleKeys k("pile.placed[" + std::to_string(i + 1) + "].", keys);
    k.against(!placed[i].box.has_value(), "the piece is no box", {"material", "broken"});
    k.against(!placed[i].fixed, "the piece is not fixed", {"built_in"});
  }
}

void add_mix(const std::vector<MixItem>& mix, std::vector<IdleKey>& keys) {
  for (std::size_t i = 0; i < mix.size(); ++i) {
    IdleKeys k("pile.mix[" + std::to_string(i + 1) + "].", keys);
    k.off(mix[i].spread.kind == Spread::uniform, "spread", "\"uniform\"", {"typical", "deviation"});
  }
}

void add_building(const BuildingSpec& b, std::vector<IdleKey>& keys) {
  IdleKeys k("pile.building.", keys);
  k.off(!b.given(), "storeys", "0");
  if (!b.given()) return;
  const bool masonry = b.kind == BuildingKind::masonry, frame = b.kind == BuildingKind::frame;
  if (b.planned()) {
    k.against(true, "the plan says it",
              {"kind", "bays_x", "bays_y", "span_x", "span_y", "storey_height", "column", "beam_depth", "slab", "infill",
               "infill_thickness", "openings", "partitions", "parapet", "stairs", "cores", "wall"});
  } else {
    k.against(!masonry, "only masonry has it", {"wall", "joist_depth", "joist_width", "joist_spacing"});
    k.against(masonry, "masonry has walls and timber floors",
              {"column", "beam_depth", "slab", "column_bars", "beam_bars", "slab_bars", "infill_thickness"});
    k.against(!frame, "only a frame has it", {"partitions", "stairs", "cores"});
    k.against(!frame && !masonry, "only a frame or masonry has it", {"infill", "infill_thickness", "openings"});
    k.off(frame && b.infill == Infill::none, "infill", "\"none\"", {"infill_thickness", "openings"});
  }
  const CollapseCause& c = b.cause;
  IdleKeys cause("pile.building.cause.", keys);
  cause.off(c.weak_storey < 0, "weak_storey", "-1", {"weakness"});
  cause.off(c.overloaded_floor < 0, "overloaded_floor", "-1", {"overload"});
  cause.off(!(c.overload > 0), "overload", "0", {"overloaded_floor"});
  cause.off(!(c.shake > 0), "shake", "0", {"shake_hz", "shake_seconds", "shake_direction_deg", "accelerogram", "accelerogram_step"});
  cause.against(c.shake > 0 && !c.accelerogram.empty(), "the accelerogram says it", {"shake_hz", "shake_seconds"});
  cause.off(c.accelerogram.empty(), "accelerogram", "empty", {"accelerogram_step"});
  cause.off(!(c.blast > 0), "blast", "0", {"blast_at"});
  IdleKeys("pile.building.cause.vehicle.", keys).off(!(c.vehicle.mass > 0), "mass", "0");
  IdleKeys("pile.building.cause.vehicle.", keys)
      .off(c.vehicle.mass > 0 && !(c.vehicle.speed > 0), "speed", "0", {"mass", "direction_deg", "stiffness", "height", "i", "j", "part"});
}

// "a robot of another kind has it": the figures of all kinds are keys of each robot.
void add_robot(const std::string& at, const RobotItem& robot, std::vector<IdleKey>& keys) {
  IdleKeys k(at, keys);
  const RobotKind& own = kind_of(robot);
  for (const RobotKind* kind : robot_kinds()) {
    const std::unique_ptr<RobotFigures> figures = kind == &own ? nullptr : kind->figures();
    if (!figures) continue;
    Schema schema;
    figures->add_keys(schema);
    IdleKeys::Names names;
    for (const Key& key : schema.keys()) names.push_back(key.path);
    k.against(true, "only a " + kind->name() + " has it", names);
  }
  const bool of_file = !robot.urdf.empty();
  k.against(of_file, at + "urdf gives the robot", {"model"});
  k.against(!of_file, "only a robot from a URDF file has it", {"wheel_radius", "track_speed"});
  k.off(of_file && robot.left_wheels.empty(), "left_wheels", "empty", {"wheel_radius"});
  k.off(of_file && robot.left_tracks.empty(), "left_tracks", "empty", {"track_speed"});
  k.against(!own.has_sides(robot), "the robot has neither tracks nor driven wheels, so no odometry", {"odometry_noise"});
}

std::vector<IdleKey> list_idle_keys(const MissionForm& form) {
  const Scenario& s = form.rest;
  std::vector<IdleKey> keys;
  IdleKeys("pile.", keys).off(s.pile.layers == 0, "layers", "0",
                              {"pieces_per_layer", "spawn_position", "spawn_bounds", "spawn_density"});
  IdleKeys terrain("pile.terrain.", keys);
  terrain.against(s.pile.terrain.file.empty(), "pile.terrain.file is not given", {"metres_per_unit", "up"});
  terrain.against(s.pile.terrain.heights.empty(), "pile.terrain.heights are not given", {"columns", "rows", "spacing"});
  terrain.against(!s.pile.terrain.given(), "there is no terrain", {"position", "friction", "look"});
  add_mix(s.pile.mix, keys);
  add_placed(s.pile.placed, keys);
  add_building(s.pile.building, keys);
  IdleKeys("victims.", keys).off(s.victims.count == 0, "count", "0");
  IdleKeys("fines.", keys).off(s.fines.amount == 0, "amount", "0");
  IdleKeys street("surroundings.", keys);
  street.off(!s.surroundings.on(), "type", "\"none\"");
  street.off(s.surroundings.on() && s.surroundings.lamps == StreetLampState::off, "lamps", "\"off\"", {"lit_windows"});
  add_main_light(form.light, keys);
  add_more_lights(s.lights, keys);
  add_air(s.air, s.lamp, keys);
  add_cameras(form, keys);
  IdleKeys("imu.", keys).off(!form.imu_on, "on", "false");
  IdleKeys("record_settling.", keys).off(!s.record_settling.on, "on", "false");
  IdleKeys("voids.", keys).off(!s.voids.on, "on", "false");
  IdleKeys path("trajectory.", keys);
  path.off(s.trajectory.plan == Plan::ghost, "plan", "\"ghost\"", {"radius"});
  path.off(!s.trajectory.ride.on(), "ride.robot", "not given", {"ride"});
  path.against(s.trajectory.waypoints.size() == 1, "there is one waypoint: a second one at the same place holds the camera there",
               {"duration", "speed"});
  for (std::size_t i = 0; i < s.robots.size(); ++i) add_robot("robots[" + std::to_string(i + 1) + "].", s.robots[i], keys);
  IdleKeys("robot_run.", keys).against(s.robots.empty(), "the mission has no robots", {"duration", "control_hz", "debris", "live_light"});
  IdleKeys("outputs.", keys).off(!s.outputs.rawlog, "rawlog", "false", {"rawlog_format", "rawlog_gzip"});
  IdleKeys("outputs.", keys).against(!s.outputs.bag && !s.outputs.mcap, "there is neither a bag nor an MCAP file", {"depth", "pictures", "vectors"});
  return keys;
}

bool contains(const std::vector<std::string>& paths, const std::string& path) {
  return std::find(paths.begin(), paths.end(), path) != paths.end();
}

}  // namespace

std::vector<Diagnostic> find_idle_keys(const MissionForm& form, const StatedKeys& stated) {
  std::vector<Diagnostic> found;
  std::vector<std::string> named;
  const std::vector<IdleKey> idle = list_idle_keys(form);
  const auto note = [&](const std::string& path, const char* file, const auto& excused) {
    for (const IdleKey& key : idle) {
      if (!is_within(path, key.path) || path == key.switch_key || excused(key) || contains(named, path)) continue;
      named.push_back(path);
      found.push_back({file, 0, path, idle_sentence(key), "", "", ""});
    }
  };
  for (const std::string& path : stated.by_set)
    note(path, "--set", [&](const IdleKey& key) { return contains(stated.by_set, key.switch_key); });
  for (const std::string& path : stated.in_script) {
    note(path, "", [&](const IdleKey& key) {
      return contains(stated.in_script, key.switch_key) || contains(stated.by_set, key.switch_key);
    });
  }
  return found;
}

}  // namespace rubble
