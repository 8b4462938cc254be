#include "app/search/agent_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <system_error>

#include "app/search/search_agent.h"
#include "app/support/stop.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

constexpr std::size_t kMostLog = 1 << 20;  // unit: byte
constexpr std::size_t kLastWords = 400;    // unit: byte

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
[[noreturn]] void become_agent(const char* command, int in, int out, int err, pid_t parent) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);
  dup2(in, STDIN_FILENO), dup2(out, STDOUT_FILENO), dup2(err, STDERR_FILENO);
  signal(SIGINT, SIG_DFL), signal(SIGTERM, SIG_DFL), signal(SIGHUP, SIG_DFL);
  execl("/bin/sh", "sh", "-c", command, static_cast<char*>(nullptr));
  _exit(127);
}

std::string how_it_ended(int status) {
  if (WIFEXITED(status)) return "with exit code " + std::to_string(WEXITSTATUS(status));
  return std::string("by signal ") + std::to_string(WTERMSIG(status)) + " (" + strsignal(WTERMSIG(status)) + ")";
}

std::string seconds(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text + " s";
}

}  // namespace

AgentProcess::AgentProcess(const std::string& command, const std::string& log) {
  log_ = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (log_ < 0) throw RunError("cannot create " + log + ": " + std::generic_category().message(errno));
  const Ends in = make_ends(), out = make_pipe(), err = make_pipe();
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ == 0) become_agent(command.c_str(), in.theirs, out.theirs, err.theirs, parent);
  for (const int end : {in.theirs, out.theirs, err.theirs}) close(end);
  in_ = in.ours, out_ = out.ours, err_ = err.ours;
  if (pid_ < 0) fail_to_start();
  setpgid(pid_, pid_);  // whoever comes first
}

AgentProcess::~AgentProcess() {
  kill_all();
  for (const int end : {in_, out_, err_, log_})
    if (end >= 0) close(end);
}

// The group outlives its leader where that left children behind.
void AgentProcess::kill_all() {
  if (pid_ <= 0) return;
  kill(-pid_, SIGKILL);
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
    kill(-pid_, SIGKILL);
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
  kill(-pid_, SIGKILL);  // what it left behind
  pid_ = -1;
}

}  // namespace rubble
