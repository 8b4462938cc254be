#include "assets/generator/asset.h"
#include "assets/generator/pieces.h"

namespace rubble::generator {

Pack concrete_pack() {
  Pack pack{"concrete", {}};
  for (const auto& make :
       {masonry_pieces, chunk_pieces, slab_pieces, frame_pieces, hollow_pieces, rebar_pieces}) {
    for (Recipe& recipe : make()) pack.recipes.push_back(std::move(recipe));
  }
  pack.articulated = articulated_concrete();
  return pack;
}

}  // namespace rubble::generator
