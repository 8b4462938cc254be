#include "app/measures/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kernel/geometry/shape.h"

namespace rubble {
namespace {

double highest_point(const PieceType& type, const PieceState& piece) {
  double top = -1e300;
  for (const ConvexPart& part : type.parts)
    for (const Vec3& point : part.points)
      top = std::max(top, (piece.world_from_body * (point * piece.scale)).z);
  return top;
}

// That of the shape the kernel moves: of the mesh where the type states it, else of the parts.
double volume_of(const PieceType& type) { return compile_shape(type, type.name).volume.volume; }

// The radius that 95 % of the distances do not exceed.
double most_of(std::vector<double> squared_distances) {
  if (squared_distances.empty()) return 0;
  std::sort(squared_distances.begin(), squared_distances.end());
  return std::sqrt(squared_distances[(squared_distances.size() - 1) * 95 / 100]);
}

}  // namespace

const std::vector<std::pair<std::string, std::string>>& metric_names() {
  static const std::vector<std::pair<std::string, std::string>> names{
      {"pieces", "Number of pieces that were dropped or placed."},
      {"pieces_lost", "Number of pieces that left the world."},
      {"pieces_moving", "Number of pieces that still moved at the end."},
      {"settled", "1: the pile came to rest; 0: the time limit came first."},
      {"simulated_s", "Simulation time until the pile had settled."},
      {"pile_height_m", "Highest point of all pieces except lost ones."},
      {"pile_radius_m", "Radius about the Z axis within which 95 % of the movable pieces have their origins."},
      {"piece_volume_m3", "Volume of all pieces together."},
      {"fines", "With `fines`: number of loose pieces, drifts, cables and pipes."},
      {"void_volume_m3", "With `voids.on`: free space that a ball of 2 m cannot reach from above."},
      {"void_covered_m3", "With `voids.on`: free space with something solid vertically above it."},
      {"void_robot_m3", "With `voids.on`: volume that a robot of `voids.radius` covers in all voids."},
      {"void_reachable_m3", "With `voids.on`: the part of void_robot_m3 in voids that it can enter from outside."},
      {"void_count", "With `voids.on`: number of voids that such a robot fits in."},
      {"void_depth_m", "With `voids.on`: depth of the deepest of these voids below the surface of the pile."},
      {"void_way_in_m", "With `voids.on`: length of the longest path from an entrance."},
      {"robot_distance_m", "With robots: straight distance from start to end, summed over all robots."},
      {"robot_path_m", "With robots: length of their paths, summed."},
      {"robot_work_j", "With robots: work of their motors, given and taken both counted as positive."},
      {"robot_stuck_s", "With robots: time in which a robot moved less than 2 cm/s, summed."},
      {"robot_lowest_m", "With robots: the lowest height of a base."},
      {"robot_slip", "With robots: mean slip of the robot that slips most; 0: rolling, 1: spinning on the spot."},
      {"robots_lost", "With robots: number of robots that left the world."},
      {"robot_pieces_moved", "With robots: number of pieces that moved more than 1 cm."},
      {"frames", "Number of frames of the flight, of all cameras."},
      {"path_m", "Length of the flight: path of the rig; where no camera is on it, of what carries cameras, summed."},
      {"depth_min_m", "Smallest depth of all pixels of all frames."},
      {"depth_mean_m", "Mean depth of all pixels that have a depth."},
      {"depth_max_m", "Largest depth."},
      {"depth_none_share", "Share of pixels without a return, 0 to 1."}};
  return names;
}

void add_pile_metrics(const PileState& pile, const AssetLibrary& assets, Metrics& metrics) {
  double height = 0, volume = 0, moving = 0;
  std::vector<double> squared, volumes;
  for (const PieceType& type : assets.types) volumes.push_back(volume_of(type));
  for (const PieceState& piece : pile.pieces) {
    if (piece.status == PieceStatus::lost) continue;
    const PieceType& type = assets.types.at(std::size_t(piece.type));
    height = std::max(height, highest_point(type, piece));
    volume += volumes[std::size_t(piece.type)] * piece.scale * piece.scale * piece.scale;
    moving += piece.status == PieceStatus::moving;
    const Vec3& at = piece.world_from_body.translation;
    if (piece.status != PieceStatus::fixed) squared.push_back(at.x * at.x + at.y * at.y);
  }
  metrics["pieces"] = double(pile.pieces.size());
  metrics["pieces_lost"] = pile.lost;
  metrics["pieces_moving"] = moving;
  metrics["settled"] = pile.settled;
  metrics["simulated_s"] = pile.simulated;
  metrics["pile_height_m"] = height;
  metrics["pile_radius_m"] = most_of(std::move(squared));
  metrics["piece_volume_m3"] = volume;
  if (!pile.fines.empty()) metrics["fines"] = double(pile.fines.pieces.size() + pile.fines.sheets.size());
}

void DepthMetrics::add(const Frame& frame) {
  double sum = 0;
  float nearest = std::numeric_limits<float>::infinity(), farthest = 0;
  std::int64_t returns = 0;
  for (const float depth : frame.depth) {
    if (!(depth > 0)) continue;
    nearest = std::min(nearest, depth), farthest = std::max(farthest, depth);
    sum += double(depth), ++returns;
  }
  if (returns > 0) min_ = returns_ == 0 ? double(nearest) : std::min(min_, double(nearest));
  max_ = std::max(max_, double(farthest));
  returns_ += returns;
  sum_ += sum;
  pixels_ += std::int64_t(frame.depth.size());
  const Vec3& position = frame.world_from_rig.translation;
  const auto [path, is_first] = paths_.insert({carriers_.at(std::size_t(frame.sensor)), {0, position}});
  const Vec3 leg = position - path->second.last;
  if (!is_first) path->second.length += std::sqrt(dot(leg, leg));
  path->second.last = position;
  ++frames_;
}

// Of the rig; where no camera is on it, of all that carry one.
double DepthMetrics::flown() const {
  const auto rig = paths_.find("");
  if (rig != paths_.end()) return rig->second.length;
  double sum = 0;
  for (const auto& [carrier, path] : paths_) sum += path.length;
  return sum;
}

void DepthMetrics::add_to(Metrics& metrics) const {
  metrics["frames"] = double(frames_);
  metrics["path_m"] = flown();
  if (pixels_ == 0) return;
  metrics["depth_min_m"] = min_;
  metrics["depth_max_m"] = max_;
  metrics["depth_mean_m"] = returns_ == 0 ? 0 : sum_ / double(returns_);
  metrics["depth_none_share"] = double(pixels_ - returns_) / double(pixels_);
}

VoidSpaceOptions make_void_options(const VoidScenario& voids) {
  VoidSpaceOptions options;
  options.voxel = voids.voxel;
  options.rolling_radius = outside_radius_for(options.rolling_radius, voids.radius);
  return options;
}

void add_void_metrics(const VoidMap& map, double radius, Metrics& metrics) {
  const RobotVoids& robot =
      *std::find_if(map.robots.begin(), map.robots.end(),
                    [&](const RobotVoids& found) { return found.radius == radius; });
  double deepest = 0, way_in = 0;
  for (const Void& v : robot.voids) {
    deepest = std::max(deepest, v.depth);
    way_in = std::max(way_in, v.path_length);
  }
  metrics["void_volume_m3"] = map.void_volume;
  metrics["void_covered_m3"] = map.covered_volume;
  metrics["void_robot_m3"] = robot.volume;
  metrics["void_reachable_m3"] = robot.reachable_volume;
  metrics["void_count"] = double(robot.voids.size());
  metrics["void_depth_m"] = deepest;
  metrics["void_way_in_m"] = way_in;
}

}  // namespace rubble
