#include "tests/app/program.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace rubble::testing {

namespace fs = std::filesystem;

Outcome run_rubble(const std::string& arguments, const std::string& before) {
  const ScratchFolder scratch;
  const std::string command = "cd '" RUBBLE_SOURCE_DIR "' && " + before + " '" RUBBLE_PROGRAM "' " +
                              arguments + " >'" + (scratch / "out") + "' 2>'" + (scratch / "err") +
                              "' </dev/null";
  const int status = std::system(command.c_str());
  Outcome outcome;
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  outcome.out = read_file(scratch / "out");
  outcome.err = read_file(scratch / "err");
  return outcome;
}

ScratchFolder::ScratchFolder() {
  std::string name = (fs::temp_directory_path() / "rubble-test-XXXXXX").string();
  if (!mkdtemp(name.data())) throw std::runtime_error("mkdtemp failed for " + name);
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string read_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

void write_file(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::map<std::string, std::string> read_outputs(const fs::path& folder) {
  return nlohmann::json::parse(read_file(folder / "manifest.json")).at("outputs");
}

std::string read_state_hash(const fs::path& folder) {
  return nlohmann::json::parse(read_file(folder / "manifest.json")).at("state_hash");
}

}  // namespace rubble::testing
