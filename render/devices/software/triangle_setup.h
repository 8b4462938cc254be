// From clusters of a mesh to triangles on the image. Internal to render/devices/software.
#pragma once

#include <cstdint>
#include <vector>

#include "render/camera/projection.h"
#include "render/geometry/prepared_mesh.h"
#include "render/devices/software/triangle_record.h"

namespace rubble {

// The clusters of a mesh, each with a list of its own vertices, so that one is moved once a cluster.
struct ClusterShapes {
  struct Range {
    std::uint32_t first_vertex, vertex_count, first_triangle, triangle_count;  // in the lists below
  };
  std::vector<Range> clusters;          // as PreparedMesh::clusters
  std::vector<float> x, y, z;           // mesh frame; unit: m
  std::vector<std::uint8_t> corners;    // three a triangle, counted within the cluster's vertices
};
ClusterShapes make_cluster_shapes(const PreparedMesh& mesh);

// How a placed mesh is seen.
struct MeshView {
  MeshView(const ViewProjection& view, const Pose& world_from_mesh, double scale);

  float rows[3][4];               // optical_from_mesh; unit: m
  double fx, fy, cx, cy;          // unit: pixel
  double inverse_fx, inverse_fy;  // 1 / fx and 1 / fy
  int width, height;              // of the image; unit: pixel
  int guard;                      // pixels from the middle beyond which a triangle is clipped
};

// Appends those triangles of a cluster that face the camera and may cover a pixel's centre.
// names: of the cluster's triangles; placed: number of the placed mesh.
void set_up_cluster(const ClusterShapes& shapes, std::uint32_t cluster, const MeshView& view,
                    std::uint32_t placed, const std::uint32_t* names,
                    std::vector<TriangleRecord>& out);

}  // namespace rubble
