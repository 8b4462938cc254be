#include "app/card/dataset_card.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "app/estimate/disk_estimate.h"
#include "kernel/base/error.h"
#include "kernel/base/hash.h"
#include "kernel/base/number_text.h"
#include "kernel/base/text.h"
#include "scripting/values/value.h"

namespace rubble {

SplitShares parse_shares(const std::string& text) {
  std::array<int, 3> shares{-1, -1, -1};
  const char *at = text.data(), *const end = at + text.size();
  bool good = true;
  for (std::size_t i = 0; i < 3 && good; ++i) {
    if (i > 0) good = at != end && *at++ == ',';
    const auto read = std::from_chars(at, end, shares[i]);
    good = good && read.ec == std::errc() && shares[i] >= 0 && shares[i] <= 100;
    at = read.ptr;
  }
  if (!good || at != end || shares[0] + shares[1] + shares[2] != 100)
    throw InputError({"", 0, "--splits", "not shares of a dataset",
                      "three whole numbers of percent whose sum is 100, as in 80,10,10", text, ""});
  return {shares[0], shares[1], shares[2]};
}

int split_of(std::uint64_t seed, const SplitShares& shares) {
  const std::string digits = sha256("rubble split " + std::to_string(seed)).substr(0, 8);
  const int n = int(std::stoul(digits, nullptr, 16) % 100);
  return n < shares.train ? 0 : n < shares.train + shares.val ? 1 : 2;
}

std::string describe_rule(const SplitShares& s) {
  const int val = s.train + s.val;
  return "The split follows from the seed alone: n is the number that the first 8 hexadecimal digits of SHA-256 of "
         "`rubble split SEED` write, modulo 100; `train` if n < " + std::to_string(s.train) + ", `val` if n < " +
         std::to_string(val) + ", else `test`. So no pile is in two splits, and more seeds move none.\n";
}

std::string describe_split(std::uint64_t seed, const SplitShares& shares) {
  return "## Split\n\nSeed " + std::to_string(seed) + " is of `" + kSplits[std::size_t(split_of(seed, shares))] +
         "`. " + describe_rule(shares);
}

namespace {

std::string fixed(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string describe_lens(const Intrinsics& k) {
  std::string text = "fx " + fixed(k.fx, 3) + ", fy " + fixed(k.fy, 3) + ", cx " + fixed(k.cx, 3) + ", cy " +
                     fixed(k.cy, 3) + (k.lens == LensModel::fisheye ? "; fisheye k1..k4" : "; k1 k2 p1 p2 k3");
  for (const double d : k.distortion) text += " " + exact_text(d);
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
                                   exact_text(rate_hz) + " Hz" + number + carried_by(mounted.ride));
  text += table_row("its lens", describe_lens(k));
  if (mounted.camera.stereo_baseline > 0)
    text += table_row("stereo", "a second camera " + exact_text(mounted.camera.stereo_baseline) + " m to the right");
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
                      exact_text(m.rate_hz) + " Hz; densities: gyroscope " + exact_text(m.gyroscope_noise) +
                          " rad/s/sqrt(Hz), accelerometer " + exact_text(m.accelerometer_noise) + " m/s2/sqrt(Hz)" +
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

namespace {

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
    text += "| `" + table_cell(name) + "` | " + format_bytes(size) + " | `" + hash.substr(0, 16) + "...` |\n";
  }
  if (count > 0)
    text += "| " + std::to_string(count) + " files in folders | " + format_bytes(small) + " | |\n";
  return text + "\n" + format_bytes(sum) + " in all. `sha256sum -c SHA256SUMS` checks every file.\n\n";
}

std::string metrics(const Manifest& manifest) {
  std::string text = "## Figures\n\n| metric | value |\n| --- | --- |\n";
  for (const auto& [name, value] : manifest.metrics) text += table_row("`" + name + "`", exact_text(value));
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
  std::string text = make_card_head(title, given.licence);
  text += std::to_string(m.pile.pieces) + " pieces of a collapsed structure, " +
          std::string(m.pile.settled ? "at rest" : "which had not come to rest") +
          ", simulated by Rubble " + printable(m.program.version) + " (" + printable(m.program.commit) +
          ") from seed " + std::to_string(m.seed) + ".\n\n";
  if (flown) text += describe_sensors(s, m.frames.frames.size());
  text += describe_truth(s, flown) + files(saved) + metrics(m);
  text += "## How to make it again\n\n    rubble remake manifest.json --out again\n\nThe manifest holds the mission, "
          "its seed and every key; state hash `" + m.pile.state_hash + "`. Packs are found by content:\n\n";
  std::vector<std::string> packs;
  for (const AssetContent& asset : m.provenance.assets)
    if (packs.empty() || packs.back() != asset.pack) packs.push_back(asset.pack);
  for (const std::string& pack : packs) text += "- `" + table_cell(pack) + "`\n";
  return text + "\n" + describe_split(m.seed, given.shares) + make_card_licence(given.licence);
}

std::string make_checksums(const FinishedRun& saved, const std::map<std::string, std::string>& further,
                           const std::string& before) {
  std::map<std::string, std::string> sums = saved.manifest.outputs;
  sums["manifest.json"] = sha256_of_file(saved.folder + "/manifest.json");
  for (const auto& [name, text] : further) sums[name] = sha256(text);
  std::string lines;
  for (const auto& [name, hash] : sums) lines += hash + "  " + before + name + "\n";
  return lines;
}

}  // namespace rubble
