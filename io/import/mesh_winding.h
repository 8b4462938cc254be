// Triangles of a mesh that face against their neighbours, or all of them inwards.
#pragma once

#include <string>

#include "kernel/base/mesh.h"

namespace rubble {

// Turns triangles of a mesh, each edge of which two triangles share, until neighbours agree on which side is outside:
// of each connected surface the fewer are turned, then a whole surface that faces inwards, unless it lies within another
// (a cavity). Normals that point inwards then are turned as well. Returns what was done, as a note for the user; "": nothing, as for a mesh with open edges, with edges of
// more than two triangles, or that has no two sides (Moebius' band).
std::string agree_on_outside(TriangleMesh& mesh);

}  // namespace rubble
