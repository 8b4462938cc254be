#include "app/pipeline/disk_estimate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "io/mrpt/simplemap_recorder.h"
#include "scripting/trajectory/trajectory.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

using Estimate = std::map<std::string, std::uint64_t>;

constexpr double kPreviewBytes = 6e6;           // of a full contact sheet
constexpr double kManifestBytes = 3e5;          // scripts, scenario, assets
constexpr double kFrameOverhead = 4096;         // poses, headers and indices
constexpr double kPictureOverhead = 2048;       // of a file of its own, and its line in a list
constexpr double kLuck = 4.0 / 3;               // what the draw may favour large meshes by
constexpr double kEventsPerPixel = 0.5;         // a frame
constexpr double kUnknownFlight = 60;           // of a path into a void without `duration`; unit: s
constexpr double kPieceBytes = 137;             // in pile.bin
constexpr double kDegrees = 57.29577951308232;  // of a radian

// What lies there, as far as it can be known before it is drawn: means over the mix.
struct PileSize {
  double pieces = 0, triangles = 0;
  double types = 0, type_triangles = 0;  // each type once
};

double triangles_of(const AssetLibrary& assets, int type) {
  return double(assets.meshes[std::size_t(type)]->levels.front().triangles.size());
}

// Of a type or an assembly, as placements and mixes have it.
void add(const AssetLibrary& assets, int index, double times, PileSize& size) {
  const auto types = int(assets.types.size());
  if (index < types) {
    size.pieces += times;
    size.triangles += times * triangles_of(assets, index);
    return;
  }
  for (const AssemblyLink& link : assets.assemblies[std::size_t(index - types)].links)
    add(assets, link.type, times, size);
}

PileSize size_of_pile(const Scenario& s, const AssetLibrary& assets) {
  PileSize size;
  double weights = 0;
  for (const MixEntry& entry : assets.mix) weights += entry.weight;
  const double dropped = double(s.pile.layers) * s.pile.pieces_per_layer;
  for (const MixEntry& entry : assets.mix)
    if (weights > 0) add(assets, entry.type, dropped * entry.weight / weights, size);
  size.triangles *= kLuck;
  for (const PlacedItem& item : s.pile.placed) add(assets, assets.find(item), 1, size);
  size.types = double(assets.types.size());
  for (std::size_t i = 0; i < assets.types.size(); ++i)
    size.type_triangles += triangles_of(assets, int(i));
  return size;
}

// A welded mesh has about half as many vertices as triangles; a text of one number up to 12 bytes.
void add_meshes(const Scenario& s, const PileSize& pile, Estimate& sizes) {
  constexpr double kObjTriangle = 190, kGlbTriangle = 84;
  std::vector<std::string> formats = s.outputs.meshes;
  if (s.outputs.stl) formats.push_back("stl");
  for (const std::string& format : formats) {
    const std::string name = format == "sdf" ? "sdf" : "pile." + format;
    double bytes = 1000;
    if (format == "stl") bytes += 50 * pile.triangles;
    if (format == "ply") bytes += (13 + 19) * pile.triangles;
    if (format == "obj") bytes += kObjTriangle * pile.triangles + 40 * pile.pieces;
    if (format == "glb")
      bytes += kGlbTriangle * pile.type_triangles + 320 * pile.pieces + 2000 * pile.types;
    if (format == "sdf") bytes += kObjTriangle * pile.type_triangles + 1100 * pile.pieces + 4000;
    sizes[name] = std::uint64_t(bytes);
    if (format == "obj") sizes["pile.mtl"] = 10000;
  }
}

// What is recorded of a flight.
struct FlightSize {
  double frames = 0, key_frames = 0, imu_samples = 0;
};

double angle_between(const Quat& a, const Quat& b) {
  return 2 * std::acos(std::min(1.0, std::fabs((a.conjugate() * b).w)));
}

// A path into a void is known only when there is a pile.
bool leads_into_voids(const TrajectorySpec& path) {
  for (const Waypoint& w : path.waypoints)
    if (w.position_in_void || w.look_at_in_void) return true;
  return false;
}

FlightSize size_of_flight(const Scenario& s) {
  FlightSize size;
  const TrajectorySpec path = flown_trajectory(s);
  if (leads_into_voids(path)) {
    size.frames = std::floor(path.duration.value_or(kUnknownFlight) * path.rate_hz) + 1;
    size.key_frames = size.frames;
  } else {
    const SimplemapOptions key;
    const auto poses = sample_trajectory(path, s.start_ns);
    size.frames = double(poses.size());
    size.key_frames = 1;
    for (std::size_t i = 1; i < poses.size(); ++i) {
      const Pose &a = poses[i - 1].world_from_camera, &b = poses[i].world_from_camera;
      size.key_frames +=
          std::min(1.0, distance(a.translation, b.translation) / key.distance +
                            angle_between(a.rotation, b.rotation) * kDegrees / key.angle_deg);
    }
  }
  if (s.imu.on) size.imu_samples = size.frames * s.imu.model.rate_hz / path.rate_hz;
  return size;
}

