// A track against closed forms: free fall, rotation, what rests, what comes and goes.
#include "kernel/model/track.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "kernel/base/portable_math.h"
#include "kernel/model/track_builder.h"

namespace rubble {
namespace track_test {

constexpr double kGravity = 9.81, kStep = 1.0 / 60;

bool same_bits(const Pose& a, const Pose& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

Quat about(const Vec3& axis, double angle) {
  const Vec3 v = axis * std::sin(angle / 2);
  return {std::cos(angle / 2), v.x, v.y, v.z};
}

// A body in free fall that turns about one axis, its centre of mass not at its origin.
struct Thrown {
  Vec3 centre{0.3, -0.2, 0.1};  // in the body
  Vec3 from{1, 2, 30}, speed{2, -1, 4};
  Vec3 axis = normalized(Vec3{1, 2, 2});
  double spin = 5;  // unit: rad/s

  Vec3 centre_at(double t) const { return from + speed * t + Vec3{0, 0, -0.5 * kGravity * t * t}; }
  Pose pose_at(double t) const {
    const Quat q = about(axis, spin * t);
    return {q, centre_at(t) - q.rotate(centre)};
  }
  BodySample sample_at(double t) const {
    return {7, centre, pose_at(t), speed + Vec3{0, 0, -kGravity * t}, axis * spin};
  }
};

Track record(const Thrown& body, double step, int samples) {
  TrackBuilder builder;
  for (int i = 0; i < samples; ++i) {
    builder.begin_sample(i * step);
    builder.set(body.sample_at(i * step));
  }
  return builder.take();
}

TEST(Track, FollowsFreeFallBetweenItsKeys) {
  const Thrown body;
  const Track track = record(body, kStep, 60);
  ASSERT_EQ(track.find_fault(), "");
  const TrackBody& kept = *track.find(7);
  for (double t = 0; t < 59 * kStep; t += 0.0007) {
    const auto motion = track.motion_at(kept, t);
    ASSERT_TRUE(motion);
    const Pose& pose = motion->world_from_body;
    EXPECT_LT(distance(pose * body.centre, body.centre_at(t)), 1e-7) << t;
    const Vec3 point{0.5, 0.5, -0.5};
    EXPECT_LT(distance(pose * point, body.pose_at(t) * point), 2e-7) << t;
    // The velocity of that point is what the pose's own change says.
    const double h = 1e-5;
    const Vec3 by_difference =
        (body.pose_at(t + h) * point - body.pose_at(t - h) * point) * (1 / (2 * h));
    EXPECT_LT(distance(motion->velocity_at(pose * point), by_difference), 1e-4) << t;
    EXPECT_LT(distance(motion->angular_velocity, body.axis * body.spin), 1e-6) << t;
  }
}

TEST(Track, GivesItsKeysBackBitForBit) {
  const Thrown body;
  const Track track = record(body, kStep, 60);
  for (int i = 0; i < 60; ++i) {
    const auto motion = track.motion_at(track.bodies[0], track.times[std::size_t(i)]);
    EXPECT_TRUE(same_bits(motion->world_from_body, body.pose_at(i * kStep))) << i;
  }
}

TEST(Track, KeepsWholeTurnsBetweenKeys) {
  Thrown body;
  body.spin = 500;  // 8.3 rad a key: more than one turn
  const Track track = record(body, kStep, 10);
  const double t = 4.25 * kStep;
  const auto motion = track.motion_at(track.bodies[0], t);
  EXPECT_LT(distance(motion->angular_velocity, body.axis * body.spin), 1e-4);
  const Vec3 point{1, 0, 0};
  EXPECT_LT(distance(motion->world_from_body.rotation.rotate(point),
                     body.pose_at(t).rotation.rotate(point)),
            1e-5);
}

// A body that lands in a step comes in fast and ends at rest: between the two the solver moved it
// straight on, and a curve through both speeds would dip it into the ground.
TEST(Track, GoesStraightOnWhereSomethingTouched) {
  TrackBuilder builder;
  builder.begin_sample(0);
  builder.set({0, {}, {{}, {0, 0, 0.01}}, {0, 0, -5}, {}});
  builder.begin_sample(kStep);
  builder.set({0, {}, {{}, {0, 0, 0}}, {}, {}});
  const Track track = builder.take();
  for (double share : {0.1, 0.5, 0.9}) {
    const auto motion = track.motion_at(track.bodies[0], share * kStep);
    EXPECT_NEAR(motion->world_from_body.translation.z, 0.01 * (1 - share), 1e-12);
    EXPECT_NEAR(motion->linear_velocity.z, -0.6, 1e-9);
  }
}

TEST(Track, WhatRestsTakesNoRoomAndStays) {
  TrackBuilder builder;
  const Pose low{{}, {0, 0, 1}}, high{{}, {0, 0, 2}};
  for (int i = 0; i < 1000; ++i) {
    builder.begin_sample(i * kStep);
    builder.set({3, {}, i < 500 ? low : high, {}, {}});
  }
  const Track track = builder.take();
  ASSERT_EQ(track.bodies[0].keys.size(), 3u);  // at first, before it moves, and after
  const auto z_at = [&](double t) {
    return track.motion_at(track.bodies[0], t)->world_from_body.translation.z;
  };
  EXPECT_EQ(z_at(0), 1);
  EXPECT_EQ(z_at(498.9 * kStep), 1);
  EXPECT_NEAR(z_at(499.5 * kStep), 1.5, 1e-9);
  EXPECT_EQ(z_at(500 * kStep), 2);
  EXPECT_EQ(z_at(1e6), 2);
  EXPECT_EQ(norm(track.motion_at(track.bodies[0], 100 * kStep)->linear_velocity), 0);
  EXPECT_TRUE(track.rests_throughout(track.bodies[0], 0, 499 * kStep));
  EXPECT_FALSE(track.rests_throughout(track.bodies[0], 0, 499.01 * kStep));
  EXPECT_FALSE(track.rests_throughout(track.bodies[0], 499.9 * kStep, 1e6));
  EXPECT_TRUE(track.rests_throughout(track.bodies[0], 500 * kStep, 1e6));
  EXPECT_FALSE(track.rests_throughout(track.bodies[0], -1, 1));
}

TEST(Track, BodiesComeAndGo) {
  TrackBuilder builder;
  for (int i = 0; i < 10; ++i) {
    builder.begin_sample(i);
    builder.set({5, {}, {{}, {0, 0, 5.0 + i}}, {}, {}});
    if (i >= 3 && i < 6) builder.set({2, {}, {{}, {0, 0, 2.0 + i}}, {}, {}});
    if (i == 6) builder.remove(2);
  }
  builder.remove(2);
  builder.remove(99);
  const Track track = builder.take();
  ASSERT_EQ(track.find_fault(), "");
  ASSERT_EQ(track.bodies.size(), 2u);
  EXPECT_EQ(track.bodies[0].id, 2);
  EXPECT_EQ(track.find(4), nullptr);
  EXPECT_FALSE(track.motion_at(*track.find(2), 2.99));
  EXPECT_TRUE(track.motion_at(*track.find(2), 3));
  EXPECT_TRUE(track.motion_at(*track.find(2), 5.99));
  EXPECT_FALSE(track.motion_at(*track.find(2), 6));
  const auto poses = track.poses_at(4);
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0]->world_from_body.translation.z, 6);
  EXPECT_EQ(poses[1]->world_from_body.translation.z, 9);
  EXPECT_FALSE(track.poses_at(0)[0]);
}

// Rests, moves and goes, in a pattern that every cut meets at another moment.
void add_sample(TrackBuilder& builder, int i) {
  builder.begin_sample(i * kStep);
  for (int id = 0; id < 4; ++id) {
    if (i < id * 2) continue;
    if (id == 3 && i >= 15) {
      builder.remove(id);
      continue;
    }
    const int phase = (i + id) / 4 % 2 == 0 ? i : (i + id) / 4 * 4;
    builder.set({id, {}, {{}, {0.1 * phase, 0, double(id)}}, {double(i), 0, 0}, {0, 0, 1}});
  }
}

TEST(Track, GoesOnAfterACutAsIfItHadNeverStopped) {
  TrackBuilder whole;
  for (int i = 0; i < 24; ++i) add_sample(whole, i);
  for (int cut = 0; cut < 24; ++cut) {
    for (int ahead : {0, 1, 5}) {  // what was written after the moment it goes on from
      TrackBuilder first;
      for (int i = 0; i < std::min(24, cut + ahead); ++i) add_sample(first, i);
      TrackBuilder second(first.take());
      second.forget_from(cut * kStep);
      for (int i = cut; i < 24; ++i) add_sample(second, i);
      EXPECT_EQ(second.track().hash(), whole.track().hash()) << cut << " and " << ahead;
    }
  }
}

TEST(Track, TheHashHearsOfEveryBit) {
  const Track track = record(Thrown{}, kStep, 5);
  EXPECT_EQ(track.hash(), record(Thrown{}, kStep, 5).hash());
  Track other = track;
  other.bodies[0].keys[2].world_from_body.translation.x += 1e-15;
  EXPECT_NE(other.hash(), track.hash());
  other = track;
  other.times[4] = std::nextafter(other.times[4], 1);
  EXPECT_NE(other.hash(), track.hash());
  other = track;
  other.bodies[0].gone = 4;
  EXPECT_NE(other.hash(), track.hash());
}

TEST(Track, NamesWhatIsUnsound) {
  const Track sound = record(Thrown{}, kStep, 5);
  const auto fault_after = [&](const auto& change) {
    Track track = sound;
    change(track);
    return track.find_fault();
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(fault_after([](Track&) {}), "");
  EXPECT_EQ(Track{}.find_fault(), "");
  EXPECT_EQ(fault_after([](Track& t) { t.times[2] = t.times[1]; }), "the samples are out of order");
  EXPECT_NE(fault_after([&](Track& t) { t.times[2] = nan; }), "");
  EXPECT_NE(fault_after([](Track& t) { t.bodies.push_back(t.bodies[0]); }), "");
  EXPECT_NE(fault_after([](Track& t) { t.bodies[0].keys.clear(); }), "");
  EXPECT_NE(fault_after([](Track& t) { t.bodies[0].keys[1].sample = 9; }), "");
  EXPECT_NE(fault_after([](Track& t) { t.bodies[0].keys[1].sample = 0; }), "");
  EXPECT_NE(fault_after([](Track& t) { t.bodies[0].gone = 2; }), "");
  EXPECT_NE(fault_after([&](Track& t) { t.bodies[0].centre.y = nan; }), "");
  EXPECT_NE(fault_after([&](Track& t) { t.bodies[0].keys[3].world_from_body.translation.z = nan; }), "");
  EXPECT_NE(fault_after([](Track& t) { t.bodies[0].keys[3].world_from_body.rotation = {0, 0, 0, 0}; }),
            "");
  EXPECT_NE(fault_after([](Track& t) { t.bodies[0].id = -1; }), "");
}

}  // namespace track_test
}  // namespace rubble
