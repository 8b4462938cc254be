// The parts of an OBJ file that both the whole pile and single meshes are made of.
#pragma once

#include <string>

#include "io/mesh/pile_model.h"

namespace rubble {

// What is in the file before an object.
struct ObjCounts {
  std::size_t positions = 0, normals = 0, places = 0;
};

// Appends one object and adds it to the counts. Positions that are equal are one, and normals that are those of the faces
// are left out, so that readers find a closed mesh. places: with places in pictures, of surfaces that have a picture.
void put_obj_object(std::string& text, const PileModel::Piece& piece, const TriangleMesh& mesh,
                    const WeldedMesh& welded, ObjCounts& counts, bool places = false);

// A material. picture: name of its file; empty: none. colour: linear light.
std::string mtl_text(const std::string& name, const Vec3f& colour, const std::string& picture = "");

}  // namespace rubble
