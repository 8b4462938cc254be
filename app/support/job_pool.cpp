#include "app/support/job_pool.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <map>
#include <system_error>
#include <thread>

#include "app/support/print.h"
#include "app/support/stop.h"
#include "io/base/atomic_file.h"
#include "kernel/base/error.h"
#include "kernel/base/system/file_sandbox.h"
#include "kernel/base/system/thread_count.h"
#include "kernel/base/system/output_files.h"

namespace rubble {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kGrace = std::chrono::seconds(60);  // to stop between two steps and write what is done

struct Running {
  std::size_t index;
  Clock::time_point started;
  std::string log;
};

std::string signal_words(int signal) {
  return "signal " + std::to_string(signal) + " (" + strsignal(signal) + ")";
}

// What the job itself cannot say any more. A log that cannot be written is no reason to fail.
void note_death(const std::string& log, int status) {
  if (!WIFSIGNALED(status)) return;
  try {
    AppendedFile(log).append("killed by " + signal_words(WTERMSIG(status)) +
                             (WTERMSIG(status) == SIGKILL ? ": was memory short?" : "") + "\n");
  } catch (const std::runtime_error&) {
  }
}

// Only calls that are safe between fork and exec.
[[noreturn]] void become_program(const char* program, char* const* arguments, int log,
                                 pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(127);
  const int nothing = open("/dev/null", O_RDONLY);
  if (nothing >= 0) dup2(nothing, STDIN_FILENO);
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  // A terminal sends Ctrl-C to all; only this process decides what it means.
  setpgid(0, 0);
  execv(program, arguments);
  _exit(127);
}

// What this process may not read or write, its jobs may not either.
std::vector<std::string> sandbox_arguments() {
  const std::string folder = sandbox_folder();
  return folder.empty() ? std::vector<std::string>() : std::vector<std::string>{"--sandbox", folder};
}

pid_t start(const Job& job) {
  std::error_code failed;
  const std::string program = std::filesystem::read_symlink("/proc/self/exe", failed).string();
  if (failed) {
    throw RunError("cannot start jobs: /proc/self/exe does not give the folder of this program (" + failed.message() +
                   "): mount /proc");
  }
  std::vector<char*> arguments{const_cast<char*>(program.c_str())};
  for (const std::string& argument : job.arguments)
    arguments.push_back(const_cast<char*>(argument.c_str()));
  const std::vector<std::string> sandbox = sandbox_arguments();
  for (const std::string& argument : sandbox) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  const int log = create_log_file(job.log);
  const pid_t parent = getpid(), child = fork();
  if (child == 0) become_program(program.c_str(), arguments.data(), log, parent);
  close(log);
  if (child < 0)
    throw RunError("cannot start a process: " + std::generic_category().message(errno));
  return child;
}

int exit_code_of(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

class Pool {
 public:
  ~Pool() {
    stop_all();
    const auto end = Clock::now() + kGrace;
    for (const auto& item : running_) wait_until(item.first, end);
  }

  void begin(const Job& job, std::size_t index) {
    running_[start(job)] = {index, Clock::now(), job.log};
  }
  std::size_t size() const { return running_.size(); }

  // One that somebody suspended must run to see its signal.
  void stop_all() {
    for (const auto& item : running_) kill(item.first, SIGTERM), kill(item.first, SIGCONT);
  }
  void kill_all() {
    for (const auto& item : running_) kill(item.first, SIGKILL);
  }

  // Waits for one of ours to end.
  std::pair<std::size_t, JobResult> wait() {
    for (;;) {
      if (stop_requested() && !stopping_) {
        stop_all();
        stopping_ = true;
        stop_end_ = Clock::now() + kGrace;
      }
      if (stopping_ && Clock::now() > stop_end_) kill_all();
      for (const auto& [pid, job] : running_) {
        int status = 0;
        if (waitpid(pid, &status, WNOHANG | WUNTRACED) != pid) continue;
        if (WIFSTOPPED(status)) {
          print_err("process %d was suspended by %s; `kill -CONT %d` continues it\n",
                    int(pid), signal_words(WSTOPSIG(status)).c_str(), int(pid));
          continue;
        }
        note_death(job.log, status);
        const std::chrono::duration<double> took = Clock::now() - job.started;
        const std::pair<std::size_t, JobResult> ended{job.index,
                                                      {exit_code_of(status), took.count()}};
        running_.erase(pid);
        return ended;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }

 private:
  static void wait_until(pid_t pid, Clock::time_point end) {
    while (waitpid(pid, nullptr, WNOHANG) == 0) {
      if (Clock::now() > end) kill(pid, SIGKILL);
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }

  std::map<pid_t, Running> running_;
  bool stopping_ = false;
  Clock::time_point stop_end_{};
};

}  // namespace

void run_jobs(const std::vector<Job>& jobs, int at_once,
              const std::function<bool(std::size_t, const JobResult&)>& ended) {
  Pool pool;
  std::size_t next = 0;
  bool more = true;
  while (true) {
    while (more && !stop_requested() && next < jobs.size() && int(pool.size()) < at_once) {
      pool.begin(jobs[next], next);
      ++next;
    }
    if (pool.size() == 0) return;
    const auto [index, result] = pool.wait();
    more = ended(index, result) && more;
  }
}

JobShape choose_job_shape(int at_once, int threads) {
  const int processors = default_thread_count();
  JobShape shape;
  shape.at_once = at_once > 0 ? at_once : processors;
  shape.threads = threads > 0 ? threads : std::max(1, processors / shape.at_once);
  return shape;
}

std::string tail_of_log(const std::string& log, int lines) {
  std::string text;
  try {
    text = read_whole_file(log);
  } catch (const InputError&) {
    return "";
  }
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::size_t begin = text.size();
  for (int i = 0; i < lines && begin > 0 && begin != std::string::npos; ++i)
    begin = begin == 0 ? 0 : text.rfind('\n', begin - 1);
  return begin == std::string::npos ? text : text.substr(begin == 0 ? 0 : begin + 1);
}

}  // namespace rubble
