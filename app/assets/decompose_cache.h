// Convex parts of a mesh, kept on disk between runs: cutting a mesh up takes seconds.
#pragma once

#include <vector>

#include "kernel/base/system/disk_cache.h"
#include "kernel/geometry/decompose.h"

namespace rubble {

// As decompose(). The entry goes by the mesh's content and the options; a damaged one is made anew.
Decomposition decompose_cached(const TriangleMesh& mesh, const DiskCache& cache,
                               const DecomposeOptions& options = {});

}  // namespace rubble
