// The track of a settling: it changes nothing, it ends where the pile rests, and a settling that was
// stopped leaves the same one.
#include <gtest/gtest.h>

#include <cstring>
#include <optional>

#include "kernel/base/hash.h"
#include "kernel/settling/generator.h"
#include "kernel/settling/settle.h"
#include "kernel/settling/track_recorder.h"
#include "scenes.h"

namespace rubble {
namespace settling_track_test {

// A wall, a loose block, two layers; the ground is small, so that some pieces leave the world.
Pile make_pile() {
  Pile pile = generate_pile(testing::small_pile(52, 2, 20));
  pile.placed = {testing::at(2, {0, 0, 0.4}).placement,
                 testing::at(2, {-1.5, 0, 0.8}, testing::turned({1, 0, 0}, 1.5), true).placement};
  return pile;
}

SettleOptions make_options() {
  SettleOptions options;
  options.layer_time_limit = 1.6;
  options.threads = 1;
  options.lost_beyond = 3.2;
  return options;
}

struct Recorded {
  PileState state;
  Track track;
};

Recorded settle_recorded(const Pile& pile, const SettleOptions& options) {
  TrackRecorder recorder;
  Recorded out;
  out.state =
      settle_pile(pile, options, {}, [&](const World& world) { recorder.observe(world); });
  out.track = recorder.take();
  return out;
}

bool same_bits(const Pose& a, const Pose& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

TEST(SettlingTrack, ChangesNothingAndEndsWhereThePileRests) {
  const Pile pile = make_pile();
  const SettleOptions options = make_options();
  const Recorded recorded = settle_recorded(pile, options);
  EXPECT_EQ(recorded.state.state_hash(), settle_pile(pile, options).state_hash());
  const Track& track = recorded.track;
  ASSERT_EQ(track.find_fault(), "");
  EXPECT_EQ(track.times.size(), std::size_t(recorded.state.steps) + 1);
  EXPECT_EQ(track.begin(), 0);
  EXPECT_EQ(track.end(), recorded.state.simulated);
  EXPECT_GT(recorded.state.lost, 0);  // or the next lines would say less
  ASSERT_EQ(track.bodies.size(), recorded.state.pieces.size());
  std::size_t keys = 0;
  for (const TrackBody& body : track.bodies) keys += body.keys.size();
  EXPECT_LT(keys, track.bodies.size() * track.times.size() * 3 / 5);  // what sleeps takes no room
  EXPECT_EQ(track.bodies[1].keys.size(), 1u);                     // nor does the wall
  for (std::size_t i = 0; i < track.bodies.size(); ++i) {
    const PieceState& piece = recorded.state.pieces[i];
    const auto motion = track.motion_at(track.bodies[i], track.end());
    EXPECT_EQ(motion.has_value(), piece.status != PieceStatus::lost) << i;
    if (!motion) continue;
    EXPECT_TRUE(same_bits(motion->world_from_body, piece.world_from_body)) << i;
    const bool first = track.bodies[i].keys.front().sample == 0;
    EXPECT_EQ(first, piece.layer < 0) << "piece " << i << " of layer " << piece.layer;
  }
}

TEST(SettlingTrack, FallsFreelyBeforeItTouches) {
  PieceType block = testing::box_type("block", 0.2, 0.2, 0.2);
  Pile pile;
  pile.types = {block};
  pile.placed = {testing::at(0, {0, 0, 5}).placement};
  const Recorded recorded = settle_recorded(pile, make_options());
  const TrackBody& body = recorded.track.bodies[0];
  for (double t = 0; t < 0.9; t += 0.0123) {
    const auto motion = recorded.track.motion_at(body, t);
    EXPECT_NEAR(motion->world_from_body.translation.z, 5 - 0.5 * 9.81 * t * t, 1e-6) << t;
    EXPECT_NEAR(motion->linear_velocity.z, -9.81 * t, 1e-5) << t;
  }
}

TEST(SettlingTrack, IsTheSameAfterAStop) {
  const Pile pile = make_pile();
  const SettleOptions options = make_options();
  const Recorded whole = settle_recorded(pile, options);
  for (const std::int64_t stop : {std::int64_t(1), std::int64_t(60), std::int64_t(96), std::int64_t(97),
                                  whole.state.steps - 1, whole.state.steps}) {
    std::optional<SettleCheckpoint> checkpoint;
    TrackRecorder first;
    std::int64_t calls = 0;
    settle_pile(
        pile, options,
        [&](const SettleProgress& progress) {
          if (++calls < stop) return true;
          checkpoint = progress.make_checkpoint();
          return false;
        },
        [&](const World& world) { first.observe(world); });
    TrackRecorder second(first.take());
    const PileState state = resume_settling(*checkpoint, pile, options, {},
                                            [&](const World& world) { second.observe(world); });
    EXPECT_EQ(state.state_hash(), whole.state.state_hash()) << stop;
    EXPECT_EQ(hex64(second.track().hash()), hex64(whole.track.hash())) << stop;
  }
}

// What was written after the checkpoint was made is forgotten: a kill may come between the two files.
TEST(SettlingTrack, IsTheSameWhenMoreWasWrittenThanTheCheckpointKnows) {
  const Pile pile = make_pile();
  const SettleOptions options = make_options();
  const Recorded whole = settle_recorded(pile, options);
  std::optional<SettleCheckpoint> checkpoint;
  std::int64_t calls = 0;
  settle_pile(pile, options, [&](const SettleProgress& progress) {
    if (++calls == 80) checkpoint = progress.make_checkpoint();
    return calls < 80;
  });
  TrackRecorder second(whole.track);
  resume_settling(*checkpoint, pile, options, {}, [&](const World& w) { second.observe(w); });
  EXPECT_EQ(hex64(second.track().hash()), hex64(whole.track.hash()));
}

}  // namespace settling_track_test
}  // namespace rubble
