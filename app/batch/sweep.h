// What a batch varies besides the seed: --vary of `rubble batch`.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace rubble {

// The variants of a mission, each a value for every varied key.
struct Sweep {
  std::vector<std::string> keys;                    // as given: columns of the table
  std::vector<std::vector<std::string>> variants;   // values as text, in the order of `keys`

  bool varies() const { return !keys.empty(); }
  // "key=value" for each key, as --set takes it. variant: from 0
  std::vector<std::string> overrides(std::size_t variant) const;
  // The name of a run's folder: "seed_7", and where something varies "v2_seed_7", variants from 1.
  std::string run_name(std::size_t variant, const std::string& seed) const;
};

// varied: "key=1,2,3", of which all combinations are made, the last one changing first; or
// "key=0.1..0.5", ranges, of which `samples` points are drawn by a Latin hypercube: the range of each
// key is cut into as many equal parts, each part is drawn from once, and the parts of different keys
// are matched at random. With both, every point is combined with every combination. The points follow
// from the names of the keys and `samples` alone. Throws InputError naming --vary or --samples.
Sweep make_sweep(const std::vector<std::string>& varied, int samples);

}  // namespace rubble
