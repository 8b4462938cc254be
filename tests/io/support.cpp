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

std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

bool exists(const std::string& path) { return std::filesystem::exists(path); }

}  // namespace rubble::test
