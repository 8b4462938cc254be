// `rubble suite`: many missions with what is expected of them, for continuous integration.
#include "app/batch/suite.h"

#include <memory>

#include "app/command_line/command.h"
#include "app/command_line/common_options.h"

namespace rubble {
namespace {

Action declare_suite(CommandLine& line) {
  const auto request = std::make_shared<SuiteRequest>();
  line.add("suite", request->suite, "The suite: a Lua script").required().metavar("FILE");
  line.add("--out", request->out, "Output folder")
      .shows_default_text("out/<name of the suite>")
      .metavar("DIR");
  line.add("--junit", request->junit, "Write the results as JUnit XML").metavar("FILE");
  const Option update = line.add_flag("--update", request->update, "Store the hashes of this run as golden hashes");
  line.add("--against", request->against,
           "Output folder of an earlier run of the suite. Where a hash is not the golden one, the first pixel that differs is reported")
      .metavar("DIR")
      .excludes(update);
  line.add("--only", request->only, "Run only the entries with this name").metavar("NAME");
  add_jobs_options(line, request->jobs, request->options);
  return [request] { return run_suite(*request); };
}

}  // namespace

Command suite_command() {
  return {"", "suite", "Run many missions and compare the results with expected ones, for continuous integration",
          declare_suite};
}

}  // namespace rubble
