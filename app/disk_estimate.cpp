#include "app/disk_estimate.h"

#include <cstdio>
#include <filesystem>

#include "scripting/trajectory.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

constexpr double kPieceBytes = 2 * 137;  // in pile.bin and a checkpoint
constexpr double kTriangleBytes = 50;    // of binary STL
constexpr double kPreviewBytes = 6e6;    // of a full contact sheet
constexpr double kFrameOverhead = 4096;  // poses, headers and indices

double pixel_bytes(const Scenario& s) {
  const double camera = 3 + (s.outputs.depth == DepthEncoding::metres ? 4 : 2);
  const ChannelSet c = s.camera.channel_set();
  const double channels =
      12 * c.normals + 4 * c.instance + 2 * c.label + 8 * c.flow + 4 * c.sky_visibility;
  return 5 * s.outputs.rawlog + (camera + channels) * (s.outputs.bag + s.outputs.mcap);
}

// Of the mean piece of a mix.
double mean_triangles(const AssetLibrary& assets) {
  double weights = 0, sum = 0;
  for (const MixEntry& entry : assets.mix) {
    const auto& mesh = assets.meshes[std::size_t(entry.type)]->levels.front();
    sum += entry.weight * double(mesh.triangles.size());
    weights += entry.weight;
  }
  return weights > 0 ? sum / weights : 0;
}

}  // namespace

std::uint64_t estimate_bytes(const Scenario& s, const AssetLibrary& assets) {
  const double frames = double(sample_trajectory(s.trajectory, s.start_ns).size());
  const double pixels = double(s.camera.width) * s.camera.height;
  const double pieces =
      double(s.pile.layers) * s.pile.pieces_per_layer + double(s.pile.placed.size());
  double bytes = frames * (pixels * pixel_bytes(s) + kFrameOverhead) + pieces * kPieceBytes;
  if (s.outputs.stl) bytes += pieces * mean_triangles(assets) * kTriangleBytes;
  if (s.outputs.preview) bytes += kPreviewBytes;
  return std::uint64_t(bytes);
}

std::uint64_t count_bytes(const std::string& folder) {
  std::uint64_t sum = 0;
  std::error_code failed;
  for (const auto& entry : fs::recursive_directory_iterator(folder, failed))
    if (entry.is_regular_file(failed)) sum += entry.file_size(failed);
  return sum;
}

std::uint64_t free_bytes(const std::string& folder) {
  std::error_code failed;
  const fs::space_info space = fs::space(folder, failed);
  return failed ? UINT64_MAX : space.available;
}

std::string format_bytes(std::uint64_t bytes) {
  static const char* const kUnits[] = {"B", "kB", "MB", "GB", "TB", "PB"};
  double value = double(bytes);
  int unit = 0;
  while (value >= 999.5 && unit < 5) value /= 1000, ++unit;
  char text[32];
  std::snprintf(text, sizeof text, unit == 0 || value >= 99.95 ? "%.0f %s" : "%.1f %s", value,
                kUnits[unit]);
  return text;
}

}  // namespace rubble
