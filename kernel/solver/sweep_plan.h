// Which contacts are solved together, and by which thread.
//
// Projected Gauss-Seidel depends on the order in which a body meets its contacts, and on no other order.
// So contacts that share no moving body may be solved together, eight to a batch, or by different
// threads, and the result is bit for bit that of solving them one by one: each body meets its contacts
// in the order in which they were added.
//
// Every moving body belongs to a domain, and each domain to a thread, which solves the contacts inside it
// and, of those between two domains, the ones that fall to it. A batch has a time: later than
// those of all batches before it on its thread, and of all before it with one of its bodies. Where such a
// batch is another thread's, the thread waits until that has been solved. Times only rise, so no two
// threads wait for each other.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/collision/contact.h"
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
};

// Batches that a thread solves without looking at the others.
struct SweepSegment {
  std::int32_t begin = 0, end = 0;  // in the order of SweepPlan::batch()
  std::int32_t time = 0;            // of the last batch
  std::int32_t needs = -1;          // index of what it waits for; -1: nothing
};

class SweepPlan {
 public:
  // domains: of each moving body, less than `count`.
  void begin(int count, const std::vector<std::uint8_t>& domains);
  // a, b: numbers of moving bodies; domains.size(): does not move. Not both.
  void add(std::int32_t contact, std::int32_t a, std::int32_t b, int rows);
  void finish();

  int domain_count() const { return domain_count_; }
  // Sorted by domain and time.
  int batch_count() const { return int(order_.size()); }
  const PlannedBatch& batch(int index) const { return batches_[order_[index]]; }
  const std::vector<SweepSegment>& segments(int domain) const { return segments_[domain]; }
  // The time that each domain must have reached before a segment, by domain; -1: any.
  const std::int32_t* needs(const SweepSegment& segment) const { return &needs_[segment.needs]; }
  std::int32_t last_time() const { return last_time_; }

 private:
  static constexpr int kRowCounts = Contact::kMaxPoints + 1;
  using BatchList = std::vector<std::int32_t>;

  int find_batch(int domain, bool between, int rows, std::int32_t after);
  void wait_for_body(int batch, std::int32_t body);
  void add_segments(int domain);

  int domain_count_ = 1;
  std::int32_t beyond_ = 0, last_time_ = 0;
  const std::vector<std::uint8_t>* domains_ = nullptr;
  std::vector<PlannedBatch> batches_;     // in the order in which they were begun
  BatchList order_;
  std::vector<BatchList> of_domain_;      // by domain, in order of time
  std::vector<BatchList> open_;           // batches with room, by domain, kind and row count
  BatchList last_batch_;                  // of each moving body
  std::vector<std::int32_t> needs_;       // by batch and domain
  std::vector<std::vector<SweepSegment>> segments_;
};

}  // namespace rubble
