// Runs the built program as a user would, and looks at what it left.
#pragma once

#include <csignal>
#include <filesystem>
#include <functional>
#include <map>
#include <string>

namespace rubble::testing {

struct Outcome {
  int exit_code = -1;
  std::string out, err;
};

// Runs `rubble ARGUMENTS` from the root of the sources: in a process forked from this one, or by the shell where the
// arguments need one, where `before` stands before the program's name, or where this process has other threads.
Outcome run_rubble(const std::string& arguments, const std::string& before = "");

// With its standard output elsewhere, as in ">/dev/full".
Outcome run_rubble_to(const std::string& arguments, const std::string& redirection);

// Sends it a signal after so many seconds of the clock on the wall, unless it has ended by then;
// the exit code of one that a signal killed is 128 and the signal.
Outcome run_rubble_and_signal(const std::string& arguments, double seconds, int signal);
// Likewise, as soon as `when` is true; said: on its standard error so far.
Outcome run_rubble_and_signal(const std::string& arguments, const std::function<bool()>& when,
                              int signal);
Outcome run_rubble_and_signal(const std::string& arguments, const std::function<bool(const std::string& said)>& when,
                              int signal);

// A mission that takes a fraction of a second: 16 bricks, 3 frames of 64x48.
extern const char* const kTinyMission;

// A new empty folder for the current test; removed when the object goes.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  std::filesystem::path path() const { return path_; }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

std::string read_file(const std::filesystem::path& path);
void write_file(const std::filesystem::path& path, const std::string& text);

// The "outputs" of a manifest, and its "state_hash".
std::map<std::string, std::string> read_outputs(const std::filesystem::path& folder);
std::string read_state_hash(const std::filesystem::path& folder);

}  // namespace rubble::testing
