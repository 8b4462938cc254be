// Convex parts of a mesh: kept on disk between runs, and how well they match the mesh.
#pragma once

#include <vector>

#include "kernel/base/mesh.h"
#include "kernel/base/system/disk_cache.h"
#include "kernel/geometry/decompose.h"
#include "kernel/geometry/shape.h"
#include "kernel/model/pile.h"

namespace rubble {

// As decompose(). The entry goes by the mesh's content and the options; a damaged one is made anew.
Decomposition decompose_cached(const TriangleMesh& mesh, const DiskCache& cache,
                               const DecomposeOptions& options = {});

struct HullError {
  double mesh = 0;     // volume inside the mesh; unit: m3
  double outside = 0;  // of the parts, outside the mesh: pieces keep apart that would touch; unit: m3
  double inside = 0;   // of the mesh, outside all parts: pieces can sink into each other; unit: m3
};

// Integrated over lines^2 vertical lines through the box around both, exactly along each line:
// crossings of the mesh are counted with their sign, so closed bodies may overlap. The mesh must be
// closed. shape: the piece compiled; its parts are about its centre of mass.
HullError calc_hull_error(const TriangleMesh& mesh, const Shape& shape, int lines = 160);

// The least distance between two parallel planes that hold the part between them, over the planes
// of its faces. unit: m
double calc_thickness(const ConvexShape& part);

}  // namespace rubble
