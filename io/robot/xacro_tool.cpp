#include "io/robot/xacro_tool.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <system_error>

#include "kernel/base/error.h"
#include "kernel/base/system/file_sandbox.h"
#include "kernel/base/text.h"

extern char** environ;

namespace rubble {
namespace {

constexpr std::chrono::seconds kLongest{120};
constexpr std::size_t kMostBytes = std::size_t(256) << 20;  // of its output
constexpr std::size_t kMostWords = 600;                     // of what it says in an error; unit: byte

struct Pipe {
  int ends[2] = {-1, -1};
  Pipe() {
    if (pipe2(ends, O_CLOEXEC) != 0)
      throw RunError("cannot make a pipe: " + std::generic_category().message(errno));
  }
  ~Pipe() { close_end(0), close_end(1); }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void close_end(int end) {
    if (ends[end] >= 0) close(ends[end]);
    ends[end] = -1;
  }
};

struct Outcome {
  bool found = true, in_time = true;
  int status = 0;
  std::string out, err;
};

// Reads until both are closed. False: too late, or too much.
bool read_all(Pipe& out, Pipe& err, Outcome& outcome) {
  const auto end = std::chrono::steady_clock::now() + kLongest;
  while (out.ends[0] >= 0 || err.ends[0] >= 0) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    if (left.count() <= 0 || outcome.out.size() + outcome.err.size() > kMostBytes) return false;
    pollfd ready[2] = {{out.ends[0], POLLIN, 0}, {err.ends[0], POLLIN, 0}};
    if (poll(ready, 2, int(left.count())) < 0 && errno != EINTR) return false;
    for (int i = 0; i < 2; ++i) {
      if (ready[i].fd < 0 || ready[i].revents == 0) continue;
      char bytes[65536];
      const ssize_t count = read(ready[i].fd, bytes, sizeof bytes);
      if (count > 0) (i == 0 ? outcome.out : outcome.err).append(bytes, std::size_t(count));
      if (count == 0) (i == 0 ? out : err).close_end(0);
    }
  }
  return true;
}

Outcome run_tool(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  Pipe out, err;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, out.ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, err.ends[1], STDERR_FILENO);
  Outcome outcome;
  pid_t child = -1;
  outcome.found = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ) == 0;
  posix_spawn_file_actions_destroy(&actions);
  if (!outcome.found) return outcome;
  out.close_end(1), err.close_end(1);
  outcome.in_time = read_all(out, err, outcome);
  if (!outcome.in_time) kill(child, SIGKILL);
  while (waitpid(child, &outcome.status, 0) < 0 && errno == EINTR) {
  }
  return outcome;
}

// The end of what it says: there Python and xacro have the reason.
std::string last_words(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  if (text.size() > kMostWords) text = "..." + text.substr(text.size() - kMostWords);
  for (char& c : text)
    if (c == '\n') c = ' ';
  return printable(text);
}

// in_gazebo: an attribute in <gazebo> is for Gazebo's plugins, which may expand "$(env HOME)" themselves.
bool needs_xacro(const XmlElement& element, const std::string& prefix, bool in_gazebo) {
  if (element.name.compare(0, prefix.size(), prefix) == 0) return true;
  if (in_gazebo) return false;
  for (const auto& attribute : element.attributes)
    if (attribute.second.find("${") != std::string::npos || attribute.second.find("$(") != std::string::npos) return true;
  return false;
}

const XmlElement* find_in(const XmlElement& element, const std::string& prefix, bool in_gazebo = false) {
  in_gazebo = in_gazebo || element.name == "gazebo";
  if (needs_xacro(element, prefix, in_gazebo)) return &element;
  for (const XmlElement& child : element.children)
    if (const XmlElement* found = find_in(child, prefix, in_gazebo)) return found;
  return nullptr;
}

}  // namespace

bool is_xacro_file(const std::string& path) {
  const std::string end = ".xacro";
  return path.size() > end.size() && path.compare(path.size() - end.size(), end.size(), end) == 0;
}

const XmlElement* find_xacro(const XmlElement& root) {
  std::string prefix = "xacro:";
  for (const auto& [name, value] : root.attributes)
    if (name.compare(0, 6, "xmlns:") == 0 && value.find("xacro") != std::string::npos) prefix = name.substr(6) + ":";
  return find_in(root, prefix);
}

std::string expand_xacro(const std::string& path, const XmlElement& first,
                         const std::vector<std::pair<std::string, std::string>>& arguments) {
  const std::string need = "<" + first.name + "> of xacro";
  if (!sandbox_folder().empty())
    throw InputError({path, first.line, "", need + " is not expanded in a sandbox", "a URDF file",
                      "a xacro file, a program of its author, for which another program would read files",
                      "expand it where nothing else can be read: xacro FILE > FILE.urdf; or leave --sandbox out"});
  // A name that begins with "-" or holds ":=" is a file nevertheless.
  std::vector<std::string> words{"xacro", path[0] == '/' ? path : "./" + path};
  for (const auto& [name, value] : arguments) words.push_back(name + ":=" + value);
  const Outcome outcome = run_tool(std::move(words));
  if (!outcome.found || (WIFEXITED(outcome.status) && WEXITSTATUS(outcome.status) == 127))
    throw InputError({path, first.line, "", need + " is not expanded", "the tool `xacro` on the PATH, or a URDF file",
                      "no such tool", "pip install xacro, or expand the file elsewhere: xacro FILE > FILE.urdf"});
  if (!outcome.in_time)
    throw InputError({path, first.line, "", need + " cannot be expanded: the xacro tool does not end",
                      "at most 120 s and 256 MB", "more", ""});
  if (!WIFEXITED(outcome.status) || WEXITSTATUS(outcome.status) != 0)
    throw InputError({path, first.line, "", need + " cannot be expanded: the xacro tool fails", "a URDF file",
                      last_words(outcome.err), "urdf_arguments = { NAME = \"VALUE\" } gives it arguments"});
  return outcome.out;
}

}  // namespace rubble