// Bytes of a frame's pixels in each kind of recording, apart from what is kept once.
class PictureSize {
 public:
  explicit PictureSize(const Scenario& s)
      : pixels_(double(s.camera.width) * s.camera.height),
        truth_(s.camera.channel_set()),
        right_(s.camera.stereo_baseline > 0),
        measured_(s.depth_sensor.type != DepthSensorType::none),
        events_(s.event_camera.on ? kEventsPerPixel * pixels_ : 0),
        ros_depth_(s.outputs.depth == DepthEncoding::metres ? 4 : 2) {}

  double colours() const { return pixels_ * (right_ ? 6 : 3); }
  double rawlog() const { return colours() + pixels_ * (measured_ ? 4 : 2); }
  double ros() const {
    const double depth = ros_depth_ + (measured_ ? 4 : 0);
    return colours() + pixels_ * (depth + truth()) + 13 * events_;
  }
  double tum() const { return pixels_ * (3 + (measured_ ? 4 : 2)); }
  double euroc() const { return colours() / 3; }
  double frames() const {
    return colours() + pixels_ * ((measured_ ? 8 : 4) + truth()) + 25 * events_;
  }
  // How many files a frame is in a folder with all channels.
  static constexpr int kMostFiles = 9;

 private:
  double truth() const {
    return 12 * truth_.normals + 4 * truth_.instance + 2 * truth_.label + 8 * truth_.flow +
           4 * truth_.sky_visibility;
  }

  double pixels_;
  ChannelSet truth_;
  bool right_, measured_;
  double events_;
  int ros_depth_;
};

double simplemap_frame(const Scenario& s) {
  const double across = std::min(s.camera.width, SimplemapOptions().points_across);
  return 16 * across * (across * s.camera.height / s.camera.width + 1) + kFrameOverhead;
}

void add_recordings(const Scenario& s, const FlightSize& flight, double pieces, Estimate& sizes) {
  const OutputScenario& o = s.outputs;
  const PictureSize picture(s);
  const auto add = [&](bool wanted, const char* name, double frame, double imu_sample,
                       double once = 0) {
    if (wanted)
      sizes[name] = std::uint64_t(flight.frames * frame + flight.imu_samples * imu_sample + once);
  };
  const double legend = 100 * pieces + 2e4, files = kPictureOverhead * PictureSize::kMostFiles;
  add(o.rawlog, "mission.rawlog", picture.rawlog() + kFrameOverhead, 420);
  add(o.bag, "mission.bag", picture.ros() + kFrameOverhead, 420, legend);
  add(o.mcap, "mission.mcap", picture.ros() + kFrameOverhead, 420, legend + 1e5);
  add(o.groundtruth, "groundtruth.txt", 140, 0, 100);
  add(o.tum, "tum", picture.tum() + 3 * kPictureOverhead, 0, 2000);
  add(o.euroc, "euroc", picture.euroc() + 2 * kPictureOverhead, 500, 10000);
  add(o.colmap, "colmap", picture.colours() + 2 * kPictureOverhead, 0, 2000);
  add(o.frames, "frames", picture.frames() + files, 320, legend);
  if (o.simplemap)
    sizes["mission.simplemap"] = std::uint64_t(flight.key_frames * simplemap_frame(s) + 1000);
  if (o.preview) sizes["preview.png"] = std::uint64_t(kPreviewBytes);
  if (s.camera.channel_set().label) sizes["labels.csv"] = 10000;
  if (s.trajectory.needs_pile()) sizes["flight.json"] = std::uint64_t(400 * flight.frames + 1e5);
}

}  // namespace

Estimate estimate_outputs(const Scenario& s, const AssetLibrary& assets) {
  Estimate sizes;
  const PileSize pile = size_of_pile(s, assets);
  const FlightSize flight = size_of_flight(s);
  sizes["pile.bin"] = std::uint64_t(pile.pieces * kPieceBytes + 2000);
  sizes["manifest.json"] = std::uint64_t(flight.frames * 250 + kManifestBytes);
  add_meshes(s, pile, sizes);
  add_recordings(s, flight, pile.pieces, sizes);
  return sizes;
}

std::uint64_t estimate_bytes(const Scenario& s, const AssetLibrary& assets, bool pile_only) {
  std::uint64_t sum = 0;
  for (const auto& [name, bytes] : estimate_outputs(s, assets)) {
    const bool of_pile = name.rfind("pile.", 0) == 0 || name == "sdf" || name == "manifest.json";
    if (of_pile || !pile_only) sum += bytes;
  }
  return sum;
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
