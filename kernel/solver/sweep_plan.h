// Which contacts are solved together, and by which thread.
//
// Projected Gauss-Seidel depends on the order in which a body meets its contacts, and on no other order.
// So contacts that share no moving body may be solved together, sixteen to a batch, or by different
// threads, and the result is bit for bit that of solving them one by one: each body meets its contacts
// in the order in which they were added.
//
// Every moving body belongs to a domain, and each domain to a thread, which solves the contacts inside it
// and, of those between two domains, the ones that fall to it. The plan imagines the threads at work, each
// batch taking as long as it has rows, and a while until others see its end: whoever is free takes a batch
// of what may be solved by then (ready_contacts.h). The time of a batch is its end in this: later than the ends of all batches before it
// on its thread, and of all before it with one of its bodies. Where such a batch is another thread's, the
// thread waits until that has been solved. Times only rise, so no two threads wait for each other.
//
// Sweeps follow each other without a meeting of all threads: whoever comes first to a body in a sweep waits
// for the one who came last to it in the sweep before, length() earlier in time.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/collision/contact.h"
#include "kernel/solver/ready_contacts.h"
#include "kernel/solver/sweep_figures.h"
#include "kernel/solver/wide.h"

namespace rubble {

// What does not move has a number beyond those of the moving bodies, one for each domain and this far
// apart: threads write there what they read, and must not do so in one line of a cache.
inline constexpr int kImmovableStride = 2;

struct PlannedBatch {
  std::int32_t a[kLanes], b[kLanes];  // numbers of moving bodies, or beyond them
  std::int32_t contact[kLanes];       // -1: lane not in use
  std::int32_t rows = 0;              // points of each of its contacts
  std::int32_t used = 0;              // lanes
  std::int32_t domain = 0, time = 0;  // times start at 1
  bool waits = false, awaited = false;
  std::uint32_t owners = 0;  // domains, by bit, of bodies that this batch is the first to meet
};

// Batches that a thread solves without looking at the others.
struct SweepSegment {
  std::int32_t begin = 0, end = 0;  // in the order of SweepPlan::batch()
  std::int32_t time = 0;            // of the last batch
  std::int32_t needs = -1;          // index of what it waits for; -1: nothing
  std::uint32_t owners = 0;         // in the first sweep after they moved their bodies, also for their begin
};

class SweepPlan {
 public:
  // domains: of each moving body, less than `count`.
  void begin(int count, const std::vector<std::uint8_t>& domains);
  // a, b: numbers of moving bodies; domains.size(): does not move. Not both.
  void add(std::int32_t contact, std::int32_t a, std::int32_t b, int rows);
  void finish();
  static constexpr int cost(int rows) { return rows + kBatchCost; }  // of a batch, in rows
  SweepFigures figures() const;

  int domain_count() const { return domain_count_; }
  // Sorted by domain and time.
  int batch_count() const { return int(order_.size()); }
  const PlannedBatch& batch(int index) const { return batches_[order_[index]]; }
  const std::vector<SweepSegment>& segments(int domain) const { return segments_[domain]; }
  // The time that each domain must have reached before a segment, by domain; below zero: in the sweep before.
  const std::int32_t* needs(const SweepSegment& segment) const { return &needs_[segment.needs]; }
  static constexpr std::int32_t kAnyTime = INT32_MIN;  // nothing is waited for
  std::int32_t last_time() const { return last_time_; }
  // From the beginning of a sweep to that of the next: later than all batches.
  std::int32_t length() const { return last_time_ + 2; }
  // When the domain meets the bodies of another, the owner, for the last time; kAnyTime: never.
  std::int32_t last_visit(int domain, int owner) const {
    return last_visits_[std::size_t(domain * domain_count_ + owner)];
  }

 private:
  // What a batch costs besides its rows, friction above all, in rows; unit: 1
  static constexpr int kBatchCost = 4;
  static constexpr int kRowCounts = Contact::kMaxPoints + 1;
  using IndexList = std::vector<std::int32_t>;

  // A contact, by what it must wait for. Sides: a, b.
  struct Task {
    std::int32_t contact, body[2];
    std::int32_t before[2] = {-1, -1}, after[2] = {-1, -1};  // tasks with the same body
    std::int32_t rank = 0;
    std::int32_t ready = 0;   // the time when it may begin, once none is open
    std::int32_t batch = -1;
    std::uint8_t rows, domain = 0;
    std::uint8_t open = 0;    // tasks before it that are not planned
  };
  // A thread at work.
  struct Worker {
    ReadyContacts ready;
    IndexList waiting;        // tasks that other threads make ready later than `clock`
    std::int32_t clock = 0;
    IndexList batches;        // in order of time
  };

  int rank_tasks();
  int choose_worker() const;
  std::int32_t earliest(const Worker& worker) const;
  void offer(std::int32_t task);
  void wait_until_ready(Worker& worker);
  void plan_batch(int domain);
  void put(std::int32_t task, std::int32_t batch);
  void release_after(std::int32_t task, std::int32_t time);
  void wait_for(int batch, int other, std::int32_t time);
  void join_sweeps();
  void join_sweeps_at(const Task& task, int side);
  void add_segments(int domain);

  int domain_count_ = 1;
  std::int32_t beyond_ = 0, last_time_ = 0;
  const std::vector<std::uint8_t>* domains_ = nullptr;
  std::vector<Task> tasks_;               // in the order of adding
  IndexList last_task_;                   // of each moving body
  IndexList next_ready_;                  // by task, see ReadyContacts
  std::vector<Worker> workers_;           // by domain
  std::vector<PlannedBatch> batches_;     // in the order in which they were planned
  IndexList order_;
  IndexList needs_;                       // by batch and domain
  IndexList last_visits_;                 // by domain and owner
  std::vector<std::vector<SweepSegment>> segments_;
};

}  // namespace rubble
