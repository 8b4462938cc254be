// A program at the other end of two pipes, spoken to in lines, which may hang, die or flood.
#pragma once

#include <sys/types.h>

#include <string>

namespace rubble {

class AgentProcess {
 public:
  // Starts `/bin/sh -c command` below a process that guards it: all that it starts, also in sessions of its own, ends
  // with the agent, with this object and with this process.
  // What it writes to standard error goes to the file `log`, 1 MiB at most. Throws RunError.
  AgentProcess(const std::string& command, const std::string& log);
  ~AgentProcess();
  AgentProcess(const AgentProcess&) = delete;
  AgentProcess& operator=(const AgentProcess&) = delete;

  // A line, without its end. deadline: for it to be taken; unit: s. These throw AgentFailure (search_agent.h).
  void write_line(const std::string& line, double deadline);
  // The next line, at most kLongestLine bytes. It is the answer to what was written last: one that came before that
  // is a failure.
  std::string read_line(double deadline);
  // Anything that it said without being asked is a failure.
  void expect_silence();
  // No more lines: it may end by itself in so many seconds.
  void finish(double grace);

  static constexpr std::size_t kLongestLine = 1 << 16;

 private:
  // Waits until the agent can be read from or written to, taking what it writes to standard error.
  void wait(bool to_write, double until, const char* what);
  void take_errors();
  void take_answers();
  [[noreturn]] void fail_ended();
  void kill_all();

  pid_t pid_ = -1;  // of the process that guards the agent, and ends as it does
  int in_ = -1, out_ = -1, err_ = -1, log_ = -1, control_ = -1;
  std::size_t logged_ = 0;
  std::string answers_, last_words_;
};

}  // namespace rubble
