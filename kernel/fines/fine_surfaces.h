// Looks of fines near a piece, by the look of the piece.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "kernel/base/mesh.h"
#include "kernel/base/random.h"
#include "kernel/model/fines.h"
#include "kernel/model/pile_state.h"

namespace rubble {

// The looks that fines may have, by FinePiece::surface.
enum class FineSurface : std::uint8_t {
  concrete, brick, brick_face, block, plaster, gypsum, timber, rust, glass, paper, fabric, dust, rubber, galvanised
};
const std::vector<std::string>& fine_surfaces();

// The grit that each piece of a pile gives.
class FragmentTable {
 public:
  FragmentTable(const PileState& pile, const std::vector<const TriangleMesh*>& meshes);

  // Of a piece; now and then of another one of the pile. piece: -1: of any.
  FineSurface draw(int piece, RandomStream& random) const;

 private:
  const PileState& pile_;
  std::vector<std::vector<FineSurface>> of_type_;  // none: nothing breaks off it
  std::vector<int> giving_;                        // pieces that give some
};

}  // namespace rubble
