#include "app/estimate/disk_estimate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <vector>

#include "app/formats/recording_formats.h"
#include "io/scenes/pile_export.h"
#include "kernel/structure/building.h"
#include "scripting/robots/robot_kind.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

using Estimate = std::map<std::string, std::uint64_t>;

constexpr double kManifestBytes = 3e5;       // scripts, scenario, assets
constexpr double kSamplingMargin = 4.0 / 3;  // what the draw may favour large meshes by
constexpr double kPieceBytes = 137;          // in pile.bin
constexpr double kBondedPieceBytes = 400;    // of a building's piece besides, for bodies and up to four ties
constexpr double kKeyBytes = 84, kClipBytes = 32;  // in track.bin and track.glb
constexpr double kMovingTime = 4;  // of a piece after its layer's time limit, or pushed by a robot; unit: s

// What lies there, as far as it can be known before it is drawn: means over the mix.
double triangles_of(const AssetLibrary& assets, int type) {
  return double(assets.meshes[std::size_t(type)]->levels.front().triangles.size());
}

// of_type: how many pieces each type has; expected numbers.
struct PileCount : PileModelSize {
  explicit PileCount(const AssetLibrary& assets) : of_type(assets.types.size()) {}
  std::vector<double> of_type;
};

void add(const AssetLibrary& assets, PieceKind kind, double times, PileCount& size) {
  const int index = kind.index;
  if (!kind.is_assembly) {
    size.pieces += times;
    size.triangles += times * triangles_of(assets, index);
    size.of_type[std::size_t(index)] += times;
    return;
  }
  for (const AssemblyLink& link : assets.assemblies[std::size_t(index)].links)
    add(assets, link.type, times, size);
}

// What fines leave, from counts of shapes: kernel/geometry/fine_shapes.h, kernel/fines. A heap is a type of its
// own in exports.
struct FinesSize {
  double triangles = 0, bytes = 0, heaps = 0;
};

FinesSize size_of_fines(const FinesSpec& f) {
  // Triangles at most.
  constexpr double kOfFlake = 24, kOfDrift = 680, kOfPaper = 200, kOfCloth = 1450, kOfStrand = 2300;
  constexpr double kPiecesOfHeap = 12, kBytesOfTriangle = 30;
  if (f.amount == 0) return {};
  const double shares = f.grit + f.plaster + f.glass + f.paper + f.cloth;
  const double of_grit = f.size[0] >= 0.005 ? 20 : 9.5;
  const double each = (of_grit * f.grit + kOfFlake * (f.plaster + f.glass)) / shares;
  const double sheets = f.amount * (f.paper + f.cloth) / shares, strands = f.cables + f.pipes;
  const double others = kOfDrift * f.drifts + f.amount * (kOfPaper * f.paper + kOfCloth * f.cloth) / shares +
                        kOfStrand * strands;
  return {each * f.amount + others, 48.0 * f.amount + kBytesOfTriangle * others + 1000,
          f.amount / kPiecesOfHeap + f.drifts + sheets + strands};
}

void add_fines(const FinesSpec& fines, PileModelSize& size) {
  const FinesSize of = size_of_fines(fines);
  size.pieces += of.heaps, size.types += of.heaps;
  size.triangles += of.triangles, size.type_triangles += of.triangles;
}

// Of a street with as many trees and vehicles as there may be, by counts over its reach.
void add_surroundings(const SurroundingsSpec& s, PileModelSize& size) {
  if (!s.on()) return;
  size.pieces += 220 + 1.5 * s.reach, size.types += 60 + 0.4 * s.reach;
  size.triangles += 3.5e5 + 6e3 * s.reach, size.type_triangles += 2.2e5 + 1.5e3 * s.reach;
}

