#include "kernel/solver/sweep_plan.h"

#include <algorithm>

namespace rubble {

void SweepPlan::begin(int count, const std::vector<std::uint8_t>& domains) {
  domain_count_ = count;
  domains_ = &domains;
  beyond_ = std::int32_t(domains.size());
  last_time_ = 0;
  batches_.clear();
  needs_.clear();
  of_domain_.resize(std::size_t(count));
  open_.resize(std::size_t(count * 2 * kRowCounts));
  for (BatchList& list : of_domain_) list.clear();
  for (BatchList& list : open_) list.clear();
  last_batch_.assign(domains.size(), -1);
}

// The first batch later than `after` with room for a contact of so many rows.
int SweepPlan::find_batch(int domain, bool between, int rows, std::int32_t after) {
  BatchList& open = open_[std::size_t((domain * 2 + int(between)) * kRowCounts + rows)];
  for (std::size_t i = 0; i < open.size(); ++i) {
    const int index = open[i];
    if (batches_[index].time <= after) continue;
    if (batches_[index].used + 1 == kLanes) open.erase(open.begin() + std::ptrdiff_t(i));
    return index;
  }
  PlannedBatch batch;
  std::fill_n(batch.a, kLanes, beyond_ + kImmovableStride * domain);
  std::fill_n(batch.b, kLanes, beyond_ + kImmovableStride * domain);
  std::fill_n(batch.contact, kLanes, -1);
  batch.rows = rows;
  batch.domain = domain;
  BatchList& list = of_domain_[domain];
  batch.time = std::max(list.empty() ? 0 : batches_[list.back()].time, after) + 1;
  last_time_ = std::max(last_time_, batch.time);
  const int index = int(batches_.size());
  list.push_back(index);
  open.push_back(index);
  batches_.push_back(batch);
  if (domain_count_ > 1) needs_.resize(needs_.size() + std::size_t(domain_count_), -1);
  return index;
}

// Where the body was solved last, or belongs, on another thread.
void SweepPlan::wait_for_body(int index, std::int32_t body) {
  PlannedBatch& batch = batches_[index];
  const int last = last_batch_[body];
  const int domain = last >= 0 ? batches_[last].domain : (*domains_)[body];
  if (domain == batch.domain) return;
  std::int32_t& need = needs_[std::size_t(index * domain_count_ + domain)];
  need = std::max(need, last >= 0 ? batches_[last].time : 0);
  batch.waits = true;
  if (last >= 0) batches_[last].awaited = true;
}

void SweepPlan::add(std::int32_t contact, std::int32_t a, std::int32_t b, int rows) {
  std::int32_t after = 0;
  for (std::int32_t body : {a, b}) {
    if (body != beyond_ && last_batch_[body] >= 0) {
      after = std::max(after, batches_[last_batch_[body]].time);
    }
  }
  const int of_a = a != beyond_ ? (*domains_)[a] : (*domains_)[b];
  const int of_b = b != beyond_ ? (*domains_)[b] : of_a;
  // Those between two domains take turns.
  const int domain = (contact & 1) != 0 ? of_a : of_b;
  const int index = find_batch(domain, of_a != of_b, rows, after);
  PlannedBatch& batch = batches_[index];
  const int lane = batch.used++;
  batch.contact[lane] = contact;
  if (a != beyond_) batch.a[lane] = a;
  if (b != beyond_) batch.b[lane] = b;
  for (std::int32_t body : {a, b}) {
    if (body == beyond_) continue;
    if (domain_count_ > 1) wait_for_body(index, body);
    last_batch_[body] = index;
  }
}

void SweepPlan::add_segments(int domain) {
  std::vector<SweepSegment>& segments = segments_[domain];
  segments.clear();
  bool fresh = true;
  for (std::int32_t index : of_domain_[domain]) {
    const PlannedBatch& batch = batches_[index];
    const std::int32_t at = std::int32_t(order_.size());
    if (fresh || batch.waits) {
      segments.push_back({at, at, 0, batch.waits ? index * domain_count_ : -1});
    }
    segments.back().end = at + 1;
    segments.back().time = batch.time;
    fresh = batch.awaited;
    order_.push_back(index);
  }
}

void SweepPlan::finish() {
  order_.clear();
  segments_.resize(std::size_t(domain_count_));
  for (int domain = 0; domain < domain_count_; ++domain) add_segments(domain);
}

}  // namespace rubble
