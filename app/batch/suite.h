// `rubble suite`: runs missions as processes, and compares what comes out with what is expected.
#pragma once

#include <string>
#include <vector>

#include "app/support/run_request.h"
#include "kernel/base/error.h"

namespace rubble {

struct SuiteRequest {
  std::string suite;              // path of the Lua script
  std::string out;                // --out; empty: out/<name of the script>
  std::string junit;              // --junit FILE
  std::string against;            // --against DIR: the --out of an earlier run, to name pixels by
  bool update = false;            // --update: rewrite the golden file, showing what changes
  std::vector<std::string> only;  // --only NAME; empty: all
  int jobs = 0;                   // --jobs; 0: one a processor
  RunOptions options;             // of every run of the suite
};

// Prints a line for each run and a summary on standard output. `differs` when an expectation is not
// met or a run failed. Throws InputError for a suite that cannot be read, Stopped.
ExitCode run_suite(const SuiteRequest& request);

}  // namespace rubble
