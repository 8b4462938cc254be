// From a specification to the pieces that will be dropped.
#pragma once

#include "kernel/model/pile.h"

namespace rubble {

// Draws every layer. Within a layer no two pieces overlap (a placement that would is redrawn).
// Throws InputError when a layer does not fit, saying how many pieces did.
Pile generate_pile(const PileSpec& spec);

}  // namespace rubble
