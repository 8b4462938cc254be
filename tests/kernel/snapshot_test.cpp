// A world's state as bytes: nothing is forgotten, and what is decoded continues bit for bit.
#include "kernel/settling/generator.h"
#include "kernel/world/world_snapshot.h"

#include <gtest/gtest.h>

#include <utility>

#include "kernel/base/error.h"
#include "kernel/base/hash.h"
#include "kernel/world/world_serialization.h"
#include "scenes.h"

namespace rubble {
namespace snapshot_test {

using testing::at;
using testing::hash_of;
using Bytes = std::vector<std::uint8_t>;

// Converts to anything: used to find out how many initialisers an aggregate takes.
struct Anything {
  template <typename T>
  operator T() const;
};
template <typename T, typename Indices, typename = void>
struct Takes : std::false_type {};
template <typename T, std::size_t... i>
struct Takes<T, std::index_sequence<i...>,
             std::void_t<decltype(T{(void(i), std::declval<Anything>())...})>> : std::true_type {};

// Members of an aggregate; the elements of an array count one by one.
template <typename T, std::size_t count = 0>
constexpr int member_count() {
  if constexpr (Takes<T, std::make_index_sequence<count + 1>>::value) {
    return member_count<T, count + 1>();
  } else {
    return int(count);
  }
}

struct Counter {
  template <typename T>
  void operator()(const T&) {
    ++count;
  }
  template <typename T, std::size_t size>
  void operator()(const T (&)[size]) {
    count += int(size);
  }
  int count = 0;
};

template <typename T>
int listed_count() {
  Counter counter;
  const T value{};
  each_field(value, counter);
  return counter.count;
}

struct Probe {
  int a = 0;
  double b[3] = {};
  Vec3 c;
  Mat3 d;
};

TEST(WorldFields, EveryMemberIsListed) {
  ASSERT_EQ(member_count<Probe>(), 6);  // the count itself works
  const char* help = "a new member must be listed in kernel/world/world_serialization.h";
  EXPECT_EQ(listed_count<Body>(), member_count<Body>()) << help;
  EXPECT_EQ(listed_count<Collider>(), member_count<Collider>()) << help;
  EXPECT_EQ(listed_count<ContactPoint>(), member_count<ContactPoint>()) << help;
  EXPECT_EQ(listed_count<Contact>(), member_count<Contact>()) << help;
  EXPECT_EQ(listed_count<GjkCache>(), member_count<GjkCache>()) << help;
  EXPECT_EQ(listed_count<FreeBody>(), member_count<FreeBody>()) << help;
  EXPECT_EQ(listed_count<TieState>(), member_count<TieState>()) << help;
  EXPECT_EQ(listed_count<Tie>(), member_count<Tie>()) << help;
  EXPECT_EQ(listed_count<WorldData>(), member_count<WorldData>()) << help;
  EXPECT_EQ(listed_count<World::Snapshot>(), member_count<World::Snapshot>()) << help;
}

// Its members are private, so their sizes are compared instead.
struct SizeSum {
  template <typename T>
  void operator()(const T&) {
    sum = (sum + alignof(T) - 1) / alignof(T) * alignof(T) + sizeof(T);
  }
  std::size_t sum = 0;
};

TEST(WorldFields, EveryMemberOfTheBroadPhaseIsListed) {
  SizeSum size;
  each_field(std::as_const(*std::make_unique<BroadPhase>()), size);
  EXPECT_EQ((size.sum + 7) / 8 * 8, sizeof(BroadPhase))
      << "a new member must be listed in BroadPhase::each_field";
}

std::vector<NewPiece> lift(const Layer& layer, double height) {
  std::vector<NewPiece> pieces;
  for (const Placement& placement : layer.pieces) {
    pieces.push_back({});
    pieces.back().placement = placement;
    pieces.back().placement.world_from_body.translation.z += height;
  }
  return pieces;
}

// A heap asleep beside a fixed wall, a layer on its way down and one in the middle of landing.
struct Scene {
  explicit Scene(int threads = 1) {
    PileSpec spec = testing::small_pile(41, 3, 30);
    spec.types.push_back(testing::box_type("wall", 6, 0.3, 2));
    spec.spawn_bounds = {4, 4, 4};
    pile = generate_pile(spec);
    options.threads = threads;
  }
  World make_empty() const { return World(pile.types, options); }
  World make() const {
    World world = make_empty();
    world.add({at(int(pile.types.size()) - 1, {0, 2.2, 1}, {}, true)});
    world.add(lift(pile.layers[0], 0.3));
    testing::run(world, 4);
    world.add(lift(pile.layers[1], 1.0));
    testing::run(world, 0.9);
    world.add(lift(pile.layers[2], 4.0));
    testing::run(world, 0.1);
    return world;
  }
  Pile pile;
  WorldOptions options;
};

World reload(const Scene& scene, const Bytes& bytes) {
  World world = scene.make_empty();
  world.restore(*decode_snapshot(bytes));
  return world;
}

// Hashes of every state on the way, to name the first step that differs.
int first_difference(World& a, World& b, int steps) {
  for (int step = 1; step <= steps; ++step) {
    a.step();
    b.step();
    if (hash_of(a) != hash_of(b)) return step;
  }
  return 0;
}

TEST(Snapshot, TheSceneHasAwakeSleepingAndTouchingPieces) {
  const Scene scene;
  const World world = scene.make();
  int asleep = 0, awake_touching = 0, flying = 0;
  for (int i = 1; i < world.size(); ++i) {
    asleep += !world.is_awake(i);
    awake_touching += world.is_awake(i) && world.is_touching(i);
    flying += world.is_awake(i) && !world.is_touching(i);
  }
  EXPECT_GT(asleep, 2);
  EXPECT_GT(awake_touching, 10);
  EXPECT_GT(flying, 10);
}

TEST(Snapshot, AFreshWorldContinuesBitForBit) {
  const Scene scene, other_scene(3);
  World world = scene.make();
  const Bytes bytes = encode_snapshot(*world.snapshot());
  World fresh = reload(other_scene, bytes);
  EXPECT_EQ(fresh.steps(), world.steps());
  EXPECT_EQ(fresh.awake_count(), world.awake_count());
  EXPECT_EQ(encode_snapshot(*fresh.snapshot()), bytes);
  EXPECT_EQ(first_difference(world, fresh, 200), 0) << "is the first step that differs";
  EXPECT_EQ(encode_snapshot(*fresh.snapshot()), encode_snapshot(*world.snapshot()));
}

TEST(Snapshot, PiecesCanBeAddedAfterwardsAsIfNothingHadHappened) {
  const Scene scene;
  World world = scene.make();
  World fresh = reload(scene, encode_snapshot(*world.snapshot()));
  for (World* w : {&world, &fresh}) w->add(lift(scene.pile.layers[0], 8));
  EXPECT_EQ(first_difference(world, fresh, 120), 0) << "is the first step that differs";
}

TEST(Snapshot, StaysUsableWhenItsWorldIsGone) {
  const Scene scene;
  std::shared_ptr<const World::Snapshot> saved;
  std::uint64_t later = 0;
  {
    World world = scene.make();
    saved = world.snapshot();
    testing::run(world, 0.5);
    later = hash_of(world);
  }
  World fresh = scene.make_empty();
  fresh.restore(*saved);
  testing::run(fresh, 0.5);
  EXPECT_EQ(hash_of(fresh), later);
}

TEST(Snapshot, ALastBitOfOneMemberIsNotLost) {
  const Scene scene;
  World world = scene.make();
  const Bytes bytes = encode_snapshot(*world.snapshot());
  auto changed = std::make_shared<World::Snapshot>(*decode_snapshot(bytes));
  EXPECT_EQ(encode_snapshot(*changed), bytes);
  for (Contact& contact : changed->data.contacts) {
    for (ContactPoint& point : contact.points) point.normal_impulse *= 0.5F;
  }
  EXPECT_NE(encode_snapshot(*changed), bytes);
  World other = scene.make_empty();
  other.restore(*changed);
  EXPECT_EQ(first_difference(world, other, 5), 1);  // the warm start is part of the state
}

std::string error_of(const Bytes& bytes) {
  try {
    decode_snapshot(bytes);
  } catch (const InputError& error) {
    return error.diagnostics().front().text();
  }
  return "";
}

TEST(Snapshot, RefusesWhatIsNotWhole) {
  Scene scene;
  World world = scene.make_empty();
  world.add({at(3, {0, 0, 0.2}), at(3, {0.1, 0, 0.5})});
  testing::run(world, 0.5);
  const Bytes whole = encode_snapshot(*world.snapshot());
  EXPECT_EQ(error_of(whole), "");
  for (std::size_t size = 0; size < whole.size(); size += size < 64 ? 1 : 997) {
    EXPECT_NE(error_of(Bytes(whole.begin(), whole.begin() + std::ptrdiff_t(size))), "") << size;
  }
  Bytes changed = whole;
  changed.push_back(0);
  EXPECT_NE(error_of(changed).find("longer than it says"), std::string::npos);
  changed = whole;
  changed[0] = 77;
  EXPECT_NE(error_of(changed).find("format version 77"), std::string::npos);
  changed = whole;
  changed[19] = 255;  // the high byte of the number of bodies
  EXPECT_NE(error_of(changed).find("ends too early"), std::string::npos);
}

TEST(Snapshot, RefusesAWorldWithOtherTypes) {
  Scene scene;
  const World world = scene.make();
  scene.pile.types[0].density *= 1.001;
  World other = scene.make_empty();
  EXPECT_THROW(other.restore(*world.snapshot()), RunError);
}

}  // namespace snapshot_test
}  // namespace rubble
