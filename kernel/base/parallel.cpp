#include "kernel/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

namespace rubble {

struct ThreadPool::Shared {
  std::vector<std::thread> workers;
  std::mutex mutex;
  std::condition_variable wake, done;
  const std::function<void(int, int)>* body = nullptr;
  int count = 0, grain = 1;
  std::atomic<int> next{0};
  long round = 0;
  int busy = 0;
  bool stop = false;

  void take_all() {
    for (;;) {
      const int begin = next.fetch_add(grain);
      if (begin >= count) return;
      (*body)(begin, std::min(count, begin + grain));
    }
  }

  void work() {
    long seen = 0;
    for (;;) {
      {
        std::unique_lock<std::mutex> lock(mutex);
        wake.wait(lock, [&] { return stop || round != seen; });
        if (stop) return;
        seen = round;
      }
      take_all();
      const std::lock_guard<std::mutex> lock(mutex);
      if (--busy == 0) done.notify_one();
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
  std::unique_lock<std::mutex> lock(s.mutex);
  s.done.wait(lock, [&] { return s.busy == 0; });
}

}  // namespace rubble
