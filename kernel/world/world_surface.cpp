// A surface that stands about all pieces.
#include <utility>

#include "kernel/world/world_impl.h"

namespace rubble {

int World::add_surface(std::shared_ptr<const TriangleMesh> mesh, double friction) {
  Impl& w = *impl_;
  PieceType type;
  type.name = "surface";
  type.surface = std::move(mesh);
  type.friction = friction;
  w.shapes.push_back(compile_shape(type, "surface"));
  w.types.push_back(type);
  NewPiece piece;
  piece.placement.type = int(w.types.size()) - 1;
  piece.placement.fixed = true;
  const int number = size();
  FreeBody none;
  w.add_body(piece, &none);
  w.introduce(number);
  return number;
}

}  // namespace rubble
