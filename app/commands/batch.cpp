// `rubble batch`: one mission with many seeds and values of keys (docs/how_to/batch.md).
#include "app/batch/batch.h"

#include <memory>

#include "app/command_line/command.h"
#include "app/command_line/common_options.h"

namespace rubble {
namespace {

Action declare_batch(CommandLine& line) {
  const auto request = std::make_shared<BatchRequest>();
  add_mission_options(line, request->of);
  line.add("--seeds", request->seeds, "The seeds, as in 1..1000 or 3,5,9").required().metavar("SEEDS");
  line.add("--vary", request->vary,
           "Vary a key besides the seed: every value of KEY=1,2,3, or samples of KEY=LOW..HIGH")
      .metavar("KEY=VALUES");
  line.add("--samples", request->samples,
           "Number of samples of the ranges of --vary, by Latin hypercube sampling")
      .between(1, 100000)
      .metavar("N");
  line.add("--shard", request->shard, "Run only part I of N, for one of N machines").metavar("I/N");
  add_preview_option(line, request->of);
  line.add_flag("--index-only", request->index_only, "Write index.csv of the runs that are there, and run nothing");
  line.add_flag("--pile-only", request->pile_only, "Settle the piles only; render nothing");
  line.add("--out", request->of.out, "Output folder")
      .shows_default_text("out/<script>_batch")
      .metavar("DIR");
  line.add_flag("--force", request->of.force, "Start even if the disk space seems too small");
  add_jobs_options(line, request->jobs, request->of.options);
  return [request] { return run_batch(*request); };
}

}  // namespace

Command batch_command() {
  return {"", "batch", "Run a mission with many seeds and values, and write a table of results",
          declare_batch};
}

}  // namespace rubble
