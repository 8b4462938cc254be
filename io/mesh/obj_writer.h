// The parts of an OBJ file that both the whole pile and single meshes are made of.
#pragma once

#include <string>

#include "io/mesh/pile_model.h"

namespace rubble {

// Appends one object. `vertices` and `normals`: how many are in the file before it; both are
// increased.
void put_obj_object(std::string& text, const PileModel::Piece& piece, const TriangleMesh& mesh,
                    const WeldedMesh& welded, std::size_t& vertices, std::size_t& normals);

// The material library of every surface that the model's meshes name.
std::string make_mtl(const PileModel& model);

}  // namespace rubble
