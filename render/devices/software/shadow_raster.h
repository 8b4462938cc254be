// Draws the depth of pieces as a light sees them. The smallest depth is kept, so that neither the order of triangles nor
// the number of threads counts. Internal to render/devices/software.
#pragma once

#include <vector>

#include "kernel/base/parallel.h"
#include "render/devices/software/triangle_setup.h"
#include "render/passes/shadow_views.h"

namespace rubble {

class ShadowRaster {
 public:
  // shapes: one a mesh. What they refer to must outlive it.
  ShadowRaster(const PreparedScene& scene, const std::vector<ClusterShapes>& shapes, ThreadPool& pool)
      : scene_(scene), shapes_(shapes), pool_(pool) {}

  // depth: side x side texels, as ShadowViews has them.
  void draw(const ShadowViews::Rows& rows, ShadowPart part, int side, float* depth);

 private:
  struct Clusters {
    std::uint32_t placed, first, last;  // clusters [first, last) of its mesh
  };
  struct Job {
    std::vector<TriangleRecord> triangles;
    std::vector<std::vector<std::uint32_t>> bands;  // which triangles touch a band
  };
  void find_clusters(const ShadowViews::Rows& rows, ShadowPart part);
  void set_up(const Clusters& clusters, const ShadowViews::Rows& rows, int side, Job& job) const;

  const PreparedScene& scene_;
  const std::vector<ClusterShapes>& shapes_;
  ThreadPool& pool_;
  std::vector<Clusters> clusters_;
  std::vector<Job> jobs_;
};

}  // namespace rubble
