#include "kernel/solver/sweep_plan.h"

#include <algorithm>

namespace rubble {
namespace {

// From the end of a batch until another thread sees it, in rows: 150 ns of 30 each; unit: 1
constexpr int kSignalCost = 5;

}  // namespace

void SweepPlan::begin(int count, const std::vector<std::uint8_t>& domains) {
  domain_count_ = count;
  domains_ = &domains;
  beyond_ = std::int32_t(domains.size());
  tasks_.clear();
  last_task_.assign(domains.size(), -1);
}

void SweepPlan::add(std::int32_t contact, std::int32_t a, std::int32_t b, int rows) {
  const std::int32_t index = std::int32_t(tasks_.size());
  Task task;
  task.contact = contact, task.rows = std::uint8_t(rows);
  task.body[0] = a, task.body[1] = b;
  for (int side = 0; side < 2; ++side) {
    const std::int32_t body = task.body[side];
    if (body == beyond_) continue;
    const std::int32_t before = last_task_[body];
    last_task_[body] = index;
    task.before[side] = before;
    if (before < 0) continue;
    tasks_[before].after[tasks_[before].body[0] == body ? 0 : 1] = index;
    ++task.open;
  }
  const int of_a = a != beyond_ ? (*domains_)[a] : (*domains_)[b];
  const int of_b = b != beyond_ ? (*domains_)[b] : of_a;
  // Those between two domains take turns.
  task.domain = std::uint8_t((contact & 1) != 0 ? of_a : of_b);
  tasks_.push_back(task);
}

// Returns how many ranks there are.
int SweepPlan::rank_tasks() {
  int highest = 0;
  for (std::size_t i = tasks_.size(); i-- > 0;) {
    Task& task = tasks_[i];
    for (std::int32_t after : task.after) {
      if (after >= 0) task.rank = std::max(task.rank, tasks_[after].rank + 1);
    }
    highest = std::max(highest, task.rank);
  }
  return highest + 1;
}

// When the worker can begin its next batch.
std::int32_t SweepPlan::earliest(const Worker& worker) const {
  if (!worker.ready.empty()) return worker.clock;
  std::int32_t first = INT32_MAX;
  for (std::int32_t task : worker.waiting) first = std::min(first, tasks_[task].ready);
  return std::max(first, worker.clock);
}

// The one that can begin first; -1: nothing is left.
int SweepPlan::choose_worker() const {
  int best = -1;
  std::int32_t first = INT32_MAX;
  for (int domain = 0; domain < domain_count_; ++domain) {
    const std::int32_t at = earliest(workers_[domain]);
    if (at < first) first = at, best = domain;
  }
  return best;
}

// To the worker of its domain.
void SweepPlan::offer(std::int32_t index) {
  const Task& task = tasks_[index];
  Worker& worker = workers_[task.domain];
  if (task.ready > worker.clock) return worker.waiting.push_back(index);
  worker.ready.add(task.rows, task.rank, index);
}

void SweepPlan::wait_until_ready(Worker& worker) {
  worker.clock = earliest(worker);
  const auto end = std::partition(worker.waiting.begin(), worker.waiting.end(), [&](std::int32_t task) {
    return tasks_[task].ready > worker.clock;
  });
  for (auto task = end; task != worker.waiting.end(); ++task) {
    worker.ready.add(tasks_[*task].rows, tasks_[*task].rank, *task);
  }
  worker.waiting.erase(end, worker.waiting.end());
}

// Another batch, which ends at that time: earlier in the sweep, or in the sweep before.
void SweepPlan::wait_for(int index, int other, std::int32_t time) {
  PlannedBatch &batch = batches_[index], &last = batches_[other];
  if (last.domain == batch.domain) return;
  std::int32_t& need = needs_[std::size_t(index * domain_count_ + last.domain)];
  need = std::max(need, time);
  batch.waits = last.awaited = true;
}

void SweepPlan::put(std::int32_t index, std::int32_t batch_index) {
  Task& task = tasks_[index];
  PlannedBatch& batch = batches_[batch_index];
  const int lane = batch.used++;
  task.batch = batch_index;
  batch.contact[lane] = task.contact;
  if (task.body[0] != beyond_) batch.a[lane] = task.body[0];
  if (task.body[1] != beyond_) batch.b[lane] = task.body[1];
  if (domain_count_ == 1) return;
  for (std::int32_t before : task.before) {
    if (before < 0) continue;
    const std::int32_t other = tasks_[before].batch;
    wait_for(batch_index, other, batches_[other].time);
  }
}

void SweepPlan::release_after(std::int32_t index, std::int32_t time) {
  for (std::int32_t after : tasks_[index].after) {
    if (after < 0) continue;
    Task& next = tasks_[after];
    const bool same = next.domain == tasks_[index].domain;
    next.ready = std::max(next.ready, same ? time : time + kSignalCost);
    if (--next.open == 0) offer(after);
  }
}

void SweepPlan::plan_batch(int domain) {
  Worker& worker = workers_[domain];
  if (!worker.waiting.empty()) wait_until_ready(worker);
  const int rows = worker.ready.choose(kLanes);
  const std::int32_t index = std::int32_t(batches_.size());
  batches_.emplace_back();
  PlannedBatch& batch = batches_.back();
  std::fill_n(batch.a, kLanes, beyond_ + kImmovableStride * domain);
  std::fill_n(batch.b, kLanes, beyond_ + kImmovableStride * domain);
  std::fill_n(batch.contact, kLanes, -1);
  batch.rows = rows;
  batch.domain = domain;
  batch.time = worker.clock + cost(rows);
  if (domain_count_ > 1) needs_.resize(needs_.size() + std::size_t(domain_count_), kAnyTime);
  std::int32_t taken[kLanes];
  const int count = std::min(kLanes, worker.ready.count(rows));
  for (int i = 0; i < count; ++i) put(taken[i] = worker.ready.take(rows), index);
  worker.batches.push_back(index);
  worker.clock = batch.time;
  last_time_ = std::max(last_time_, batch.time);
  for (int i = 0; i < count; ++i) release_after(taken[i], batch.time);
}

void SweepPlan::join_sweeps_at(const Task& task, int side) {
  const std::int32_t body = task.body[side];
  PlannedBatch& batch = batches_[task.batch];
  const int owner = (*domains_)[body];
  if (batch.domain != owner) {
    std::int32_t& visit = last_visits_[std::size_t(batch.domain * domain_count_ + owner)];
    visit = std::max(visit, batch.time);
    batch.awaited = true;
  }
  if (task.before[side] >= 0) return;
  if (batch.domain != owner) batch.owners |= 1u << owner, batch.waits = true;
  const std::int32_t last = tasks_[last_task_[body]].batch;
  wait_for(task.batch, last, batches_[last].time - length());
}

// What threads wait for from one sweep to the next.
void SweepPlan::join_sweeps() {
  last_visits_.assign(std::size_t(domain_count_ * domain_count_), kAnyTime);
  if (domain_count_ == 1) return;
  for (const Task& task : tasks_) {
    for (int side = 0; side < 2; ++side) {
      if (task.body[side] != beyond_) join_sweeps_at(task, side);
    }
  }
}

void SweepPlan::add_segments(int domain) {
  std::vector<SweepSegment>& segments = segments_[domain];
  segments.clear();
  bool fresh = true;
  for (std::int32_t index : workers_[domain].batches) {
    const PlannedBatch& batch = batches_[index];
    const std::int32_t at = std::int32_t(order_.size());
    if (fresh || batch.waits) {
      segments.push_back({at, at, 0, batch.waits ? index * domain_count_ : -1, batch.owners});
    }
    segments.back().end = at + 1;
    segments.back().time = batch.time;
    fresh = batch.awaited;
    order_.push_back(index);
  }
}

SweepFigures SweepPlan::figures() const {
  SweepFigures f;
  f.threads = domain_count_, f.contacts = int(tasks_.size()), f.batches = batch_count(), f.time = last_time_;
  for (const PlannedBatch& batch : batches_) f.work += cost(batch.rows);
  std::vector<std::int64_t> from(tasks_.size());  // from the beginning of each contact to the end of its chain
  for (std::size_t i = tasks_.size(); i-- > 0;) {
    for (const std::int32_t after : tasks_[i].after) {
      if (after >= 0) from[i] = std::max(from[i], from[after]);
    }
    from[i] += cost(tasks_[i].rows);
    f.longest = std::max(f.longest, from[i]);
    f.chain = std::max(f.chain, tasks_[i].rank + 1);
  }
  for (const std::vector<SweepSegment>& segments : segments_) {
    int waits = 0;
    for (const SweepSegment& segment : segments) waits += segment.needs >= 0 ? 1 : 0;
    f.waits = std::max(f.waits, waits);
  }
  return f;
}

void SweepPlan::finish() {
  const int ranks = rank_tasks();
  batches_.clear();
  needs_.clear();
  order_.clear();
  last_time_ = 0;
  next_ready_.resize(tasks_.size());
  workers_.resize(std::size_t(domain_count_));
  for (Worker& worker : workers_) {
    worker.ready.begin(kRowCounts, ranks, next_ready_);
    worker.clock = 0;
    worker.waiting.clear();
    worker.batches.clear();
  }
  // The first to be taken last, as each list is read from its end.
  for (std::int32_t i = std::int32_t(tasks_.size()); i-- > 0;) {
    if (tasks_[i].open == 0) offer(i);
  }
  for (int domain = choose_worker(); domain >= 0; domain = choose_worker()) plan_batch(domain);
  join_sweeps();
  segments_.resize(std::size_t(domain_count_));
  for (int domain = 0; domain < domain_count_; ++domain) add_segments(domain);
}

}  // namespace rubble
