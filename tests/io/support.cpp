#include "tests/io/support.h"

#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"
#include "render/streams/image_streams.h"

namespace rubble::test {
namespace {

// Planar depth along the unit-Z direction (x, y, 1) of the optical frame; NaN: nothing is hit.
float cast_ray(const Vec3& origin, const Vec3& direction) {
  double nearest = std::numeric_limits<double>::infinity();
  if (direction.z < 0) nearest = -origin.z / direction.z;
  const Vec3 to_centre = origin - kSphereCentre;
  const double a = dot(direction, direction), b = dot(direction, to_centre);
  const double c = dot(to_centre, to_centre) - kSphereRadius * kSphereRadius;
  const double root = b * b - a * c;
  if (root >= 0 && (-b - std::sqrt(root)) > 0) {
    nearest = std::min(nearest, (-b - std::sqrt(root)) / a);
  }
  return nearest < 60 ? static_cast<float>(nearest) : std::numeric_limits<float>::quiet_NaN();
}

}  // namespace

ScratchFolder::ScratchFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "rubble-test-XXXXXX").string();
  if (!mkdtemp(pattern.data())) throw std::runtime_error("cannot make a scratch folder");
  path_ = pattern;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::vector<std::string> ScratchFolder::names() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(path_)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

double distance_to_scene(const Vec3& point) {
  return std::min(std::fabs(point.z), std::fabs(distance(point, kSphereCentre) - kSphereRadius));
}

Frame make_frame(int index, int width, int height) {
  Frame frame;
  frame.index = index;
  frame.stamp_ns = 1'000'000'000 + index * std::int64_t{33'333'333};
  frame.intrinsics = {
      width, height, 0.8 * width, 0.81 * width, 0.5 * width - 0.3, 0.5 * height + 0.2, {}};
  frame.world_from_camera = {portable::quat_from_rpy(0.05, 0.2 + 0.01 * index, -0.1),
                             {0.1 * index, 0.5, 1.6}};
  frame.world_from_rig = frame.world_from_camera;
  const Pose world_from_optical = frame.world_from_camera * camera_from_optical;
  const Intrinsics& k = frame.intrinsics;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const Vec3 ray{(u - k.cx) / k.fx, (v - k.cy) / k.fy, 1.0};
      frame.depth.push_back(
          cast_ray(world_from_optical.translation, world_from_optical.rotation.rotate(ray)));
      for (const int c : {u, v, 7 * index + 200}) {
        frame.rgb.push_back(static_cast<std::uint8_t>(c & 255));
      }
    }
  }
  return frame;
}

Frame make_full_frame(int index, int width, int height) {
  Frame frame = make_frame(index, width, height);
  RandomStream random(static_cast<std::uint64_t>(index), "full frame");
  frame.baseline = 0.12;
  frame.rgb_right = frame.rgb;
  std::reverse(frame.rgb_right.begin(), frame.rgb_right.end());
  std::vector<float> normals, flow, sky;
  std::vector<std::uint32_t> instance;
  std::vector<std::uint16_t> label;
  for (const float depth : frame.depth) {
    const bool hit = depth > 0;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    frame.measured_depth.push_back(hit ? depth + 0.01f * static_cast<float>(random.uniform())
                                       : nan);
    const Vec3f normal = hit ? Vec3f(random.direction()) : Vec3f(nan, nan, nan);
    normals.insert(normals.end(), {normal.x, normal.y, normal.z});
    instance.push_back(hit ? static_cast<std::uint32_t>(random.below(2)) : kNoInstance);
    if (hit && depth > 5) instance.back() = kGroundInstance;
    label.push_back(static_cast<std::uint16_t>(hit ? 1 + random.below(3) : 0));
    const auto moved = static_cast<float>(random.uniform(-5, 5));
    sky.push_back(static_cast<float>(random.uniform()));
    flow.insert(flow.end(), {hit ? moved : nan, hit ? 0.25f * moved : nan});
  }
  frame.truth = {{"normals", normals},
                 {"instance", instance},
                 {"label", label},
                 {"flow", flow},
                 {"sky_visibility", sky}};
  const std::int64_t before = frame.stamp_ns - 33'333'333;
  frame.rig_velocity = frame.linear_velocity = {3, 0.25 * index, -0.5};
  for (int i = 0; index > 0 && i < 5 + index; ++i)
    frame.events.push_back({before + 1000 * (i + 1), static_cast<std::uint16_t>(i * 7),
                            static_cast<std::uint16_t>(i), i % 2 == 0});
  return frame;
}

