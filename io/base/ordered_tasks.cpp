#include "io/base/ordered_tasks.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "kernel/base/system/thread_count.h"

namespace rubble {

struct OrderedTasks::Shared {
  struct Job {
    Task task;
    Commit commit;
    std::exception_ptr error;
    bool done = false;
  };

  std::size_t limit = 1;
  std::vector<std::thread> threads;
  std::mutex mutex;
  std::condition_variable wake_workers, wake_caller;
  bool stopped = false;
  std::deque<std::shared_ptr<Job>> waiting;  // not yet begun
  std::deque<std::shared_ptr<Job>> ordered;  // not yet committed, oldest first

  ~Shared() {
    {
      const std::lock_guard lock(mutex);
      stopped = true;
    }
    wake_workers.notify_all();
    for (std::thread& thread : threads) thread.join();
  }

  static void run(Job& job) {
    try {
      job.commit = job.task();
    } catch (...) {
      job.error = std::current_exception();
    }
    job.task = nullptr;  // frees what it holds
  }

  void work() {
    std::unique_lock lock(mutex);
    while (true) {
      wake_workers.wait(lock, [&] { return stopped || !waiting.empty(); });
      if (stopped) return;
      const std::shared_ptr<Job> job = waiting.front();
      waiting.pop_front();
      lock.unlock();
      run(*job);
      lock.lock();
      job->done = true;
      wake_caller.notify_one();
    }
  }

  // Commits the oldest ones until at most `left` are under way.
  void commit_until(std::size_t left) {
    while (ordered.size() > left || (!ordered.empty() && is_done(*ordered.front()))) {
      const std::shared_ptr<Job> job = ordered.front();
      {
        std::unique_lock lock(mutex);
        wake_caller.wait(lock, [&] { return job->done; });
      }
      ordered.pop_front();
      if (job->error) std::rethrow_exception(job->error);
      job->commit();
    }
  }

  bool is_done(const Job& job) {
    const std::lock_guard lock(mutex);
    return job.done;
  }
};

OrderedTasks::OrderedTasks(int threads) : shared_(std::make_unique<Shared>()) {
  if (threads <= 1) return;
  shared_->limit = 2 * static_cast<std::size_t>(threads);
  for (int i = 0; i < threads; ++i)
    shared_->threads.emplace_back([shared = shared_.get()] { shared->work(); });
}

OrderedTasks::~OrderedTasks() = default;

void OrderedTasks::add(Task task) {
  if (shared_->threads.empty()) {
    task()();
    return;
  }
  shared_->commit_until(shared_->limit - 1);
  auto job = std::make_shared<Shared::Job>();
  job->task = std::move(task);
  shared_->ordered.push_back(job);
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->waiting.push_back(std::move(job));
  }
  shared_->wake_workers.notify_one();
}

void OrderedTasks::finish() { shared_->commit_until(0); }

int recording_threads() {
  return std::clamp(default_thread_count() / 2, 1, 4);
}

}  // namespace rubble
