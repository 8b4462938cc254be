// SweepPlan: whoever solves what, each body meets its contacts in the order in which they were added.
#include <gtest/gtest.h>

#include <set>
#include <thread>
#include <vector>

#include "kernel/base/random.h"
#include "kernel/solver/sweep_plan.h"
#include "kernel/solver/sweep_progress.h"
#include "kernel/world/world.h"
#include "scenes.h"

namespace rubble {
namespace sweep_plan_test {

constexpr int kBodies = 300, kContacts = 2000;

struct Touch {
  std::int32_t a, b;  // b may be kBodies: does not move
  int rows;
};

// Bodies in a row that touch others near them.
std::vector<Touch> make_touches() {
  RandomStream random(5, "touches");
  std::vector<Touch> touches;
  for (int i = 0; i < kContacts; ++i) {
    const auto a = std::int32_t(random.below(kBodies));
    const std::int32_t b = std::min<std::int32_t>(kBodies, a + 1 + std::int32_t(random.below(40)));
    touches.push_back({a, b, 1 + int(random.below(6))});
  }
  return touches;
}

std::vector<std::uint8_t> make_domains(int count) {
  std::vector<std::uint8_t> domains;
  for (int i = 0; i < kBodies; ++i) domains.push_back(std::uint8_t(i * count / kBodies));
  return domains;
}

// What each body has met, such that any other order gives another number.
using History = std::vector<std::uint64_t>;
void meet(History& history, std::int32_t body, std::uint64_t contact, std::uint64_t other) {
  if (body < kBodies) history[body] = history[body] * 0x9E3779B97F4A7C15u + contact * 31 + other;
}
void meet_both(History& history, std::int32_t a, std::int32_t b, std::int32_t contact) {
  const std::uint64_t of_a = a < kBodies ? history[a] : 0, of_b = b < kBodies ? history[b] : 0;
  meet(history, a, std::uint64_t(contact), of_b);
  meet(history, b, std::uint64_t(contact), of_a);
}

void wait_for(const SweepProgress& progress, int thread, std::int64_t point) {
  while (!progress.reached(thread, point)) std::this_thread::yield();
}

// One thread in one sweep. begins: all bodies were moved by their owners before it.
void sweep(const SweepPlan& plan, int domain, std::int64_t start, bool begins, SweepProgress& progress,
           History& history) {
  progress.reach(domain, start);
  for (const SweepSegment& segment : plan.segments(domain)) {
    for (int other = 0; segment.needs >= 0 && other < plan.domain_count(); ++other) {
      const std::int32_t need = plan.needs(segment)[other];
      if (need != SweepPlan::kAnyTime) wait_for(progress, other, start + need);
      if (begins && (segment.owners >> other & 1) != 0) wait_for(progress, other, start);
    }
    for (int i = segment.begin; i < segment.end; ++i) {
      const PlannedBatch& batch = plan.batch(i);
      for (int lane = 0; lane < batch.used; ++lane) {
        meet_both(history, batch.a[lane], batch.b[lane], batch.contact[lane]);
      }
    }
    progress.reach(domain, start + segment.time);
  }
}

// The owner moves his bodies, after all others have left them.
void move(const SweepPlan& plan, int domain, std::int64_t start, const std::vector<std::uint8_t>& domains,
          SweepProgress& progress, History& history) {
  for (int other = 0; other < plan.domain_count(); ++other) {
    const std::int32_t visit = plan.last_visit(other, domain);
    if (visit != SweepPlan::kAnyTime) wait_for(progress, other, start - plan.length() + visit);
  }
  for (int body = 0; body < kBodies; ++body) {
    if (domains[std::size_t(body)] == domain) meet(history, body, kContacts, 0);
  }
}

// Bodies are moved before every second sweep, and nobody meets in between.
TEST(SweepPlan, EveryBodyMeetsItsContactsInOrderWithAnyNumberOfThreads) {
  const std::vector<Touch> touches = make_touches();
  constexpr int kSweeps = 40;
  History expected(kBodies, 1);
  for (int k = 0; k < kSweeps; ++k) {
    for (int body = 0; k % 2 == 0 && body < kBodies; ++body) meet(expected, body, kContacts, 0);
    for (int i = 0; i < kContacts; ++i) meet_both(expected, touches[i].a, touches[i].b, i);
  }
  for (int count : {1, 2, 3, 7}) {
    const std::vector<std::uint8_t> domains = make_domains(count);
    SweepPlan plan;
    plan.begin(count, domains);
    for (int i = 0; i < kContacts; ++i) plan.add(i, touches[i].a, touches[i].b, touches[i].rows);
    plan.finish();
    History history(kBodies, 1);
    SweepProgress progress(count);
    std::vector<std::thread> threads;
    for (int domain = 0; domain < count; ++domain) {
      threads.emplace_back([&, domain] {
        for (int k = 0; k < kSweeps; ++k) {
          const std::int64_t start = std::int64_t(k) * plan.length();
          if (k % 2 == 0) move(plan, domain, start, domains, progress, history);
          sweep(plan, domain, start, k % 2 == 0, progress, history);
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(history, expected) << count << " threads";
  }
}

TEST(SweepPlan, EveryContactIsInOneLaneAndNoBatchHasABodyTwice) {
  const std::vector<Touch> touches = make_touches();
  const std::vector<std::uint8_t> domains = make_domains(3);
  SweepPlan plan;
  plan.begin(3, domains);
  for (int i = 0; i < kContacts; ++i) plan.add(i, touches[i].a, touches[i].b, touches[i].rows);
  plan.finish();
  std::set<std::int32_t> contacts;
  int lanes = 0;
  for (int i = 0; i < plan.batch_count(); ++i) {
    const PlannedBatch& batch = plan.batch(i);
    std::set<std::int32_t> bodies;
    for (int lane = 0; lane < batch.used; ++lane, ++lanes) {
      contacts.insert(batch.contact[lane]);
      EXPECT_EQ(touches[std::size_t(batch.contact[lane])].rows, batch.rows);
      for (std::int32_t body : {batch.a[lane], batch.b[lane]}) {
        if (body >= kBodies) continue;
        EXPECT_TRUE(bodies.insert(body).second) << "batch " << i;
      }
    }
  }
  EXPECT_EQ(contacts.size(), std::size_t(kContacts));
  EXPECT_EQ(lanes, kContacts);
}

TEST(SweepPlan, FiguresSayWhatThreadsGain) {
  const std::vector<Touch> touches = make_touches();
  std::int64_t alone = 0;
  for (int count : {1, 2, 7}) {
    const std::vector<std::uint8_t> domains = make_domains(count);
    SweepPlan plan;
    plan.begin(count, domains);
    for (int i = 0; i < kContacts; ++i) plan.add(i, touches[i].a, touches[i].b, touches[i].rows);
    plan.finish();
    const SweepFigures f = plan.figures();
    EXPECT_EQ(f.threads, count);
    EXPECT_EQ(f.contacts, kContacts);
    EXPECT_EQ(f.batches, plan.batch_count());
    EXPECT_EQ(f.waits > 0, count > 1);
    EXPECT_GE(f.time, f.longest);
    EXPECT_GE(f.time * count, f.work);  // what is left over is waiting
    if (count == 1) {
      EXPECT_EQ(f.time, f.work);
      alone = f.time;
    } else {
      EXPECT_LT(f.time, alone);
    }
  }
}

// Enough contacts for three threads, falling and lying, with overlaps that are pushed apart.
TEST(SweepPlan, AHeapHasTheSameBitsWithAnyNumberOfThreads) {
  const auto drop = [](int threads) {
    WorldOptions options;
    options.threads = threads;
    World world({testing::box_type("b", 0.3, 0.2, 0.1), testing::box_type("slab", 1.2, 0.9, 0.1)},
                options);
    RandomStream random(3, "heap");
    std::vector<NewPiece> pieces;
    for (int i = 0; i < 500; ++i) {
      const Vec3 place{random.uniform(0, 5), random.uniform(0, 2), random.uniform(0.1, 1.5)};
      pieces.push_back(testing::at(i % 10 == 0 ? 1 : 0, place, random.rotation()));
    }
    world.add(pieces);
    testing::run(world, 1);
    PileState state;
    for (int i = 0; i < world.size(); ++i) state.pieces.push_back(world.piece(i));
    return state.state_hash();
  };
  const std::uint64_t one = drop(1);
  for (int threads : {2, 3, 8}) EXPECT_EQ(drop(threads), one) << threads << " threads";
}

// A world that goes on keeps its plan; one that begins with a snapshot makes it anew.
TEST(SweepPlan, APileThatLiesAwakeHasTheSameBitsWhenPlannedAnew) {
  WorldOptions options;
  options.sleeping = false;
  const std::vector<PieceType> types{testing::box_type("b", 0.3, 0.2, 0.1)};
  World world(types, options), other(types, options);
  std::vector<NewPiece> pieces;
  for (int i = 0; i < 20; ++i) pieces.push_back(testing::at(0, {0.35 * (i % 5), 0, 0.06 + 0.11 * (i / 5)}, {}));
  world.add(pieces);
  testing::run(world, 2);
  other.restore(*world.snapshot());
  for (int step = 0; step < 30; ++step) world.step(), other.step();
  for (int i = 0; i < world.size(); ++i) {
    EXPECT_EQ(world.piece(i).world_from_body.translation.x, other.piece(i).world_from_body.translation.x) << i;
    EXPECT_EQ(world.piece(i).world_from_body.translation.z, other.piece(i).world_from_body.translation.z) << i;
  }
}

}  // namespace sweep_plan_test
}  // namespace rubble
