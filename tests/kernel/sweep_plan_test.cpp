// SweepPlan: whoever solves what, each body meets its contacts in the order in which they were added.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <thread>
#include <vector>

#include "kernel/base/random.h"
#include "kernel/solver/contact_colours.h"
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

std::vector<std::int32_t> make_sequence(std::size_t count) {
  std::vector<std::int32_t> sequence(count);
  std::iota(sequence.begin(), sequence.end(), 0);
  return sequence;
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

std::vector<std::int32_t> order_by_colour(const std::vector<Touch>& touches, int bodies, int& colours) {
  ContactColours by_colour;
  by_colour.begin(std::size_t(bodies));
  for (std::size_t i = 0; i < touches.size(); ++i) by_colour.add(std::int32_t(i), touches[i].a, touches[i].b);
  std::vector<std::int32_t> order = by_colour.finish();
  colours = by_colour.count();
  return order;
}

SweepFigures plan_one_thread(const std::vector<Touch>& touches, const std::vector<std::int32_t>& order, int bodies) {
  const std::vector<std::uint8_t> domains(std::size_t(bodies), 0);
  SweepPlan plan;
  plan.begin(1, domains);
  for (std::int32_t i : order) plan.add(i, touches[i].a, touches[i].b, touches[i].rows);
  plan.finish();
  return plan.figures();
}

// A chain has a contact of each colour at most, and there are fewer colours than contacts of two bodies.
TEST(ContactColours, BoundTheChains) {
  std::vector<Touch> touches = make_touches();
  std::stable_sort(touches.begin(), touches.end(), [](const Touch& s, const Touch& t) { return s.a < t.a; });
  std::vector<int> contacts_of(kBodies + 1, 0);
  for (const Touch& t : touches) ++contacts_of[t.a], ++contacts_of[t.b];
  const int most = *std::max_element(contacts_of.begin(), contacts_of.end() - 1);
  int colours = 0;
  const std::vector<std::int32_t> order = order_by_colour(touches, kBodies, colours);
  const SweepFigures bottom_up = plan_one_thread(touches, make_sequence(touches.size()), kBodies);
  const SweepFigures coloured = plan_one_thread(touches, order, kBodies);
  EXPECT_GE(colours, most);
  EXPECT_LT(colours, 2 * most);
  EXPECT_LE(coloured.chain, colours);
  EXPECT_LT(2 * coloured.chain, bottom_up.chain);
  EXPECT_LT(2 * coloured.longest, bottom_up.longest);
}

// A wall in which each brick lies on two: four contacts each, so the first colours come up again in each course.
TEST(ContactColours, OrderByColourAndBottomUpWithin) {
  constexpr int kWide = 10, kHigh = 20, kBricks = kWide * kHigh;
  std::vector<Touch> touches;
  for (int i = 0; i < kBricks; ++i) {
    for (int below : {i - kWide, i - kWide + 1}) touches.push_back({i, i < kWide ? kBricks : below, 4});
  }
  int colours = 0;
  const std::vector<std::int32_t> order = order_by_colour(touches, kBricks, colours);
  EXPECT_LE(colours, 7);
  EXPECT_EQ(std::set<std::int32_t>(order.begin(), order.end()).size(), touches.size());
  const auto falls = [](std::int32_t before, std::int32_t after) { return after < before; };
  int descents = 0;
  for (std::size_t i = 1; i < order.size(); ++i) descents += falls(order[i - 1], order[i]) ? 1 : 0;
  EXPECT_LT(descents, colours);
  EXPECT_LE(plan_one_thread(touches, order, kBricks).chain, colours);
  EXPECT_GE(plan_one_thread(touches, make_sequence(touches.size()), kBricks).chain, kHigh);
}

// Stones side by side that lie on the same slabs: each slab has more contacts than there are colours, and the rest meet it
// one after the other, bottom up.
TEST(ContactColours, ABodyMayHaveMoreContactsThanThereAreColours) {
  constexpr int kSlabs = 8, kStones = 3 * ContactColours::kMostColours;
  std::vector<Touch> touches;  // slabs have the last numbers
  for (int i = 0; i < kStones; ++i) {
    for (int slab = 0; slab < kSlabs; ++slab) touches.push_back({i, kStones + slab, 4});
  }
  int colours = 0;
  const std::vector<std::int32_t> order = order_by_colour(touches, kStones + kSlabs, colours);
  EXPECT_EQ(colours, ContactColours::kMostColours);
  std::vector<int> last(kStones + kSlabs, -1);  // of those that share the last colour, by slab
  const std::vector<std::int32_t> rest(order.end() - kStones, order.end());
  for (std::int32_t i : rest) {
    EXPECT_LT(last[touches[i].b], i);
    last[touches[i].b] = i;
  }
  EXPECT_EQ(std::set<std::int32_t>(order.begin(), order.end()).size(), touches.size());
}

// What does not move joins no islands and has no colours.
TEST(ContactColours, WhatDoesNotMoveJoinsNothing) {
  constexpr int kStones = 100;
  std::vector<Touch> touches;
  for (int i = 0; i < kStones; ++i) touches.push_back({i, kStones, 4});
  int colours = 0;
  EXPECT_EQ(order_by_colour(touches, kStones, colours), make_sequence(touches.size()));
  EXPECT_EQ(colours, 0);
  order_by_colour({}, 0, colours);
  EXPECT_EQ(colours, 0);
}

// A column of boxes beside a heap: the heap's contacts are coloured, those of the column stay bottom up and come first.
TEST(ContactColours, TowersStayBottomUp) {
  constexpr int kBoxes = 30;
  std::vector<Touch> touches = make_touches();
  for (Touch& t : touches) {
    t.a += kBoxes;
    t.b += kBoxes;  // what did not move does not move
  }
  const std::size_t heap = touches.size();
  for (int i = 0; i < kBoxes; ++i) touches.push_back({i, i == 0 ? kBodies + kBoxes : i - 1, 4});
  int colours = 0;
  const std::vector<std::int32_t> order = order_by_colour(touches, kBodies + kBoxes, colours);
  for (int i = 0; i < kBoxes; ++i) EXPECT_EQ(order[std::size_t(i)], std::int32_t(heap) + i);
  EXPECT_FALSE(std::is_sorted(order.begin() + kBoxes, order.end()));
  // One piece of the heap that leans on the column makes them one island.
  touches.push_back({0, kBoxes, 4});
  EXPECT_NE(order_by_colour(touches, kBodies + kBoxes, colours)[0], std::int32_t(heap));
}

TEST(SweepPlan, FiguresSayWhatThreadsGain) {
  const std::vector<Touch> touches = make_touches();
  int colours = 0;
  const std::vector<std::int32_t> order = order_by_colour(touches, kBodies, colours);
  std::int64_t alone = 0;
  for (int count : {1, 2, 7}) {
    const std::vector<std::uint8_t> domains = make_domains(count);
    SweepPlan plan;
    plan.begin(count, domains);
    for (std::int32_t i : order) plan.add(i, touches[i].a, touches[i].b, touches[i].rows);
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
    state.pieces = world.pieces();
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