std::vector<ImuSample> make_full_imu(int index) {
  RandomStream random(static_cast<std::uint64_t>(index), "full imu");
  const std::int64_t before = make_frame(index, 1, 1).stamp_ns - 33'333'333;
  std::vector<ImuSample> samples;
  for (int i = index ? 1 : 5; i <= 5; ++i)
    samples.push_back({before + i * 6'666'666 + (i == 5 ? 3 : 0),
                       0,
                       random.direction(),
                       9.81 * random.direction(),
                       {0.01, 0.02, 0.03},
                       {-0.1, 0, 0.1 * i}});
  return samples;
}

void write_full(Recorder& recorder, int index) {
  for (const ImuSample& sample : make_full_imu(index)) recorder.write_imu(sample);
  recorder.write(make_full_frame(index));
}

Recording full_recording() {
  Recording recording;
  recording.cameras.front().baseline = make_full_frame(0, 1, 1).baseline;
  Channels& channels = recording.cameras.front().channels;
  channels.right = channels.measured_depth = channels.events = true;
  for (const char* name : {"normals", "instance", "label", "flow", "sky_visibility"})
    channels.truth.push_back(find_image_stream(name));
  recording.legend.labels = {"sky", "ground", "brick", "slab \"7\""};
  recording.legend.pieces = {{2, "brick"}, {3, "slab \"7\""}};
  recording.imus.emplace_back().model.rate_hz = 150;
  return recording;
}

Frame make_busy_frame(int index, int size) {
  Frame frame = make_frame(index, size, size);
  RandomStream random(static_cast<std::uint64_t>(index), "busy frame");
  // Rendered concrete changes by some grey levels from pixel to pixel, and its depth by
  // millimetres.
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    const std::uint64_t bits = random.next();
    for (std::size_t c = 0; c < 3; ++c) {
      const auto base = static_cast<int>((i / static_cast<std::size_t>(size)) & 127);
      frame.rgb[3 * i + c] = static_cast<std::uint8_t>(base + static_cast<int>(bits & 15));
    }
    frame.depth[i] += 0.0005f * static_cast<float>((bits >> 8) & 7);
  }
  return frame;
}

CommandResult run_command(const std::string& command) {
  CommandResult result;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (!pipe) return {127, "cannot start a shell"};
  char block[4096];
  while (const std::size_t count = std::fread(block, 1, sizeof block, pipe)) {
    result.output.append(block, count);
  }
  const int status = pclose(pipe);
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

CommandResult run_node(const std::string& script, const std::string& arguments) {
  const std::string folder = RUBBLE_NODE_FOLDER;
  // Locked, as tests run side by side; and again whenever the list of packages has changed.
  const CommandResult install =
      run_command("cd '" + folder +
                  "' && flock package.json sh -c 'cmp -s package-lock.json "
                  "node_modules/installed.json || (npm ci --no-audit --no-fund --ignore-scripts "
                  "--loglevel=error && cp package-lock.json node_modules/installed.json)'");
  if (install.exit_code != 0)
    return {install.exit_code, "npm ci failed in " + folder + ":\n" + install.output};
  return run_command("node '" + folder + "/" + script + "' " + arguments);
}

std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

bool exists(const std::string& path) { return std::filesystem::exists(path); }

}  // namespace rubble::test
