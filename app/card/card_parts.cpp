#include "app/card/card_parts.h"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "kernel/base/text.h"
#include "scripting/values/value.h"

namespace rubble {
namespace {

std::string fixed(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string describe_lens(const Intrinsics& k) {
  std::string text = "fx " + fixed(k.fx, 3) + ", fy " + fixed(k.fy, 3) + ", cx " + fixed(k.cx, 3) + ", cy " +
                     fixed(k.cy, 3) + (k.lens == LensModel::fisheye ? "; fisheye k1..k4" : "; k1 k2 p1 p2 k3");
  for (const double d : k.distortion) text += " " + format_number(d);
  return text;
}

}  // namespace

std::string yaml_quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : printable(text)) out += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return out + "\"";
}

std::string table_cell(const std::string& text) {
  std::string out;
  for (const char c : printable(text)) out += c == '|' ? "\\|" : std::string(1, c);
  return out;
}

std::string table_row(const std::string& a, const std::string& b) { return "| " + a + " | " + b + " |\n"; }

namespace {

std::string carried_by(const Carrier& ride) {
  if (!ride.on()) return "";
  return ", on `" + printable(ride.link.empty() ? ride.robot : ride.robot + "/" + ride.link) + "`";
}

// frames: of a single camera; 0: it is one of several.
std::string describe_camera(const Scenario& s, const MountedCamera& mounted, std::size_t frames) {
  const Intrinsics k = mounted.camera.intrinsics();
  const std::string name = frames > 0 ? "" : " `" + mounted.name + "`";
  const std::string number = frames > 0 ? ", " + std::to_string(frames) + " frames" : "";
  const double rate_hz = mounted.rate_hz.value_or(s.trajectory.rate_hz);
  std::string text = table_row("colour camera" + name, std::to_string(k.width) + " x " + std::to_string(k.height) + " at " +
                                   format_number(rate_hz) + " Hz" + number + carried_by(mounted.ride));
  text += table_row("its lens", describe_lens(k));
  if (mounted.camera.stereo_baseline > 0)
    text += table_row("stereo", "a second camera " + format_number(mounted.camera.stereo_baseline) + " m to the right");
  text += table_row("depth", mounted.depth_sensor.type == DepthSensorType::none
                           ? "exact, along the optical axis, without anti-aliasing"
                           : "exact, and as the depth sensor of the mission measures it");
  if (mounted.event_camera.on) text += table_row("event camera", "the pixels of the colour camera");
  return text;
}

}  // namespace

std::string describe_sensors(const Scenario& s, std::size_t frames) {
  const std::vector<MountedCamera>& cameras = s.cameras;
  const std::vector<ImuScenario>& imus = s.imus;
  std::string text = "## Sensors\n\n| sensor | |\n| --- | --- |\n";
  for (const MountedCamera& mounted : cameras) text += describe_camera(s, mounted, cameras.size() == 1 ? frames : 0);
  if (cameras.size() > 1) text += table_row("frames", std::to_string(frames) + " of all cameras");
  for (const ImuScenario& imu : imus) {
    const ImuModel& m = imu.model;
    text += table_row("inertial unit" + (imus.size() > 1 ? " `" + imu.name + "`" : std::string()),
                      format_number(m.rate_hz) + " Hz; densities: gyroscope " + format_number(m.gyroscope_noise) +
                          " rad/s/sqrt(Hz), accelerometer " + format_number(m.accelerometer_noise) + " m/s2/sqrt(Hz)" +
                          carried_by(imu.ride));
  }
  for (const SensorItem& sensor : s.sensors)
    text += table_row(sensor.figures->title() + " `" + sensor.name + "`", sensor.figures->summary(sensor.rate()) + carried_by(sensor.ride));
  return text + "\n";
}

std::string describe_truth(const Scenario& s, bool flown) {
  std::string text = "## Ground truth\n\n";
  if (flown) text += "Poses of " + std::string(s.cameras.size() > 1 ? "the cameras" : "the camera") + " at each stamp; exact depth; ";
  if (flown && !s.robots.empty()) text += "poses of the robots (`robots/NAME.txt`); ";
  text += s.outputs.stl || !s.outputs.meshes.empty() ? "the settled pile as a mesh" : "the settled pile (`pile.bin`)";
  std::vector<std::string> channels;
  for (const MountedCamera& mounted : s.cameras)
    for (const std::string& channel : mounted.camera.channels)
      if (std::find(channels.begin(), channels.end(), channel) == channels.end()) channels.push_back(channel);
  for (const std::string& channel : flown ? channels : std::vector<std::string>()) text += "; per pixel `" + channel + "`";
  const std::string file = s.names_cameras() ? "`cameras/NAME/groundtruth.txt`" : "`groundtruth.txt`";
  const std::string truth = flown && s.outputs.groundtruth ? " " + file + " has the optical frame in the world, as TUM writes it." : "";
  return text + ".\n\n## Frames\n\nMetres, seconds, right-handed. World: Z up, the ground is z = 0. Camera body "
                "(REP 103): X forward, Y left, Z up. Optical frame: Z forward, X right, Y down." + truth + "\n\n";
}

std::string make_card_head(const std::string& title, const std::string& licence) {
  return "---\npretty_name: " + yaml_quoted(title) + "\nlicense: " +
         yaml_quoted(licence.empty() ? "not stated" : licence) +
         "\ntags: [simulation, search-and-rescue, rgb-d, slam]\n---\n\n# " + title + "\n\n";
}

std::string make_card_licence(const std::string& licence) {
  return "\n## Licence\n\n" +
         (licence.empty() ? std::string("Not stated by whoever made this card.") : printable(licence)) + "\n";
}

}  // namespace rubble
