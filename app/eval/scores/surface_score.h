// How near points are to the true surface of a pile, and how much of what was seen they cover.
#pragma once

#include <optional>
#include <vector>

#include "io/datasets/colmap_model.h"
#include "io/mesh_formats/ply_reader.h"
#include "kernel/queries/queries.h"

namespace rubble {

struct SurfaceScore {
  std::int64_t samples = 0;  // points, or samples of a mesh's surface
  // Shares of the samples within 1, 2 and 5 cm of the true surface; range: 0 to 1
  double within_1cm = 0, within_2cm = 0, within_5cm = 0;
  double median = 0;  // distance, at most kFarthest; unit: m
  // Share of the visible surface that has a sample within 5 cm of it; range: 0 to 1
  double completeness_5cm = 0;
};

// Farther is as good as anywhere; unit: m
inline constexpr double kFarthest = 1;

// Points of the true surface that the cameras see, at most one in each cell of 5 cm: rays through a
// grid of 64 pixels a row, no farther than 12 m. Lens distortion is left out of account, of a
// fisheye all but its equidistant projection.
std::vector<Vec3> find_visible_surface(const PileQueries& queries, const ColmapModel& truth);

// Points spread evenly over the triangles, about one every `spacing` (unit: m), the same each time;
// of a point cloud its points, of a mesh too small for one sample its corners.
std::vector<Vec3> sample_surface(const PlyMesh& mesh, double spacing);
// InputError where that would be more than a hundred million points, as of a map in millimetres.
void check_area(const PlyMesh& mesh, double spacing, const std::string& path);

// Nothing for no points.
std::optional<SurfaceScore> calc_surface_score(const std::vector<Vec3>& points,
                                               const PileQueries& queries,
                                               const std::vector<Vec3>& visible);

}  // namespace rubble
