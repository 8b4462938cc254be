// Errors by audience: assertions for our own bugs, InputError for mistakes of the user, and RunError
// for failures of the machine. Only main() turns them into exit codes.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace rubble {

// What `rubble` returns to its caller. Stable: scripts and CI read them.
enum class ExitCode {
  done = 0,
  bad_input = 1,
  failure = 2,
  did_not_settle = 3,  // or pieces left the world: the pile is not the requested one
  stopped = 4,  // by SIGINT, SIGTERM or SIGHUP; `rubble resume` continues
  differs = 5,  // verify found a difference, or a suite an expectation that is not met
};

// One mistake in a user's file or option. Fields that do not apply stay empty (line: 0).
struct Diagnostic {
  std::string file;      // as the user named it; empty: no file
  int line = 0;          // 1-based
  std::string key;       // whole path, e.g. "camera.width"
  std::string message;   // the fault, in a few words
  std::string expected;  // e.g. "an integer from 16 to 8192"
  std::string found;     // e.g. "the string \"wide\""
  std::string hint;      // the remedy

  // "file:line: key: message: expected E, found F (hint)". Empty fields are left out; control
  // characters are made visible (kernel/base/text.h).
  std::string text() const;
};

// Bad input. Holds all mistakes of one pass. Exit code 1.
class InputError : public std::runtime_error {
 public:
  explicit InputError(Diagnostic diagnostic);
  explicit InputError(std::vector<Diagnostic> diagnostics);  // not empty
  const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

 private:
  std::vector<Diagnostic> diagnostics_;
};

// A failure that is not the fault of the input: disk, EGL, memory. Exit code 2.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The user asked the program to stop, and it did so cleanly. Exit code 4.
class Stopped : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace rubble
