#include "tests/app/program.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cctype>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <thread>
#include <vector>

#include "app/command_line/run_program.h"

namespace rubble::testing {

namespace fs = std::filesystem;

namespace {

// The words of a line as the shell would take them; none where the line asks for more of a shell than quotes.
std::optional<std::vector<std::string>> split_words(const std::string& line) {
  std::vector<std::string> words;
  bool inside = false;
  for (std::size_t at = 0; at < line.size(); ++at) {
    const char c = line[at];
    if (std::isspace(static_cast<unsigned char>(c))) {
      inside = false;
      continue;
    }
    if (!inside) words.emplace_back(), inside = true;
    if (c == '\'' || c == '"') {
      const std::size_t end = line.find(c, at + 1);
      if (end == std::string::npos) return {};
      const std::string text = line.substr(at + 1, end - at - 1);
      if (c == '"' && text.find_first_of("$`\\") != std::string::npos) return {};
      words.back() += text, at = end;
    } else if (std::string("$`\\*?[]~|&;<>(){}#!").find(c) != std::string::npos) {
      return {};
    } else {
      words.back() += c;
    }
  }
  return words;
}

int count_threads() {
  const fs::directory_iterator tasks("/proc/self/task");
  return int(std::distance(fs::begin(tasks), fs::end(tasks)));
}
// Libraries have threads that wait for work from when they are loaded on (log4cplus, by way of OpenVDB).
const int kThreadsOfLibraries = count_threads() - 1;

// Of a batch and a suite the jobs are begun by the program's name.
bool starts_the_program_itself(const std::string& command) { return command == "batch" || command == "suite"; }

void open_as(int descriptor, const std::string& path, int flags) {
  const int file = open(path.c_str(), flags, 0600);
  if (file < 0 || dup2(file, descriptor) < 0) _exit(126);
  close(file);
}

bool can_fork(const std::optional<std::vector<std::string>>& words) {
  return words && !words->empty() && !starts_the_program_itself(words->front()) &&
         count_threads() - kThreadsOfLibraries == 1;
}

// The program in a process that is forked from this one: loading its more than two hundred libraries takes longer than
// most commands. It does with the signal what is usual.
pid_t start_forked(const std::vector<std::string>& words, const std::string& out, const std::string& err,
                   int signal = SIGTERM) {
  std::fflush(nullptr), std::cout.flush();
  const pid_t child = fork();
  if (child == 0) {
    std::signal(signal, SIG_DFL);  // nohup ignores SIGHUP
    if (chdir(RUBBLE_SOURCE_DIR) != 0) _exit(126);
    open_as(STDIN_FILENO, "/dev/null", O_RDONLY);
    open_as(STDOUT_FILENO, out, O_WRONLY | O_CREAT | O_TRUNC);
    open_as(STDERR_FILENO, err, O_WRONLY | O_CREAT | O_TRUNC);
    std::vector<std::string> texts = {RUBBLE_PROGRAM};
    texts.insert(texts.end(), words.begin(), words.end());
    std::vector<char*> arguments;
    for (std::string& text : texts) arguments.push_back(text.data());
    arguments.push_back(nullptr);
    const int code = run_program(int(texts.size()), arguments.data());
    std::fflush(nullptr), std::cout.flush(), std::cerr.flush();
    _exit(code);  // what libraries do at the end waits for their threads, which are not in this process
  }
  return child;
}

}  // namespace

Outcome run_rubble(const std::string& arguments, const std::string& before) {
  const ScratchFolder scratch;
  const auto words = before.empty() ? split_words(arguments) : std::nullopt;
  int status = 0;
  if (can_fork(words)) {
    waitpid(start_forked(*words, scratch / "out", scratch / "err"), &status, 0);
  } else {
    const std::string command = "cd '" RUBBLE_SOURCE_DIR "' && " + before + " '" RUBBLE_PROGRAM "' " + arguments + " >'" +
                                (scratch / "out") + "' 2>'" + (scratch / "err") + "' </dev/null";
    status = std::system(command.c_str());
  }
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

Outcome run_rubble_and_signal(const std::string& arguments, const std::function<bool()>& when, int signal) {
  return run_rubble_and_signal(arguments, [&](const std::string&) { return when(); }, signal);
}

Outcome run_rubble_and_signal(const std::string& arguments, const std::function<bool(const std::string& said)>& when,
                              int signal) {
  const ScratchFolder scratch;
  const auto words = split_words(arguments);
  pid_t child = 0;
  if (can_fork(words)) {
    child = start_forked(*words, scratch / "out", scratch / "err", signal);
  } else if ((child = fork()) == 0) {
    const std::string command = "cd '" RUBBLE_SOURCE_DIR "' && exec '" RUBBLE_PROGRAM "' " + arguments + " >'" +
                                (scratch / "out") + "' 2>'" + (scratch / "err") + "' </dev/null";
    std::signal(signal, SIG_DFL);
    execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }
  int status = 0;
  pid_t ended = 0;
  while ((ended = waitpid(child, &status, WNOHANG)) == 0 && !when(read_file(scratch / "err")))
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
