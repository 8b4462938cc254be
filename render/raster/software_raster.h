// Finds which triangle each pixel shows, and its exact depth, on the processor: where there is no
// graphics hardware this is several times as fast as a software driver's general way.
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
#include "render/geometry/geometry.h"
#include "render/raster/triangle_setup.h"

namespace rubble {

// Neighbouring clusters of a placed mesh.
struct ClusterRun {
  std::uint32_t placed, first_cluster, cluster_count;  // number of the mesh, and its clusters
};

class SoftwareRaster {
 public:
  // names: of every triangle of mesh m from first_name[m] on. The scene must outlive it.
  SoftwareRaster(const PreparedScene& scene, std::vector<std::uint32_t> names,
                 std::vector<std::uint32_t> first_name, int threads);

  ~SoftwareRaster();

  void begin(const ViewProjection& view);  // clears; the view must outlive the drawing
  void draw(const std::vector<ClusterRun>& runs);

  // Rows from the top. near / Z, 0: nothing; and TriangleRecord::id.
  const std::vector<float>& depth() const { return depth_; }
  const std::vector<std::uint64_t>& ids() const { return ids_; }

 private:
  struct Job;
  void set_up(std::size_t job);
  void fill(std::size_t band);

  const PreparedScene& scene_;
  std::vector<std::uint32_t> names_, first_name_;
  std::vector<ClusterShapes> shapes_;  // one a mesh
  ThreadPool pool_;
  const ViewProjection* view_ = nullptr;
  const std::vector<ClusterRun>* runs_ = nullptr;
  std::vector<std::unique_ptr<Job>> jobs_;
  std::size_t job_count_ = 0;
  std::vector<float> depth_;
  std::vector<std::uint64_t> ids_;
};

}  // namespace rubble
