// A reconstructed map against the true surface that its run has seen.
#pragma once

#include <vector>

#include "app/eval/map/seen_surface.h"
#include "io/mesh_formats/ply_reader.h"
#include "kernel/base/parallel.h"
#include "kernel/queries/queries.h"

namespace rubble {

inline constexpr double kNearSurface = 0.05;  // what counts as met; unit: m

// Of the points of a map, or of samples of a mesh.
struct MapAccuracy {
  // Distances to the true surface, seen or not, one each, at most kFarthest (surface_score.h); m
  std::vector<double> distances;
  double within_1cm = 0, within_2cm = 0, within_5cm = 0;  // shares; range: 0 to 1
  double median = 0;                                      // unit: m
  double percentile_90 = 0;  // the distance that 90 % are within (Seitz et al. 2006); unit: m
  // Share whose nearest true surface has nothing within 5 cm that a frame saw.
  double unseen = 0;
};
// points: not empty.
MapAccuracy calc_map_accuracy(const std::vector<Vec3>& points, const PileQueries& truth,
                              const SeenPoints& seen, ThreadPool& pool);

// Of the surface that the frames saw, by area.
struct MapCompleteness {
  // From each point of the seen surface to the map, at most 5 cm; unit: m
  std::vector<double> distances;
  double within_1cm = 0, within_2cm = 0, within_5cm = 0;  // shares; range: 0 to 1
};
// To the triangles of a mesh, or to the nearest point of a cloud.
MapCompleteness calc_map_completeness(const PlyMesh& map, const SeenPoints& seen,
                                      ThreadPool& pool);

}  // namespace rubble
