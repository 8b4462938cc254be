#include "tests/app/program.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

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

Outcome run_rubble_to(const std::string& arguments, const std::string& redirection) {
  const ScratchFolder scratch;
  const std::string command = "cd '" RUBBLE_SOURCE_DIR "' && '" RUBBLE_PROGRAM "' " + arguments +
                              " 2>'" + (scratch / "err") + "' </dev/null " + redirection;
  const int status = std::system(command.c_str());
  Outcome outcome;
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  outcome.err = read_file(scratch / "err");
  return outcome;
}

Outcome run_rubble_and_signal(const std::string& arguments, double seconds, int signal) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  return run_rubble_and_signal(
      arguments, [end] { return std::chrono::steady_clock::now() >= end; }, signal);
}

Outcome run_rubble_and_signal(const std::string& arguments, const std::function<bool()>& when,
                              int signal) {
  const ScratchFolder scratch;
  const std::string command = "cd '" RUBBLE_SOURCE_DIR "' && exec '" RUBBLE_PROGRAM "' " +
                              arguments + " >'" + (scratch / "out") + "' 2>'" + (scratch / "err") +
                              "' </dev/null";
  const pid_t child = fork();
  if (child == 0) {
    execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }
  int status = 0;
  pid_t ended = 0;
  while ((ended = waitpid(child, &status, WNOHANG)) == 0 && !when())
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  if (ended == 0) {
    kill(child, signal);
    waitpid(child, &status, 0);
  }
  Outcome outcome;
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  outcome.out = read_file(scratch / "out");
  outcome.err = read_file(scratch / "err");
  return outcome;
}

const char* const kTinyMission = R"(return rubble.mission {
  seed = 3,
  pile = { layers = 2, pieces_per_layer = 8, mix = { { asset = "brick" } },
           spawn_position = { 0, 0, 1.5 }, spawn_bounds = { 1, 1, 1 } },
  camera = { width = 64, height = 48 },
  trajectory = { rate_hz = 10, waypoints = {
    { t = 0, position = { -1.5, 0, 0.8 }, look_at = { 0, 0, 0.1 } },
    { t = 0.2, position = { -1.4, 0.1, 0.8 }, look_at = { 0, 0, 0.1 } },
  } },
}
)";

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
