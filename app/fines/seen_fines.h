// Fines as what is drawn, labelled and exported.
#pragma once

#include "app/formats/class_labels.h"
#include "io/mesh/pile_model.h"
#include "io/recording/recording.h"
#include "kernel/model/pile_state.h"
#include "render/scene/scene.h"

namespace rubble {

// Puts the heaps at the end of the instances, each with the number kFirstFineHeap and its index.
void add_fines(const ClassLabels& labels, const PileState& pile, Scene& scene);
// Likewise at the end of types and pieces; the model keeps their meshes.
void add_fines(const PileState& pile, PileModel& model);
void add_fines(const ClassLabels& labels, const PileState& pile, Legend& legend);

}  // namespace rubble
