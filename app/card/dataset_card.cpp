#include "app/card/dataset_card.h"

#include <cstdio>
#include <filesystem>
#include <vector>

#include "app/estimate/disk_estimate.h"
#include "kernel/base/hash.h"
#include "kernel/base/text.h"
#include "scripting/values/value.h"

namespace rubble {
namespace {

std::string fixed(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

// In double quotes of YAML.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : printable(text)) out += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return out + "\"";
}

// A cell of a table.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : printable(text)) out += c == '|' ? "\\|" : std::string(1, c);
  return out;
}

std::string row(const std::string& a, const std::string& b) { return "| " + a + " | " + b + " |\n"; }

std::string describe_lens(const Intrinsics& k) {
  std::string text = "fx " + fixed(k.fx, 3) + ", fy " + fixed(k.fy, 3) + ", cx " + fixed(k.cx, 3) + ", cy " +
                     fixed(k.cy, 3) + (k.lens == LensModel::fisheye ? "; fisheye k1..k4" : "; k1 k2 p1 p2 k3");
  for (const double d : k.distortion) text += " " + format_number(d);
  return text;
}

std::string sensors(const Scenario& s, std::size_t frames) {
  const Intrinsics k = s.camera.intrinsics();
  std::string text = "## Sensors\n\n| sensor | |\n| --- | --- |\n";
  text += row("colour camera", std::to_string(k.width) + " x " + std::to_string(k.height) + " at " +
                                   format_number(s.trajectory.rate_hz) + " Hz, " + std::to_string(frames) + " frames");
  text += row("its lens", describe_lens(k));
  if (s.camera.stereo_baseline > 0)
    text += row("stereo", "a second camera " + format_number(s.camera.stereo_baseline) + " m to the right");
  text += row("depth", s.depth_sensor.type == DepthSensorType::none
                           ? "exact, along the optical axis, without anti-aliasing"
                           : "exact, and as the depth sensor of the mission measures it");
  if (s.imu.on) {
    const ImuModel& m = s.imu.model;
    text += row("inertial unit", format_number(m.rate_hz) + " Hz in the camera body; densities: gyroscope " +
                                     format_number(m.gyroscope_noise) + " rad/s/sqrt(Hz), accelerometer " +
                                     format_number(m.accelerometer_noise) + " m/s2/sqrt(Hz)");
  }
  for (const LidarScenario& lidar : s.lidars)
    text += row("LiDAR `" + lidar.name + "`", lidar.spec().model + ", " + format_number(lidar.spec().rate_hz) + " scans/s");
  if (s.event_camera.on) text += row("event camera", "the pixels of the colour camera");
  return text + "\n";
}

std::string truth(const Scenario& s) {
  std::string text = "## Ground truth\n\nPoses of the camera at each stamp; exact depth; the settled pile as a mesh";
  for (const std::string& channel : s.camera.channels) text += "; per pixel `" + channel + "`";
  return text + ".\n\n## Frames\n\nMetres, seconds, right-handed. World: Z up, the ground is z = 0. Camera body "
                "(REP 103): X forward, Y left, Z up. Optical frame: Z forward, X right, Y down. "
                "`groundtruth.txt` has the optical frame in the world, as TUM writes it.\n\n";
}

std::string files(const FinishedRun& saved) {
  std::string text = "## Files\n\n| file | size | SHA-256 |\n| --- | --- | --- |\n";
  std::uint64_t sum = 0, small = 0, count = 0;
  for (const auto& [name, hash] : saved.manifest.outputs) {
    std::error_code failed;
    const auto size = std::filesystem::file_size(saved.folder + "/" + name, failed);
    if (failed) continue;
    sum += size;
    if (name.find('/') != std::string::npos) {
      small += size, ++count;  // of a folder of pictures: one line for all
      continue;
    }
    text += "| `" + cell(name) + "` | " + format_bytes(size) + " | `" + hash.substr(0, 16) + "...` |\n";
  }
  if (count > 0)
    text += "| " + std::to_string(count) + " files in folders | " + format_bytes(small) + " | |\n";
  return text + "\n" + format_bytes(sum) + " in all. `sha256sum -c SHA256SUMS` checks every file.\n\n";
}

std::string metrics(const Manifest& manifest) {
  std::string text = "## Figures\n\n| metric | value |\n| --- | --- |\n";
  for (const auto& [name, value] : manifest.metrics) text += row("`" + name + "`", format_number(value));
  return text + "\n";
}

}  // namespace

std::string make_dataset_card(const FinishedRun& saved, const CardText& given) {
  const Manifest& m = saved.manifest;
  const Scenario s = stated_scenario(m.provenance);
  const std::string title = given.title.empty()
                                ? printable(m.provenance.script.path) + ", seed " + std::to_string(m.seed)
                                : printable(given.title);
  const bool flown = !m.frames.frames.empty();
  std::string text = "---\npretty_name: " + quoted(title) + "\nlicense: " +
                     quoted(given.licence.empty() ? "not stated" : given.licence) +
                     "\ntags: [simulation, search-and-rescue, rgb-d, slam]\n---\n\n# " + title + "\n\n";
  text += std::to_string(m.pile.pieces) + " pieces of a collapsed structure, " +
          std::string(m.pile.settled ? "at rest" : "which had not come to rest") +
          ", simulated by Rubble " + printable(m.program.version) + " (" + printable(m.program.commit) +
          ") from seed " + std::to_string(m.seed) + ".\n\n";
  if (flown) text += sensors(s, m.frames.frames.size());
  text += truth(s) + files(saved) + metrics(m);
  text += "## How to make it again\n\n    rubble remake manifest.json --out again\n\nThe manifest holds the mission, "
          "its seed and every key; state hash `" + m.pile.state_hash + "`. Packs are found by content:\n\n";
  std::vector<std::string> packs;
  for (const AssetContent& asset : m.provenance.assets)
    if (packs.empty() || packs.back() != asset.pack) packs.push_back(asset.pack);
  for (const std::string& pack : packs) text += "- `" + cell(pack) + "`\n";
  text += "\n## Licence\n\n" + (given.licence.empty() ? std::string("Not stated by whoever made this card.")
                                                       : printable(given.licence)) + "\n";
  return text;
}

std::string make_checksums(const FinishedRun& saved, const std::map<std::string, std::string>& further) {
  std::map<std::string, std::string> sums = saved.manifest.outputs;
  sums["manifest.json"] = sha256_of_file(saved.folder + "/manifest.json");
  for (const auto& [name, text] : further) sums[name] = sha256(text);
  std::string lines;
  for (const auto& [name, hash] : sums) lines += hash + "  " + name + "\n";
  return lines;
}

}  // namespace rubble
