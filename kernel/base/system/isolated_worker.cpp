#include "kernel/base/system/isolated_worker.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstring>
#include <fstream>
#include <mutex>
#include <new>
#include <optional>
#include <system_error>

#include "kernel/base/error.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define RUBBLE_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define RUBBLE_SANITIZED 1
#endif
#endif

#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
#include <sanitizer/common_interface_defs.h>
#endif

namespace rubble {
namespace {

using Clock = std::chrono::steady_clock;

#ifdef RUBBLE_SANITIZED
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
constexpr bool kFuzzing = true;
#else
constexpr bool kFuzzing = false;
#endif

// Holds that come while a thread waits to fork wait for it.
struct ForkGate {
  std::mutex mutex;
  std::condition_variable changed;
  int holds = 0, forks = 0;
};
ForkGate& fork_gate() {
  static ForkGate gate;
  return gate;
}

pid_t fork_without_holds() {
  ForkGate& gate = fork_gate();
  std::unique_lock<std::mutex> lock(gate.mutex);
  ++gate.forks;
  gate.changed.wait(lock, [&] { return gate.holds == 0; });
  const pid_t child = fork();
  --gate.forks;
  if (child != 0) gate.changed.notify_all();  // nobody waits in the child
  return child;
}

enum class Answer : char { result = 'R', refused = 'D', no_memory = 'M', failed = 'E' };

template <typename T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <typename T>
void take(std::string_view& bytes, T& value) {
  if (bytes.size() < sizeof value) return bytes.remove_prefix(bytes.size());
  std::memcpy(&value, bytes.data(), sizeof value);
  bytes.remove_prefix(sizeof value);
}

std::uint64_t address_space_in_use() {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * std::uint64_t(sysconf(_SC_PAGESIZE));
}

void limit(__rlimit_resource resource, std::uint64_t soft, std::uint64_t hard) {
  rlimit now{};
  if (getrlimit(resource, &now) != 0) return;
  now.rlim_max = std::min<rlim_t>(now.rlim_max, hard);
  now.rlim_cur = std::min<rlim_t>(now.rlim_max, soft);
  setrlimit(resource, &now);
}

// in_use: measured before the fork.
void hold_limits(const ImportLimits& limits, std::uint64_t in_use) {
  limit(RLIMIT_CORE, 0, 0);
  limit(RLIMIT_FSIZE, 0, 0);  // it writes no file
  if (!kSanitized || kFuzzing) limit(RLIMIT_AS, in_use + limits.memory, in_use + limits.memory);
}

// From now on so many seconds more.
void limit_cpu(int seconds) {
  if (kFuzzing) {
    const itimerval fiftieth{{}, {0, 20'000}};
    setitimer(ITIMER_PROF, &fiftieth, nullptr);
    return;
  }
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  rlimit now{};
  if (getrlimit(RLIMIT_CPU, &now) != 0) return;
  const auto end = rlim_t(used.ru_utime.tv_sec + used.ru_stime.tv_sec + seconds + 1);
  now.rlim_cur = std::min(now.rlim_max, end);
  setrlimit(RLIMIT_CPU, &now);
}

// What an allocator says of a damaged heap would only confuse; a sanitizer's report would not.
void hush() {
  constexpr bool kReport = kSanitized && !kFuzzing;  // an importer's crash is expected there
  const int nothing = kReport ? -1 : open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nothing >= 0) dup2(nothing, STDERR_FILENO);
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
  __sanitizer_set_death_callback([] { _exit(1); });  // libFuzzer's would write the input down
#endif
}

// False: nobody is there to take it. (No signal then, as write() would send.)
bool send_all(int socket, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t sent = send(socket, data, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    data += sent;
    size -= std::size_t(sent);
  }
  return true;
}

// A byte of kind, a u64 of size, and the bytes.
bool send_message(int socket, Answer kind, const std::string& bytes) {
  std::string head(1, char(kind));
  put(head, std::uint64_t(bytes.size()));
  return send_all(socket, head.data(), head.size()) &&
         send_all(socket, bytes.data(), bytes.size());
}

enum class Received { all, closed, late };

// Exactly `size` bytes, appended.
Received receive(int socket, std::uint64_t size, Clock::time_point end, std::string& bytes) {
  std::string block(std::min<std::uint64_t>(size, 1 << 18), '\0');
  while (size > 0) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    pollfd ready{socket, POLLIN, 0};
    const int found = left > 0 ? poll(&ready, 1, int(std::min<std::int64_t>(left, 60000))) : 0;
    if (found == 0 && Clock::now() >= end) return Received::late;
    if (found <= 0) continue;
    const ssize_t count = recv(socket, block.data(), std::min<std::uint64_t>(size, block.size()), 0);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return Received::closed;
    bytes.append(block.data(), std::size_t(count));
    size -= std::uint64_t(count);
  }
  return Received::all;
}

Received receive_message(int socket, Clock::time_point end, Answer& kind, std::string& bytes) {
  std::string head;
  const Received received = receive(socket, 1 + sizeof(std::uint64_t), end, head);
  if (received != Received::all) return received;
  std::string_view rest(head);
  char first = 0;
  std::uint64_t size = 0;
  take(rest, first);
  take(rest, size);
  kind = Answer(first);
  return receive(socket, size, end, bytes);
}

void put_text(std::string& bytes, const std::string& text) {
  put(bytes, std::uint64_t(text.size()));
  bytes += text;
}

std::string pack(const InputError& error) {
  std::string bytes;
  for (const Diagnostic& d : error.diagnostics()) {
    put(bytes, std::int32_t(d.line));
    for (const std::string* text : {&d.file, &d.key, &d.message, &d.expected, &d.found, &d.hint})
      put_text(bytes, *text);
  }
  return bytes;
}

std::vector<Diagnostic> unpack(std::string_view bytes) {
  std::vector<Diagnostic> all;
  while (!bytes.empty()) {
    Diagnostic d;
    std::int32_t line = 0;
    take(bytes, line);
    d.line = line;
    for (std::string* text : {&d.file, &d.key, &d.message, &d.expected, &d.found, &d.hint}) {
      std::uint64_t size = 0;
      take(bytes, size);
      *text = bytes.substr(0, size);
      bytes.remove_prefix(std::min<std::size_t>(size, bytes.size()));
    }
    all.push_back(std::move(d));
  }
  return all;
}

// Every file but the socket, which becomes number 3.
void close_others(int& socket) {
  if (socket != 3 && dup2(socket, 3) == 3) socket = 3;
  close_range(4, ~0u, 0);
}

bool answer_one(int socket, const IsolatedWorker::Handler& handler, const std::string& request) {
  try {
    return send_message(socket, Answer::result, handler(request));
  } catch (const InputError& error) {
    return send_message(socket, Answer::refused, pack(error));
  } catch (const std::bad_alloc&) {
    return send_message(socket, Answer::no_memory, "");
  } catch (const std::exception& error) {
    return send_message(socket, Answer::failed, error.what());
  } catch (...) {
    return send_message(socket, Answer::failed, "it gave up without a reason");
  }
}

[[noreturn]] void serve(int socket, const IsolatedWorker::Handler& handler,
                        const ImportLimits& limits) {
  for (;;) {
    std::string request;
    Answer kind{};
    if (receive_message(socket, Clock::time_point::max(), kind, request) != Received::all) break;
    limit_cpu(limits.cpu_seconds);
    if (!answer_one(socket, handler, request)) break;
  }
  _exit(0);
}

// shared: a folder that counts as one, with all below it.
std::string folder_of(const std::string& path, const std::string& shared) {
  if (!shared.empty() && path.compare(0, shared.size(), shared) == 0) return shared;
  return path.substr(0, path.rfind('/') + 1);
}

std::string death_words(int status, const ImportLimits& limits) {
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (signal == SIGXCPU || signal == SIGKILL)
    return "reading it takes more than " + std::to_string(limits.cpu_seconds) + " s";
  return "the importer crashed" +
         (signal ? " (" + std::string(strsignal(signal)) + ")" : std::string());
}

[[noreturn]] void fail(const char* what) {
  throw RunError(std::string("cannot ") + what + ": " + std::generic_category().message(errno));
}

}  // namespace

ForkHold::ForkHold() {
  ForkGate& gate = fork_gate();
  std::unique_lock<std::mutex> lock(gate.mutex);
  gate.changed.wait(lock, [&] { return gate.forks == 0; });
  ++gate.holds;
}

ForkHold::~ForkHold() {
  ForkGate& gate = fork_gate();
  const std::lock_guard<std::mutex> lock(gate.mutex);
  if (--gate.holds == 0) gate.changed.notify_all();
}

IsolatedWorker::IsolatedWorker(std::string what, Handler handler, const ImportLimits& limits)
    : what_(std::move(what)), handler_(std::move(handler)), limits_(limits) {}

IsolatedWorker::~IsolatedWorker() { stop(); }

void IsolatedWorker::start() {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) fail("make a socket");
  const std::uint64_t in_use = address_space_in_use();
  const pid_t parent = getpid();
  child_ = fork_without_holds();
  if (child_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(1);
    close_others(ends[1]);
    hold_limits(limits_, in_use);
    hush();
    serve(ends[1], handler_, limits_);
  }
  close(ends[1]);
  socket_ = ends[0];
  if (child_ < 0) {
    stop();
    fail("start a process");
  }
}

