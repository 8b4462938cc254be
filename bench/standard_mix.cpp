#include "bench/standard_mix.h"

#include <cmath>
#include <string>

#include "kernel/base/error.h"

namespace rubble {
namespace {

constexpr int kLayers = 4;

// As bench/workloads/generate.py draws them.
MixEntry draw_of(const std::string& name, int type) {
  if (name.rfind("chunk", 0) == 0) return {type, 0.55 / 8, 0.12, 0.45};
  if (name == "slab") return {type, 0.15, 0.7, 1.3};
  if (name == "block") return {type, 0.15, 1.0, 1.0};
  if (name == "brick") return {type, 0.10, 1.0, 1.0};
  if (name == "rebar") return {type, 0.05, 0.7, 1.3};
  Diagnostic d;
  d.key = "shape " + name;
  d.message = "is none of the standard work";
  d.hint = "use w0.txt, w1.txt or w2.txt";
  throw InputError(d);
}

}  // namespace

PileSpec make_standard_mix(const Pile& work, int pieces, std::uint64_t seed) {
  PileSpec spec;
  spec.seed = seed;
  spec.types = work.types;
  for (std::size_t i = 0; i < work.types.size(); ++i) {
    spec.mix.push_back(draw_of(work.types[i].name, int(i)));
  }
  spec.layers = kLayers;
  spec.pieces_per_layer = (pieces + kLayers - 1) / kLayers;
  const double edge =
      kStandardFootprint * std::sqrt(double(spec.pieces_per_layer) / kStandardPiecesPerLayer);
  spec.spawn_bounds = {edge, edge, 7};
  return spec;
}

}  // namespace rubble
