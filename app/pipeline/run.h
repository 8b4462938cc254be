// One run, stage by stage. Each stage turns finished products into the next one, and what it has
// finished is a file with a hash, from which a run that was killed goes on:
//
//   stage     from                  to                            kept as
//   recipe    script or manifest    Recipe                        unfinished/run.json
//   assets    recipe, packs         AssetLibrary                  (the packs; checked by content)
//   settle    scenario, assets      PileState                     pile.bin
//   files     pile                  meshes of the pile            pile.stl
//   frames    scenario, pile        Frames, one after another     every recorder's file
//   manifest  all                   hashes of all                 manifest.json
#pragma once

#include <map>
#include <string>
#include <vector>

#include "app/assets/asset_library.h"
#include "app/pipeline/metrics.h"
#include "app/pipeline/run_request.h"
#include "app/provenance/frame_hashes.h"
#include "app/provenance/provenance.h"
#include "app/provenance/run_folder.h"
#include "app/support/progress.h"
#include "kernel/base/error.h"
#include "kernel/model/pile_state.h"

namespace rubble {

struct Run {
  Run(const RunOptions& options, Recipe recipe);

  RunOptions options;
  Progress progress;
  Recipe recipe;
  Scenario scenario;       // what the recipe states
  Scenario pile_scenario;  // the same, but of the run that settled the pile for a `render`
  AssetLibrary assets;

  PileState pile;
  FrameHashes frames;
  Metrics metrics;
  std::map<std::string, std::string> environment;
  std::vector<std::string> warnings;  // what is likely not as it was meant, for a person

  int threads() const;  // as asked, or all processors
};

// Recipe and assets, from a script on the disk.
Run start_run(const RunRequest& request, RunKind kind);
// From a recipe; the packs are looked for in `pack_folders` and among the bundled ones.
Run start_run(const RunOptions& options, const Recipe& recipe,
              const std::vector<std::string>& pack_folders);
// A new camera and light over the pile of a finished run, in `saved`; its packs as above.
struct SavedRun;
Run start_render(const RunRequest& request, const SavedRun& saved);

// Keeps a pile that another run settled as the product of this run's first stage.
void keep_pile(const Run& run, const PileState& state, const RunFolder& folder);

// The stages. settle() takes pile.bin if it is there and was made from the same pile and options, and
// goes on from a checkpoint if one is.
void settle(Run& run, RunFolder& folder);
void write_pile_files(Run& run, RunFolder& folder);
void render_frames(Run& run, RunFolder& folder);
void write_manifest(const Run& run, RunFolder& folder);

// Marks the folder as unfinished, runs every stage that is not finished yet, and unmarks it. Prints
// the folder. Throws as the stages do, after saying how to continue.
ExitCode complete(Run& run, RunFolder& folder);

// unfinished/run.json: what was being run, and by which program.
std::string describe_unfinished(const Run& run);
Run continue_run(const RunOptions& options, const RunFolder& folder,
                 const std::vector<std::string>& pack_folders);

}  // namespace rubble
