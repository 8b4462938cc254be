// The parts of an OBJ file that both the whole pile and single meshes are made of.
#pragma once

#include <string>

#include "io/mesh/pile_model.h"

namespace rubble {

// What is in the file before an object.
struct ObjCounts {
  std::size_t positions = 0, normals = 0, places = 0;
};

// solid: positions and faces. Readers split a corner whose faces have several normals or places in pictures, and then find
// no closed mesh. looks: with normals where they are not those of the faces, and with places of surfaces with a picture.
enum class ObjContent { solid, looks };

// Appends one object and adds it to the counts. Positions that are equal are one.
void put_obj_object(std::string& text, const PileModel::Piece& piece, const TriangleMesh& mesh,
                    const WeldedMesh& welded, ObjContent content, ObjCounts& counts);

// A material. picture: name of its file; empty: none. colour: linear light.
std::string mtl_text(const std::string& name, const Vec3f& colour, const std::string& picture = "");

}  // namespace rubble
