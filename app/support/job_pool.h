// Runs of this program as processes of their own: one that fails or crashes harms no other.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace rubble {

struct Job {
  std::vector<std::string> arguments;  // of `rubble`
  std::string log;                     // file for its standard output and error
};

struct JobResult {
  int exit_code = 0;   // of one that a signal killed: 128 and the signal
  double seconds = 0;  // wall-clock time; unit: s
};

// Runs them in order, `at_once` of them at a time, and calls `ended` as each one ends; when that
// returns false, no further one is begun. On a signal to stop (see app/support/stop.h) all are stopped
// cleanly, and killed if they are not done after a minute; returns when none is left. They do not
// outlive this process. The log of one that a signal killed says so; that one is suspended is said on
// standard error. Throws RunError.
void run_jobs(const std::vector<Job>& jobs, int at_once,
              const std::function<bool(std::size_t index, const JobResult&)>& ended);

// How many at once, and with how many threads each, when nothing was asked for (0).
struct JobShape {
  int at_once = 1, threads = 1;  // processes, and threads of each; both at least 1
};
JobShape choose_job_shape(int at_once, int threads);

// The end of a log, for a message; at most `lines` lines.
std::string tail_of_log(const std::string& log, int lines);

}  // namespace rubble
