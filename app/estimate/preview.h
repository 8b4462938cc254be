// What a run will take, said before it begins: room from the mission, time from earlier runs here.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/assets/asset_library.h"
#include "app/provenance/provenance.h"
#include "app/support/progress.h"

namespace rubble {

struct RunPreview {
  double pieces = 0, frames = 0;   // frames: 0 for a pile alone
  // Pieces that are there, summed over the layers that fall on them: each layer wakes some of the pile.
  double piled = 0;
  // Of all pictures that are drawn: of a stereo pair both, of a pixel all its samples. Each sample of a path-traced pixel is
  // a pixel.
  double megapixels = 0, traced_megapixels = 0;
  double robot_seconds = 0;        // simulated, of all robots together
  bool collapses = false;          // the pile is a building's
  std::uint64_t bytes = 0;         // at most
  std::uint64_t free = 0;          // on the disk of the output
  std::optional<double> seconds;   // about; none: nothing like it, as large as a twentieth, was run here yet
};
RunPreview preview_run(RunKind kind, const Scenario& mission, const AssetLibrary& assets, const std::string& out);

// "1217 pieces, 121 frames; at most 1.2 GB (67 GB free), about 30 s by earlier runs"
std::string describe(const RunPreview& preview);
// A line a file, largest first, and the sum.
std::string describe_files(RunKind kind, const Scenario& mission, const AssetLibrary& assets);

// Keeps how long a finished run took, for later previews: in the cache folder, as sums in which each run has
// twice the weight of the one before. Changes no result.
void note_speed(const RunPreview& preview, const Progress& progress);

}  // namespace rubble