// The building's pieces, and what furnishes it: in each bay of each floor, or on each floor of a plan.
void add_building(const PileScenario& pile, const AssetLibrary& assets, PileCount& size) {
  for (const StructurePiece& piece : assets.structures->damaged.pieces) add(assets, assets.building_first_type + piece.type, 1, size);
  const BuildingSpec& b = pile.building;
  const double bays = b.planned() ? 1 : double(b.bays_x) * b.bays_y;
  const double storeys = b.planned() ? double(b.plan.heights.size()) : b.storeys;
  for (const FurnitureItem& item : pile.furniture)
    add(assets, assets.find(item.asset), std::ceil(item.per_bay) * bays * (storeys + item.roof), size);
}

PileModelSize size_of_pile(const Scenario& s, const AssetLibrary& assets) {
  PileCount size(assets);
  double weights = 0;
  for (const MixEntry& entry : assets.mix) weights += entry.weight;
  const double dropped = double(s.pile.layers) * s.pile.pieces_per_layer;
  for (const MixEntry& entry : assets.mix)
    if (weights > 0) add(assets, entry.kind, dropped * entry.weight / weights, size);
  size.triangles *= kSamplingMargin;
  for (const PlacedItem& item : s.pile.placed) add(assets, assets.find(item), 1, size);
  if (s.pile.building.given()) add_building(s.pile, assets, size);
  add_fines(s.fines, size);
  add_surroundings(s.surroundings, size);
  for (std::size_t i = 0; i < assets.types.size(); ++i) {
    const double likely = std::min(1.0, size.of_type[i]);
    size.types += likely, size.type_triangles += likely * triangles_of(assets, int(i));
  }
  return size;
}

void add_meshes(const Scenario& s, const PileModelSize& pile, Estimate& sizes) {
  std::vector<std::string> names = s.outputs.meshes;
  if (s.outputs.stl) names.push_back("stl");
  for (const std::string& name : names) {
    const MeshFormat& format = find_mesh_format(name);
    for (const std::string& beside : format.leaves) sizes[beside] = 10000;
    sizes[format.leaves.back()] = std::uint64_t(format.estimate(pile));
  }
}

// How long pieces move is known only afterwards.
void add_track(const Scenario& s, const PileModelSize& pile, Estimate& sizes) {
  if (!needs_track(s)) return;
  const double keys = pile.pieces * (s.settle.layer_time_limit + kMovingTime) / s.settle.step;
  sizes["track.bin"] = std::uint64_t(keys * kKeyBytes + 2e4);
  if (!s.outputs.track) return;
  const double clip = keys * kClipBytes + pile.pieces * 1500;
  sizes["track.glb"] = std::uint64_t(find_mesh_format("glb").estimate(pile) + clip + 2e4);
}

// What a robot's files depend on; of one from a URDF file, which is not read yet, those of a large one.
struct RobotSize {
  double links = 30, driven = 30, description = 5e6;  // description: URDF and meshes; unit: byte
};

RobotSize size_of_robot(const RobotItem& robot) {
  constexpr double kUrdfBytes = 3000, kTriangleBytes = 50, kPointBytes = 200;
  if (!robot.urdf.empty()) return {};
  const RobotModel model = robot_kinds()[std::size_t(robot.model)]->make(robot);
  RobotSize size{double(model.links.size()), 0, 0};
  for (const RobotJoint& joint : model.joints) size.driven += joint.motor.effort > 0;
  for (const RobotLink& link : model.links) {
    size.description += kUrdfBytes + kTriangleBytes * double(link.looks.triangles.size());
    for (const ConvexPart& part : link.parts) size.description += kPointBytes * double(part.points.size());
  }
  return size;
}

