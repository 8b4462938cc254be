// Looks as pictures, for programs that know no procedural textures.
#pragma once

#include "io/mesh/pile_model.h"

namespace rubble {

// Gives every surface that has a look and no paint a picture of that look: meshes of the model become copies with
// places in pictures, projected along the axis that a face looks along most. Fines, which are millimetres across, keep
// their plain colour. threads: of the work; the pictures do not depend on it.
void add_look_pictures(PileModel& model, int threads);

}  // namespace rubble
