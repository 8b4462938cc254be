#include "kernel/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#if !defined(_WIN32)
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>
#endif

namespace rubble {

namespace {

using Clock = std::chrono::steady_clock;

// How long a thread looks out for the next loop, or for the others' end, before it sleeps: to wake a
// sleeping one takes a tenth of a millisecond, as long as many a loop. unit: s
constexpr double kPatience = 5e-4;
// A thread that takes longer may have lost its processor: a time slice of Linux has 3 ms and more. unit: s
constexpr double kLost = 1e-3;
// Loops run in the caller alone when others took more than this share of the time together, and so much more: from the caller, or
// from threads that it waited for. Threads of the program itself, such as a recorder's, take less, and two threads still gain.
constexpr double kBearableShare = 0.25;
constexpr double kMostLost = 0.025;  // unit: s
// They do for this time, and for twice the time before if they did not run together for as long in between. Then this much more
// is enough. unit: s
constexpr double kLeastAlone = 0.05, kMostAlone = 2, kLostAgain = 0.004;
constexpr double kLookAfter = 0.02;  // at what the caller lost; unit: s
constexpr double kSlice = 0.003;     // of Linux, where it does not tell more than how many were lost; unit: s

// How often another program took the processor from this thread; not known: 0.
long count_preemptions() {
#if defined(RUSAGE_THREAD)
  rusage usage{};
  if (getrusage(RUSAGE_THREAD, &usage) == 0) return usage.ru_nivcsw;
#endif
  return 0;
}

// How long this thread was ready and had no processor: /proc/thread-self/schedstat.
class ReadyTime {
 public:
  double read() const {  // unit: s
#if defined(__linux__)
    char text[96];
    const ssize_t size = file_ < 0 ? -1 : pread(file_, text, sizeof text - 1, 0);
    unsigned long long ran = 0, waited = 0;  // unit: ns
    if (size > 0 && (text[size] = '\0', std::sscanf(text, "%llu %llu", &ran, &waited) == 2)) return double(waited) * 1e-9;
#endif
    return double(count_preemptions()) * kSlice;
  }

#if defined(__linux__)
  ReadyTime() : file_(open("/proc/thread-self/schedstat", O_RDONLY | O_CLOEXEC)) {}
  ~ReadyTime() {
    if (file_ >= 0) close(file_);
  }
  ReadyTime(const ReadyTime&) = delete;
  ReadyTime& operator=(const ReadyTime&) = delete;

 private:
  int file_;
#endif
};

Clock::duration seconds(double s) { return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s)); }

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

// Returns what ready() says at the end.
template <typename Ready>
bool look_out(const Ready& ready) {
  if (ready()) return true;
  const Clock::time_point begin = Clock::now();
  while (!ready()) {
    if (seconds_since(begin) >= kPatience) return false;
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
  }
  return true;
}

}  // namespace

// A loop is a round. Its gate is open until the caller finds nothing left to do: a worker that comes later goes on to the
// next round, and nobody waits for it.
struct ThreadPool::Shared {
  static constexpr std::uint64_t kInside = 1, kClosed = std::uint64_t(1) << 31, kRound = std::uint64_t(1) << 32;
  static std::uint64_t round_of(std::uint64_t gate) { return gate / kRound; }
  static bool is_closed(std::uint64_t gate) { return (gate & kClosed) != 0; }
  static std::uint64_t count_inside(std::uint64_t gate) { return gate & (kClosed - 1); }

  std::vector<std::thread> workers;
  std::mutex mutex;
  std::condition_variable wake, done;
  std::atomic<int> sleepers{0};            // workers
  std::atomic<bool> caller_sleeps{false};
  std::atomic<bool> preempted{false};      // a worker, in this round
  const std::function<void(int, int)>* body = nullptr;
  int count = 0, grain = 1;
  bool once = false;  // each worker calls body once at most
  std::atomic<int> next{0};
  std::atomic<std::uint64_t> gate{kClosed};
  std::atomic<bool> stop{false};

  // Of the caller.
  Clock::time_point alone_until{}, looked{}, waited{};
  double alone = 0;  // unit: s
  double lost = 0;   // beyond the bearable share; unit: s
  const ReadyTime* caller = nullptr;
  double kept_away = 0;  // the caller, from a processor, when it looked; unit: s

  bool crowded() {
    const Clock::time_point now = Clock::now();
    if (now - looked >= seconds(kLookAfter)) look(now);
    return now < alone_until;
  }
  void look(Clock::time_point now) {
    static thread_local const ReadyTime ready;
    const double before = std::exchange(kept_away, ready.read());
    const bool same = std::exchange(caller, &ready) == &ready, together = std::exchange(looked, now) > alone_until;
    if (same && together && kept_away > before) note_wait(kept_away - before);
  }

