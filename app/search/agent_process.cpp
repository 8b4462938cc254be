#include "app/search/agent_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "app/search/search_agent.h"
#include "app/support/stop.h"
#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/base/system/output_files.h"

namespace rubble {
namespace {

constexpr std::size_t kMostLog = 1 << 20;  // unit: byte
constexpr std::size_t kLastWords = 400;    // unit: byte
constexpr double kKilling = 5;             // what forks faster than it is killed is left after this; unit: s

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

[[noreturn]] void fail_to_start() {
  throw RunError("cannot start the agent: " + std::generic_category().message(errno));
}

struct Ends {
  int ours = -1, theirs = -1;
};

// A socket, so that writing to an agent that is gone is an error and no signal. what: SOCK_STREAM both ways.
Ends make_ends() {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) fail_to_start();
  fcntl(ends[0], F_SETFL, O_NONBLOCK);
  return {ends[0], ends[1]};
}

Ends make_pipe() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) fail_to_start();
  fcntl(ends[0], F_SETFL, O_NONBLOCK);
  return {ends[0], ends[1]};
}

// Only calls that are safe between fork and exec.
[[noreturn]] void become_agent(const char* command, int in, int out, int err) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() == 1) _exit(127);
  dup2(in, STDIN_FILENO), dup2(out, STDOUT_FILENO), dup2(err, STDERR_FILENO);
  signal(SIGINT, SIG_DFL), signal(SIGTERM, SIG_DFL), signal(SIGHUP, SIG_DFL);
  execl("/bin/sh", "sh", "-c", command, static_cast<char*>(nullptr));
  _exit(127);
}

// The parent of a process, out of "12 (its name) S 7 ..."; 0: it is gone.
pid_t parent_of(const std::string& process) {
  char text[512];
  const int file = open(("/proc/" + process + "/stat").c_str(), O_RDONLY | O_CLOEXEC);
  const ssize_t size = file < 0 ? -1 : read(file, text, sizeof text - 1);
  if (file >= 0) close(file);
  if (size <= 0) return 0;
  text[size] = 0;
  const char* const end = std::strrchr(text, ')');  // the name may have any characters
  return end && std::strlen(end) > 4 ? pid_t(std::atoi(end + 4)) : 0;
}

void kill_children() {
  const pid_t own = getpid();
  std::error_code failed;
  for (std::filesystem::directory_iterator at("/proc", failed), end; !failed && at != end; at.increment(failed)) {
    const std::string name = at->path().filename().string();
    if (name.find_first_not_of("0123456789") == std::string::npos && parent_of(name) == own)
      kill(pid_t(std::atoi(name.c_str())), SIGKILL);
  }
}

// Kills all processes that the agent started, also those with a session of their own: a child whose parent is gone
// becomes a child of this one. agent: its group, for where /proc is missing; 0: it is gone.
void kill_descendants(pid_t agent) {
  const double end = now() + kKilling;
  while (now() < end) {
    if (agent > 0) kill(-agent, SIGKILL);
    kill_children();
    pid_t gone = 0;
    while ((gone = waitpid(-1, nullptr, WNOHANG)) > 0) {
    }
    if (gone < 0 && errno == ECHILD) return;
    usleep(2000);
  }
}

// Stands between this program and the agent, as the parent of all that the agent starts. It ends as the agent
// ended, or when `control` is closed or written to: with this program, however that ends. What is left is killed.
[[noreturn]] void guard_agent(const char* command, int in, int out, int err, int control) {
  setpgid(0, 0);
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  for (const int ignored : {SIGINT, SIGTERM, SIGHUP}) signal(ignored, SIG_IGN);
  const pid_t agent = fork();
  if (agent == 0) become_agent(command, in, out, err);
  if (agent < 0) _exit(127);
  setpgid(agent, agent);  // whoever comes first
  // The other ends of the agent's pipes and the locks of this program must not live on in here.
  if (dup2(control, 3) != 3 || close_range(4, ~0u, 0) != 0) kill_descendants(agent), _exit(127);
  for (const int unused : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) close(unused);
  int status = 0;
  for (pollfd closed{3, POLLIN, 0}; poll(&closed, 1, 5) == 0 || errno == EINTR;) {
    errno = 0;
    for (pid_t gone = 0; (gone = waitpid(-1, &status, WNOHANG)) > 0;) {
      if (gone != agent) continue;
      kill_descendants(0);
      if (WIFEXITED(status)) _exit(WEXITSTATUS(status));
      const rlimit no_core{0, 0};
      setrlimit(RLIMIT_CORE, &no_core);
      signal(WTERMSIG(status), SIG_DFL);
      kill(getpid(), WTERMSIG(status));
      _exit(128 + WTERMSIG(status));
    }
  }
  kill_descendants(agent);
  _exit(0);
}

std::string how_it_ended(int status) {
  if (WIFEXITED(status)) return "with exit code " + std::to_string(WEXITSTATUS(status));
  return std::string("by signal ") + std::to_string(WTERMSIG(status)) + " (" + strsignal(WTERMSIG(status)) + ")";
}

std::string seconds(double value) { return plain_text(value) + " s"; }

}  // namespace

