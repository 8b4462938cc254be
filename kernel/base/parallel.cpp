#include "kernel/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

namespace rubble {

namespace {

// How long a thread looks out for the next loop, or for the others' end, before it sleeps: to wake a
// sleeping one takes a tenth of a millisecond, as long as many a loop. unit: s
constexpr double kPatience = 5e-4;
// Where it is in vain, other programs have the processors: then it sleeps at once, and tries again
// only every so often.
constexpr int kTryAgain = 200;

class LookOut {
 public:
  // Returns what ready() says at the end.
  template <typename Ready>
  bool operator()(const Ready& ready) {
    if (ready()) return true;
    if (pause_ > 0) {
      --pause_;
      return false;
    }
    const auto begin = std::chrono::steady_clock::now();
    while (!ready()) {
      const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - begin;
      if (waited.count() < kPatience) continue;
      pause_ = kTryAgain;
      return false;
    }
    return true;
  }

 private:
  int pause_ = 0;
};

}  // namespace

struct ThreadPool::Shared {
  std::vector<std::thread> workers;
  LookOut caller;
  std::mutex mutex;
  std::condition_variable wake, done;
  const std::function<void(int, int)>* body = nullptr;
  int count = 0, grain = 1;
  std::atomic<int> next{0}, busy{0};
  std::atomic<long> round{0};
  std::atomic<bool> stop{false};

  void take_all() {
    for (;;) {
      const int begin = next.fetch_add(grain);
      if (begin >= count) return;
      (*body)(begin, std::min(count, begin + grain));
    }
  }

  void work() {
    LookOut look_out;
    for (long seen = 0;; ++seen) {
      const auto called = [&] { return stop || round != seen; };
      if (!look_out(called)) {
        std::unique_lock<std::mutex> lock(mutex);
        wake.wait(lock, called);
      }
      if (stop) return;
      take_all();
      if (busy.fetch_sub(1) > 1) continue;
      const std::lock_guard<std::mutex> lock(mutex);
      done.notify_one();
    }
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

void ThreadPool::run(int count, int grain, const std::function<void(int, int)>& body) {
  if (count <= 0) return;
  Shared& s = *shared_;
  if (s.workers.empty() || count <= grain) return body(0, count);
  {
    const std::lock_guard<std::mutex> lock(s.mutex);
    s.body = &body;
    s.count = count;
    s.grain = grain;
    s.next = 0;
    s.busy = int(s.workers.size());
    ++s.round;
  }
  s.wake.notify_all();
  s.take_all();
  const auto finished = [&] { return s.busy == 0; };
  if (s.caller(finished)) return;
  std::unique_lock<std::mutex> lock(s.mutex);
  s.done.wait(lock, finished);
}

}  // namespace rubble
