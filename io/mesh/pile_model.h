// A pile as geometry for other programs: meshes by type, and the pieces that are made of them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kernel/base/math.h"
#include "kernel/base/mesh.h"

namespace rubble {

// How a surface (TriangleMesh::surface_names) looks to programs that know one colour of it.
struct PlainAppearance {
  std::string surface;  // its name in the mesh
  Vec3f colour;         // linear-light albedo, 0 to 1
};

struct PileModel {
  struct Type {
    std::string name;                    // of the asset
    const TriangleMesh* mesh = nullptr;  // in the frame of the body, at scale 1
  };
  struct Piece {
    std::uint32_t type = 0;    // index into `types`
    std::string name;          // unlike all others, e.g. "slab_000012"
    double scale = 1;          // of the type's mesh; above 0
    Pose world_from_body;      // unit: m
    std::int32_t number = -1;  // its index in the pile; -1: not known
  };
  std::vector<std::shared_ptr<const TriangleMesh>> kept;  // meshes of types that are nobody else's
  std::vector<Type> types;                          // each with its mesh once
  std::vector<Piece> pieces;                        // in the order of the pile
  std::vector<PlainAppearance> surface_appearance;  // a surface without one is grey
  double gravity = 9.81;  // in which the pile settled, downwards; unit: m/s2

  Vec3f colour_of(const std::string& surface) const;
};

// "slab_000012": the name of an asset and the number of the piece.
std::string piece_name(const std::string& asset, std::size_t number);

// A mesh whose vertices are its distinct positions: what a solid needs to be closed.
struct WeldedMesh {
  std::vector<Vec3f> positions;                         // in order of first use
  std::vector<std::array<std::uint32_t, 3>> triangles;  // as the mesh's, less those without area
  std::vector<std::uint8_t> surfaces;                   // one per triangle
  std::vector<std::array<std::uint32_t, 3>> normals;    // indices into the mesh's normals; or empty
  std::vector<std::uint32_t> sources;                   // one per triangle: its index in the mesh
};
WeldedMesh weld(const TriangleMesh& mesh);

// Where a vertex of a piece is in the world.
Vec3f world_position(const PileModel::Piece& piece, const Vec3f& position);

}  // namespace rubble
