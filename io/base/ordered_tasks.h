// Work that may be done in any order on several threads, and whose results are taken in the order
// in which it was given: what is written does not depend on the threads.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace rubble {

class OrderedTasks {
 public:
  // A task runs on some thread and returns what is to be done with its result; that runs on the
  // caller's thread, after the ones of all earlier tasks. Both must be copyable.
  using Commit = std::function<void()>;
  using Task = std::function<Commit()>;

  // threads: >= 1. With 1, everything runs on the caller's thread at once.
  explicit OrderedTasks(int threads);
  ~OrderedTasks();  // drops what was not committed
  OrderedTasks(const OrderedTasks&) = delete;
  OrderedTasks& operator=(const OrderedTasks&) = delete;

  // Waits while 2 tasks a thread are under way. Throws what an earlier task or commit threw.
  void add(Task task);
  // Waits for all and commits them. Throws likewise.
  void finish();

 private:
  struct Shared;
  std::unique_ptr<Shared> shared_;
};

// Threads for the compression of one recording: half of the machine's, 1 to 4. Frames are drawn on
// the same processors.
int recording_threads();

}  // namespace rubble
