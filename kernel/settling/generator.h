// Makes the pieces to drop from a specification.
#pragma once

#include "kernel/model/pile.h"

namespace rubble {

// Draws every layer. Pieces of a layer do not overlap: an overlapping placement is drawn again. Throws InputError
// when a layer does not fit; the error states how many pieces fit.
Pile generate_pile(const PileSpec& spec);

}  // namespace rubble
