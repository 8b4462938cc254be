// `rubble batch`: one mission with many seeds and values of keys (docs/batch.md).
#include "app/batch/batch.h"

#include <memory>

#include "app/command_line/command.h"
#include "app/command_line/common_options.h"

namespace rubble {
namespace {

Action declare_batch(CommandLine& line) {
  const auto request = std::make_shared<BatchRequest>();
  add_mission_options(line, request->of);
  line.add("--seeds", request->seeds, "The seeds, as in 1..1000 or 3,5,9").required();
  line.add("--vary", request->vary,
           "Vary a key besides the seed: all of KEY=1,2,3, or KEY=LOW..HIGH with --samples")
      .metavar("KEY=VALUES");
  line.add("--samples", request->samples,
           "Points of the ranges of --vary, by a Latin hypercube")
      .between(1, 100000)
      .metavar("N");
  line.add("--shard", request->shard, "Only part I of N, for one of N machines").metavar("I/N");
  line.add_flag("--pile-only", request->pile_only, "Settle the piles, render nothing");
  line.add("--out", request->of.out, "Output folder")
      .shows_default_text("out/<script>_batch")
      .metavar("DIR");
  line.add_flag("--force", request->of.force, "Begin although the disk looks too small");
  add_jobs_options(line, request->jobs, request->of.options);
  return [request] { return run_batch(*request); };
}

}  // namespace

Command batch_command() {
  return {"", "batch", "One mission with many seeds and values, and a table of them", declare_batch};
}

}  // namespace rubble