// The folder robots/: app/robots/robot_files.h.
void add_robots(const Scenario& s, const PileModelSize& pile, Estimate& sizes) {
  constexpr double kTrackRate = 60, kNumberBytes = 25, kOdometryNumbers = 11, kPoseNumbers = 7;
  if (s.robots.empty()) return;
  const double moved = s.robot_run.debris == DebrisMotion::fixed ? 0 : pile.pieces;
  const double samples = s.robot_run.duration * kTrackRate + 2, controls = s.robot_run.duration * s.robot_run.control_hz + 2;
  double bytes = moved * (kMovingTime * kTrackRate + 1) * kKeyBytes + 5000;
  for (const RobotItem& robot : s.robots) {
    const RobotSize size = size_of_robot(robot);
    bytes += size.description + samples * (size.links * kKeyBytes + (1 + kPoseNumbers) * kNumberBytes) +
             controls * (2 + 3 * size.driven + kOdometryNumbers) * kNumberBytes;
  }
  sizes["robots"] = std::uint64_t(bytes);
}

double count_frames(const std::vector<RecordedSize>& cameras) {
  double frames = 0;
  for (const RecordedSize& size : cameras) frames += size.flight.frames;
  return frames;
}

void add_recordings(const Scenario& s, const std::vector<RecordedSize>& cameras, Estimate& sizes) {
  for (const RecordingFormat& format : recording_formats()) {
    if (!is_wanted(format, s)) continue;
    if (!format.beside.empty()) sizes[format.beside] = 30000;
    const bool apart = format.one_camera && s.names_cameras();
    std::uint64_t& sum = sizes[apart ? kCamerasFolder : format.leaves];
    for (const RecordedSize& size : cameras) sum += std::uint64_t(format.estimate(size));
  }
  if (has_channel(s, "label")) sizes["labels.csv"] = 10000;
  if (s.trajectory.needs_pile())
    sizes["flight.json"] = std::uint64_t(400 * count_frames(cameras) + 1e5);
}

// What `rubble settle` leaves, too.
bool is_of_pile(const std::string& name) {
  for (const char* own : {"pile.bin", "victims.json", "fines.bin", "manifest.json", "track.bin", "track.glb"})
    if (name == own) return true;
  for (const MeshFormat& format : mesh_formats())
    if (std::count(format.leaves.begin(), format.leaves.end(), name)) return true;
  return false;
}

}  // namespace

Estimate estimate_outputs(const Scenario& s, const AssetLibrary& assets) {
  Estimate sizes;
  const PileModelSize pile = size_of_pile(s, assets);
  const std::vector<RecordedSize> recorded = sizes_of_recording(s, pile.pieces);
  sizes["pile.bin"] =
      std::uint64_t(pile.pieces * kPieceBytes + count_building_pieces(s.pile, assets) * kBondedPieceBytes + 2000);
  if (s.victims.count > 0) sizes["victims.json"] = std::uint64_t(s.victims.count) * 400;
  if (s.fines.amount > 0) sizes["fines.bin"] = std::uint64_t(size_of_fines(s.fines).bytes);
  sizes["manifest.json"] = std::uint64_t(count_frames(recorded) * 250 + kManifestBytes);
  add_meshes(s, pile, sizes);
  add_track(s, pile, sizes);
  add_robots(s, pile, sizes);
  add_recordings(s, recorded, sizes);
  return sizes;
}

Estimate estimate_files(const Scenario& s, const AssetLibrary& assets, bool pile_only) {
  Estimate sizes = estimate_outputs(s, assets);
  for (auto it = sizes.begin(); it != sizes.end();)
    it = pile_only && !is_of_pile(it->first) ? sizes.erase(it) : std::next(it);
  return sizes;
}

std::uint64_t estimate_bytes(const Scenario& s, const AssetLibrary& assets, bool pile_only) {
  std::uint64_t sum = 0;
  for (const auto& item : estimate_files(s, assets, pile_only)) sum += item.second;
  return sum;
}

double count_building_pieces(const PileScenario& pile, const AssetLibrary& assets) {
  PileCount size(assets);
  if (pile.building.given()) add_building(pile, assets, size);
  return size.pieces;
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
  return failed || space.capacity == 0 ? UINT64_MAX : space.available;  // 0: of a folder such as /proc
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
