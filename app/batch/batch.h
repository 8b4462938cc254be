// One mission, many seeds and values of keys: `rubble batch`.
//
//   DIR/batch.json        what is being run, and by which program: a folder takes one batch
//   DIR/seed_N/           the dataset of a seed, as `rubble run` leaves it; with --vary vK_seed_N
//   DIR/failed/seed_N.log why a seed has none; gone when it has
//   DIR/index.csv         a row a run, with its figures
//
// Every process may be killed at any time and begun again, and any number of them may work in one
// folder, each on a shard of its own: the index is the same.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/batch/sweep.h"
#include "app/support/run_request.h"
#include "kernel/base/error.h"

namespace rubble {

struct BatchRequest {
  RunRequest of;           // `seed` is not used; `force`: begin although the disk is too small
  std::string seeds;       // --seeds: "1..1000", "3,5,9"
  std::vector<std::string> vary;  // --vary KEY=..., see make_sweep
  int samples = 0;         // --samples of the ranges among them; 0: there are none
  std::string shard;       // --shard I/N; empty: all
  int jobs = 0;            // --jobs: runs at once; 0: as many as there are processors
  bool index_only = false;  // --index-only: opens the folder and writes index.csv, but runs nothing
  bool pile_only = false;  // --pile-only: `rubble settle` instead of `rubble run`
};

// `done` when every seed of the shard is; `failure` when one failed (the others are done all the
// same); `did_not_settle` when one did not. Throws Stopped: the same command goes on.
ExitCode run_batch(const BatchRequest& request);

struct BatchIndex {
  std::string text;                  // of index.csv
  std::vector<std::string> altered;  // a sentence for each run whose figures cannot be trusted
};

// index.csv for these variants and seeds, from what lies in the folder: the same text whoever asks.
// Columns: seed, status (done, did_not_settle, failed, missing, altered), state_hash, bytes; with a
// sweep the variant and every key of it; what the script drew by rubble.random; then every metric.
// altered: the manifest cannot be read, is not sealed, or is not of this seed and these values or of
// the pile.bin beside it; the row has no figures.
BatchIndex make_batch_index(const std::string& folder, const Sweep& sweep,
                            const std::vector<std::uint64_t>& seeds);

}  // namespace rubble