AgentProcess::AgentProcess(const std::string& command, const std::string& log) {
  log_ = create_log_file(log);
  const Ends in = make_ends(), out = make_pipe(), err = make_pipe();
  const Ends control = make_ends();
  pid_ = fork();
  if (pid_ == 0) guard_agent(command.c_str(), in.theirs, out.theirs, err.theirs, control.theirs);
  for (const int end : {in.theirs, out.theirs, err.theirs, control.theirs}) close(end);
  in_ = in.ours, out_ = out.ours, err_ = err.ours, control_ = control.ours;
  if (pid_ < 0) fail_to_start();
}

AgentProcess::~AgentProcess() {
  kill_all();
  for (const int end : {in_, out_, err_, log_, control_})
    if (end >= 0) close(end);
}

// A byte, too: a child of this program may hold the pipe open.
void AgentProcess::kill_all() {
  if (pid_ <= 0) return;
  send(control_, "k", 1, MSG_NOSIGNAL);
  kill(pid_, SIGCONT);
  waitpid(pid_, nullptr, 0);
  pid_ = -1;
}

void AgentProcess::take_errors() {
  char bytes[4096];
  ssize_t got = 0;
  for (; err_ >= 0 && (got = read(err_, bytes, sizeof bytes)) > 0;) {
    last_words_.append(bytes, std::size_t(got));
    if (last_words_.size() > kLastWords) last_words_.erase(0, last_words_.size() - kLastWords);
    const std::size_t kept = std::min(std::size_t(got), kMostLog - logged_);
    if (write(log_, bytes, kept) == ssize_t(kept)) logged_ += kept;
  }
  if (err_ < 0 || got != 0) return;
  close(err_);  // poll() would report its end for ever
  err_ = -1;
}

void AgentProcess::take_answers() {
  char bytes[4096];
  while (answers_.size() <= kLongestLine) {
    const ssize_t got = read(out_, bytes, sizeof bytes);
    if (got > 0) {
      answers_.append(bytes, std::size_t(got));
    } else if (got == 0) {
      if (answers_.find('\n') == std::string::npos) fail_ended();
      return;
    } else {
      return;
    }
  }
}

void AgentProcess::fail_ended() {
  int status = 0;
  const double end = now() + 1;  // its output may be closed a little before it is gone
  pid_t gone = 0;
  while ((gone = waitpid(pid_, &status, WNOHANG)) == 0 && now() < end) usleep(2000);
  take_errors();
  std::string text = "the agent closed its output";
  if (gone == pid_) {
    text = "the agent ended " + how_it_ended(status);
    pid_ = -1;
  }
  while (!last_words_.empty() && last_words_.back() == '\n') last_words_.pop_back();
  throw AgentFailure{text + " before the search was over" +
                     (last_words_.empty() ? "" : "; it said last: " + last_words_)};
}

void AgentProcess::wait(bool to_write, double until, const char* what) {
  throw_if_stopped("");
  const double left = until - now();
  if (left <= 0) throw AgentFailure{what};
  pollfd ends[3] = {{out_, short(to_write ? 0 : POLLIN), 0}, {err_, POLLIN, 0}, {in_, short(to_write ? POLLOUT : 0), 0}};
  poll(ends, to_write ? 3 : 2, int(std::min(left, 0.2) * 1000) + 1);
  take_errors();
}

void AgentProcess::write_line(const std::string& line, double deadline) {
  const std::string text = line + "\n";
  const double until = now() + deadline;
  const std::string late = "the agent did not read for " + seconds(deadline);
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t sent = send(in_, text.data() + done, text.size() - done, MSG_NOSIGNAL);
    if (sent > 0)
      done += std::size_t(sent);
    else if (errno == EAGAIN || errno == EINTR)
      wait(true, until, late.c_str());
    else
      fail_ended();
  }
}

std::string AgentProcess::read_line(double deadline) {
  const double until = now() + deadline;
  const std::string late = "the agent did not answer for " + seconds(deadline);
  for (;;) {
    take_answers();
    const std::size_t end = answers_.find('\n');
    if (end != std::string::npos) {
      const std::string line = answers_.substr(0, end);
      answers_.erase(0, end + 1);
      expect_silence();
      return line;
    }
    if (answers_.size() > kLongestLine)
      throw AgentFailure{"the agent floods: more than " + std::to_string(kLongestLine) + " bytes without a line's end"};
    wait(false, until, late.c_str());
  }
}

void AgentProcess::expect_silence() {
  char byte;
  if (answers_.empty() && read(out_, &byte, 1) <= 0) return;
  throw AgentFailure{"the agent floods: it wrote more than one line in answer to one"};
}

void AgentProcess::finish(double grace) {
  close(in_);
  in_ = -1;
  const double end = now() + grace;
  char bytes[4096];
  while (waitpid(pid_, nullptr, WNOHANG) == 0) {
    if (now() > end) return kill_all();
    while (read(out_, bytes, sizeof bytes) > 0) {
    }
    take_errors();
    usleep(2000);
  }
  take_errors();
  pid_ = -1;
}

}  // namespace rubble
