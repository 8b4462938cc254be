// Strews fines over a settled pile: grit, flakes, shards and sheets that rest on what they fell on, drifts of dust
// at the foot of walls, cables and pipes that hang between pieces.
//
// The result follows from pile, meshes, spec and seed alone, and is the same on every machine and for any number
// of threads. docs/explanation/fines.md describes what is drawn and which limits tests hold it to.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "kernel/base/mesh.h"
#include "kernel/model/fines.h"
#include "kernel/model/pile_state.h"

namespace rubble {

// done: an estimate, 0 to 1. strewn: loose pieces so far.
using FinesProgress = std::function<void(double done, int strewn)>;

struct StrewOptions {
  std::uint64_t seed = 0;      // of all that is drawn at random
  int threads = 1;             // at least 1
  std::vector<int> scenery{};  // types that are terrain: fines lie on it near the pile alone
  FinesProgress progress{};    // in the caller's thread, now and then
};

// meshes: by type index, as for PileQueries. The pile's own fines are not looked at. Where there is no room for
// as many as the spec asks for, there are fewer.
Fines strew_fines(const PileState& pile, const std::vector<const TriangleMesh*>& meshes, const FinesSpec& spec,
                  const StrewOptions& options);

}  // namespace rubble
