// Runs the built program as a user would, and looks at what it left.
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace rubble::testing {

struct Outcome {
  int exit_code = -1;
  std::string out, err;
};

// Runs `rubble ARGUMENTS` through the shell, from the root of the sources.
Outcome run_rubble(const std::string& arguments, const std::string& before = "");

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
