// Draws which triangle each pixel shows, and its depth, and nothing else. Pieces that cannot be
// seen are left out: those that showed last time are drawn first, and the depth they leave decides
// about the others, exactly.
#pragma once

#include <cstdint>
#include <vector>

#include "render/camera/culling.h"
#include "render/camera/projection.h"
#include "render/geometry/geometry.h"
#include "render/passes/triangle_raster.h"

namespace rubble {

struct VisibilityOptions {
  bool occlusion_culling = true;  // false: draws all clusters in the view
  // Use coarser levels where a level-0 triangle would be about this small on the image; 0: always
  // the finest. unit: pixel
  double coarse_below = 0;
};

class VisibilityPass {
 public:
  // What they refer to must outlive it.
  VisibilityPass(const PreparedScene& scene, TriangleRaster& raster, const VisibilityOptions& options, ThreadPool& pool);

  // Leaves the view in the raster.
  void draw(const ViewProjection& view);

  struct Counts {
    std::size_t triangles = 0, first_batch = 0;  // drawn; of these before any depth was known
  };
  Counts counts() const;

 private:
  struct Candidate : DrawCandidate {
    float distance;
  };
  void find_candidates(const ViewProjection& view);
  std::uint32_t choose_level(const PlacedMesh& piece, float z, double focal) const;
  struct Chosen {
    std::vector<ClusterRun> runs;
    std::size_t triangles = 0;
  };
  // Adds the candidate's clusters that pass; `second`: those hidden last time but not by depth.
  // Candidates may be added by several threads at once, each to a list of its own.
  void add_piece(const Candidate& candidate, const ViewProjection& view, const ViewVolume& volume,
                 bool second, Chosen& chosen);
  void choose(const ViewProjection& view, bool second);  // fills runs_ and run_triangles_

  const PreparedScene& scene_;
  VisibilityOptions options_;
  TriangleRaster& raster_;
  std::vector<Candidate> candidates_;
  ThreadPool& pool_;
  std::vector<Chosen> chosen_;  // one a job
  std::vector<ClusterRun> runs_;
  std::size_t run_triangles_ = 0;    // of runs_
  std::vector<std::uint8_t> shown_;  // one a cluster flag: drawn in the next first batch
  std::vector<std::uint8_t> drawn_;  // in this frame
  bool have_history_ = false;
  DepthPyramid pyramid_;
  Counts counts_;
  bool chosen_by_raster_ = false;  // what is drawn now
};

}  // namespace rubble