void IsolatedWorker::stop() {
  if (socket_ >= 0) close(socket_);
  socket_ = -1;
  if (child_ <= 0) return;
  kill(child_, SIGKILL);
  wait();
}

int IsolatedWorker::wait() {
  int status = 0;
  while (waitpid(child_, &status, 0) < 0 && errno == EINTR) {
  }
  child_ = -1;
  return status;
}

std::string IsolatedWorker::ask(const std::string& path, const std::string& request) {
  const std::string folder = folder_of(path, shared_);
  if (folder_ != folder) stop();
  folder_ = folder;
  if (child_ <= 0) start();
  bool answered = false;
  try {
    return answer_of(path, request, answered);
  } catch (...) {
    if (!kFuzzing || !answered) stop();
    throw;
  }
}

std::string IsolatedWorker::answer_of(const std::string& path, const std::string& request,
                                      bool& answered) {
  const auto refuse = [&](const std::string& reason) {
    throw InputError({path, 0, "", "cannot be read as a " + what_ + ": " + reason, "", "",
                      "the file is damaged or hostile; export it anew"});
  };
  const auto end = Clock::now() + std::chrono::seconds(limits_.wall_seconds);
  std::string answer;
  Answer kind{};
  Received received = Received::closed;
  if (send_message(socket_, Answer::result, request))
    received = receive_message(socket_, end, kind, answer);
  answered = received == Received::all;
  if (received == Received::late)
    refuse("reading it takes more than " + std::to_string(limits_.wall_seconds) + " s");
  if (received == Received::closed) refuse(death_words(wait(), limits_));
  if (kind == Answer::refused) throw InputError(unpack(answer));
  if (kind == Answer::no_memory)
    refuse("it needs more than " + std::to_string(limits_.memory >> 20) + " MiB of memory");
  if (kind == Answer::failed) refuse(answer);
  return answer;
}

std::string run_isolated(const std::string& path, const std::string& what,
                         const std::function<std::string()>& work, const ImportLimits& limits) {
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
  static const std::function<std::string()>* now = nullptr;  // the child keeps what it was at its fork
  static IsolatedWorker worker(what, [](const std::string&) { return (*now)(); }, limits);
  now = &work;
  return worker.ask(path, "");
#else
  return IsolatedWorker(what, [&work](const std::string&) { return work(); }, limits).ask(path, "");
#endif
}

}  // namespace rubble
