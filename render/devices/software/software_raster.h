// Finds which triangle each pixel shows, and its exact depth.
//
// Two steps, shared by threads: clusters to triangles on the image, sorted into bands of rows; then
// each band is filled by one thread, in the order in which the triangles came. So the image does not
// depend on the number of threads.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kernel/base/parallel.h"
#include "render/camera/projection.h"
#include "render/devices/software/triangle_setup.h"
#include "render/geometry/scene_tables.h"
#include "render/passes/triangle_raster.h"

namespace rubble {

class SoftwareRaster : public TriangleRaster {
 public:
  // shapes: one a mesh. What they refer to must outlive it.
  SoftwareRaster(const PreparedScene& scene, const std::vector<ClusterShapes>& shapes, const TriangleNames& names,
                 ThreadPool& pool);
  ~SoftwareRaster() override;

  void begin(const ViewProjection& view) override;
  void draw(const std::vector<ClusterRun>& runs) override;
  const std::vector<float>& depth_so_far() override { return depth_; }
  void finish() override {}
  const std::vector<float>& depth_values() const override { return depth_; }
  const std::uint32_t* ids() const override { return reinterpret_cast<const std::uint32_t*>(ids_.data()); }
  std::vector<std::uint32_t> read_ids() const override { return {ids(), ids() + 2 * ids_.size()}; }

 private:
  struct Job;
  void set_up(std::size_t job);
  void fill(std::size_t band);

  const PreparedScene& scene_;
  const std::vector<ClusterShapes>& shapes_;
  const TriangleNames& names_;
  ThreadPool& pool_;
  const ViewProjection* view_ = nullptr;
  const std::vector<ClusterRun>* runs_ = nullptr;
  std::vector<std::unique_ptr<Job>> jobs_;
  std::size_t job_count_ = 0;
  std::vector<float> depth_;
  std::vector<std::uint64_t> ids_;  // TriangleRecord::id, on machines whose first byte is the lowest
};

}  // namespace rubble
