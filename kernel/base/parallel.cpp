#include "kernel/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#if !defined(_WIN32)
#include <sys/resource.h>
#endif

namespace rubble {

namespace {

using Clock = std::chrono::steady_clock;

// How long a thread looks out for the next loop, or for the others' end, before it sleeps: to wake a
// sleeping one takes a tenth of a millisecond, as long as many a loop. unit: s
constexpr double kPatience = 5e-4;
// A thread that takes longer may have lost its processor: a time slice of Linux has 3 ms and more. unit: s
constexpr double kLost = 1e-3;
// Loops run in the caller alone for this time, and for twice the time before if that was not long ago: a try costs a time
// slice. unit: s
constexpr double kLeastAlone = 0.02, kMostAlone = 2;

// How often another program took the processor from this thread; not known: 0.
long count_preemptions() {
#if defined(RUSAGE_THREAD)
  rusage usage{};
  if (getrusage(RUSAGE_THREAD, &usage) == 0) return usage.ru_nivcsw;
#endif
  return 0;
}

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
  std::atomic<int> next{0};
  std::atomic<std::uint64_t> gate{kClosed};
  std::atomic<bool> stop{false};

  // Of the caller.
  Clock::time_point alone_until{}, tried_until{};
  double alone = kLeastAlone;  // unit: s

  void take_all() {
    for (;;) {
      const int begin = next.fetch_add(grain);
      if (begin >= count) return;
      (*body)(begin, std::min(count, begin + grain));
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

  void open(int wanted, int step, const std::function<void(int, int)>& wanted_body) {
    body = &wanted_body, count = wanted, grain = step;
    next = 0;
    preempted = false;
    gate = (round_of(gate.load()) + 1) * kRound;
    if (sleepers == 0) return;
    { const std::lock_guard<std::mutex> lock(mutex); }
    wake.notify_all();
  }

  void run(int wanted, int step, const std::function<void(int, int)>& wanted_body) {
    open(wanted, step, wanted_body);
    take_all();
    close();
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
    if (preempted && seconds_since(begin) > kLost) note_crowded();
  }

  void note_crowded() {
    const Clock::time_point now = Clock::now();
    alone = now < tried_until ? std::min(kMostAlone, 2 * alone) : kLeastAlone;
    alone_until = now + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(alone));
    tried_until = now + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(4 * alone));
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

bool ThreadPool::crowded() const { return !shared_->workers.empty() && Clock::now() < shared_->alone_until; }

void ThreadPool::note_crowded() { shared_->note_crowded(); }

void ThreadPool::run(int count, int grain, const std::function<void(int, int)>& body) {
  if (count <= 0) return;
  Shared& s = *shared_;
  if (s.workers.empty() || count <= grain || crowded()) return body(0, count);
  s.run(count, grain, body);
}

void ThreadPool::run_together(int count, const std::function<void(int)>& body) {
  const std::function<void(int, int)> each = [&body](int begin, int end) {
    for (int i = begin; i < end; ++i) body(i);
  };
  if (count <= 1) return each(0, count);
  shared_->run(count, 1, each);
}

}  // namespace rubble
