// The settled pile as flights and measures see it: its exact geometry and its free space, each made when
// it is first asked for, and once.
#pragma once

#include <list>
#include <memory>
#include <vector>

#include "app/assets/asset_library.h"
#include "kernel/queries/queries.h"
#include "kernel/voids/void_map.h"

namespace rubble {

// The true meshes of a settled pile, to be asked exactly.
struct PileGeometry {
  PileGeometry(const AssetLibrary& assets, const PileState& state);

  const PileState& pile;  // settled; must outlive this
  std::vector<const TriangleMesh*> meshes;  // by type
  std::vector<int> terrain;                 // types that are
  PileQueries queries;  // of rays, clearances and nearest surfaces
};

class PileSurvey {
 public:
  // Assets and pile must outlive it. threads: at least 1; no result depends on it.
  PileSurvey(const AssetLibrary& assets, const PileState& pile, int threads);

  const AssetLibrary& assets() const { return assets_; }
  const PileState& pile() const { return pile_; }
  const PileGeometry& geometry();
  // Free space in voxels, and the voids of robots of these radii (unit: m; each at least a voxel; none:
  // the space alone). Of `options`, threads and scenery are the survey's own. The same space serves every
  // question with the same voxel and rolling radius. progress: as find_voids(), of what is made.
  const VoidMap& find_voids(const VoidSpaceOptions& options, const std::vector<double>& radii,
                            const VoidProgress& progress = {});
  // Spaces that were made, for tests.
  int spaces_made() const { return spaces_made_; }
  // Gives back the memory of all free space. What find_voids() gave before is gone.
  void forget_voids() { surveyed_.clear(); }

 private:
  struct Surveyed {
    double voxel = 0, rolling_radius = 0;  // unit: m
    bool connected = false;                // ways and voids are known, too
    VoidMap map;
  };
  Surveyed& find_space(VoidSpaceOptions options, const VoidProgress& progress);

  const AssetLibrary& assets_;
  const PileState& pile_;
  int threads_;
  std::unique_ptr<PileGeometry> geometry_;
  std::list<Surveyed> surveyed_;  // addresses stay
  int spaces_made_ = 0;
};

}  // namespace rubble