  bool take_one() {
    const int begin = next.fetch_add(grain);
    if (begin < count) (*body)(begin, std::min(count, begin + grain));
    return begin < count;
  }
  void take_all() {
    while (take_one() && !once) {
    }
  }

  // False: the round is over. seen: becomes its number.
  bool enter(std::uint64_t& seen) {
    std::uint64_t now = gate.load();
    for (;;) {
      if (is_closed(now)) {
        seen = round_of(now);
        return false;
      }
      if (gate.compare_exchange_weak(now, now + kInside)) break;
    }
    seen = round_of(now);
    return true;
  }

  void leave() {
    const std::uint64_t before = gate.fetch_sub(kInside);
    if (!is_closed(before) || count_inside(before) > 1 || !caller_sleeps) return;
    const std::lock_guard<std::mutex> lock(mutex);
    done.notify_one();
  }

  void work() {
    long preemptions = 0;
    for (std::uint64_t seen = 0;;) {
      const auto called = [&] { return stop || round_of(gate.load()) != seen; };
      if (!look_out(called)) {
        std::unique_lock<std::mutex> lock(mutex);
        ++sleepers;
        wake.wait(lock, called);
        --sleepers;
      }
      if (stop) return;
      if (!enter(seen)) continue;
      const Clock::time_point begin = Clock::now();
      take_all();
      if (seconds_since(begin) > kLost) {
        const long before = std::exchange(preemptions, count_preemptions());
        if (preemptions > before) preempted = true;
      }
      leave();
    }
  }

  void open(int wanted, int step, bool each_once, const std::function<void(int, int)>& wanted_body) {
    body = &wanted_body, count = wanted, grain = step, once = each_once;
    next = once ? 1 : 0;
    preempted = false;
    gate = (round_of(gate.load()) + 1) * kRound;
    if (sleepers == 0) return;
    { const std::lock_guard<std::mutex> lock(mutex); }
    wake.notify_all();
  }

  // Returns when those that are inside have left.
  void close() {
    const auto left = [&] { return count_inside(gate.load()) == 0; };
    gate |= kClosed;
    if (left()) return;
    const Clock::time_point begin = Clock::now();
    if (!look_out(left)) {
      std::unique_lock<std::mutex> lock(mutex);
      caller_sleeps = true;
      done.wait(lock, left);
      caller_sleeps = false;
    }
    if (const double time = seconds_since(begin); preempted && time > kLost) note_wait(time);
  }

  void note_wait(double time) {
    const Clock::time_point now = Clock::now();
    const double together = std::chrono::duration<double>(now - alone_until).count();
    if (together < 0) return;  // it is known
    const double since = std::chrono::duration<double>(now - std::max(alone_until, std::exchange(waited, now))).count();
    lost = std::max(0.0, lost - kBearableShare * since) + time;
    if (lost < kMostLost) return;
    lost = kMostLost - kLostAgain;
    alone = std::clamp(together < alone ? 2 * alone : alone / 2, kLeastAlone, kMostAlone);
    alone_until = now + seconds(alone);
  }
};

ThreadPool::ThreadPool(int threads) : shared_(std::make_unique<Shared>()) {
  if (threads <= 0) threads = std::max(1, int(std::thread::hardware_concurrency()));
  for (int i = 1; i < threads; ++i) {
    shared_->workers.emplace_back([shared = shared_.get()] { shared->work(); });
  }
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard<std::mutex> lock(shared_->mutex);
    shared_->stop = true;
  }
  shared_->wake.notify_all();
  for (auto& worker : shared_->workers) worker.join();
}

int ThreadPool::threads() const { return int(shared_->workers.size()) + 1; }

bool ThreadPool::crowded() { return !shared_->workers.empty() && shared_->crowded(); }

void ThreadPool::note_wait(double time) { shared_->note_wait(time); }

void ThreadPool::run(int count, int grain, const std::function<void(int, int)>& body) {
  if (count <= 0) return;
  Shared& s = *shared_;
  if (s.workers.empty() || count <= grain || crowded()) return body(0, count);
  s.open(count, grain, false, body);
  s.take_all();
  s.close();
}

void ThreadPool::run_with_help(int count, const std::function<void(int)>& body) {
  Shared& s = *shared_;
  if (s.workers.empty() || count <= 1 || crowded()) return body(0);
  const std::function<void(int, int)> each = [&body](int i, int) { body(i); };
  s.open(count, 1, true, each);
  body(0);
  s.close();
}

}  // namespace rubble
