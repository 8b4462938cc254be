// Settling that stops and goes on equals settling that never stopped.
#include <gtest/gtest.h>

#include <optional>

#include "kernel/base/error.h"
#include "kernel/base/hash.h"
#include "kernel/settling/generator.h"
#include "kernel/settling/settle.h"
#include "scenes.h"

namespace rubble {
namespace resume_test {

// Loose placed pieces, three layers, one of which runs into its limit.
Pile make_pile() {
  Pile pile = generate_pile(testing::small_pile(51, 3, 25));
  pile.placed = {testing::at(2, {0, 0, 0.4}).placement, testing::at(3, {1, 1, 0.5}).placement,
                 testing::at(2, {-1.5, 0, 0.8}, testing::turned({1, 0, 0}, 1.5), true).placement};
  return pile;
}

SettleOptions make_options(Schedule schedule) {
  SettleOptions options;
  options.schedule = schedule;
  options.layer_time_limit = 1.6;
  options.threads = 1;
  return options;
}

// Stops after `steps` steps; the checkpoint of that moment.
SettleCheckpoint stop_after(const Pile& pile, const SettleOptions& options, std::int64_t steps) {
  std::optional<SettleCheckpoint> checkpoint;
  std::int64_t calls = 0;
  const PileState state = settle_pile(pile, options, [&](const SettleProgress& progress) {
    if (++calls < steps) return true;
    checkpoint = progress.make_checkpoint();
    return false;
  });
  EXPECT_EQ(state.steps, steps);
  EXPECT_FALSE(state.settled);
  return checkpoint.value();
}

void expect_equal(const PileState& a, const PileState& b, std::int64_t stop) {
  EXPECT_EQ(hex64(a.state_hash()), hex64(b.state_hash())) << "stopped after step " << stop;
  EXPECT_EQ(a.steps, b.steps) << "stopped after step " << stop;
  EXPECT_EQ(a.simulated, b.simulated);
  EXPECT_EQ(a.settled, b.settled);
  EXPECT_EQ(a.layers_at_limit, b.layers_at_limit) << "stopped after step " << stop;
  EXPECT_EQ(a.lost, b.lost);
  ASSERT_EQ(a.pieces.size(), b.pieces.size());
  for (std::size_t i = 0; i < a.pieces.size(); ++i)
    EXPECT_EQ(a.pieces[i].status, b.pieces[i].status);
}

class Resume : public ::testing::TestWithParam<Schedule> {};

TEST_P(Resume, EqualsNeverHavingStopped) {
  const Pile pile = make_pile();
  const SettleOptions options = make_options(GetParam());
  std::vector<std::int64_t> last_steps;  // of each stage, before the next layer is spawned
  int layer = 0;
  std::int64_t calls = 0;
  const PileState whole = settle_pile(pile, options, [&](const SettleProgress& progress) {
    if (progress.layer != layer) last_steps.push_back(calls);
    layer = progress.layer;
    ++calls;
    return true;
  });
  ASSERT_EQ(last_steps.size(), 3u);
  EXPECT_EQ(whole.steps, calls);
  std::vector<std::int64_t> stops{1, last_steps[0] + 40, whole.steps - 1, whole.steps};
  for (std::int64_t step : last_steps) stops.insert(stops.end(), {step, step + 1});
  for (std::int64_t stop : stops) {
    SettleOptions others = options;
    others.threads = 2;
    expect_equal(resume_settling(stop_after(pile, options, stop), pile, others), whole, stop);
  }
}

INSTANTIATE_TEST_SUITE_P(Schedules, Resume, ::testing::Values(Schedule::layers, Schedule::planes));

TEST(ResumeTwice, EqualsNeverHavingStopped) {
  const Pile pile = make_pile();
  const SettleOptions options = make_options(Schedule::layers);
  const SettleCheckpoint direct = stop_after(pile, options, 120);
  std::optional<SettleCheckpoint> second;
  std::int64_t calls = 0;
  resume_settling(stop_after(pile, options, 70), pile, options, [&](const SettleProgress& p) {
    EXPECT_EQ(p.layers, 3);
    if (++calls < 50) return true;
    second = p.make_checkpoint();
    return false;
  });
  ASSERT_TRUE(second);
  EXPECT_EQ(second->work, direct.work);
  EXPECT_EQ(second->layers, direct.layers);
  EXPECT_EQ(second->layers_at_limit, direct.layers_at_limit);
  EXPECT_EQ(second->layer_steps, direct.layer_steps);
  EXPECT_EQ(second->world, direct.world);  // every byte of the state
}

// The negative control: what the checkpoint holds is what the result is made of.
TEST(ResumeControl, ALostPositionInTheScheduleShows) {
  const Pile pile = make_pile();
  const SettleOptions options = make_options(Schedule::layers);
  const PileState whole = settle_pile(pile, options);
  SettleCheckpoint checkpoint = stop_after(pile, options, 110);
  ASSERT_GT(checkpoint.layer_steps, 3);
  ASSERT_EQ(resume_settling(checkpoint, pile, options).state_hash(), whole.state_hash());
  checkpoint.layer_steps -= 3;  // the layer that runs into its limit would get three steps more
  EXPECT_NE(resume_settling(checkpoint, pile, options).state_hash(), whole.state_hash());
}

std::string error_of(const SettleCheckpoint& checkpoint, const Pile& pile,
                     const SettleOptions& options) {
  try {
    resume_settling(checkpoint, pile, options);
  } catch (const InputError& error) {
    return error.diagnostics().front().text();
  }
  return "";
}

TEST(ResumeErrors, OtherWorkIsRefused) {
  Pile pile = make_pile();
  SettleOptions options = make_options(Schedule::layers);
  SettleCheckpoint checkpoint = stop_after(pile, options, 5);
  options.final_time_limit += 1;
  EXPECT_NE(error_of(checkpoint, pile, options).find("another pile"), std::string::npos);
  options.final_time_limit -= 1;
  pile.layers[2].pieces[7].scale += 1e-12;
  EXPECT_NE(error_of(checkpoint, pile, options).find("another pile"), std::string::npos);
  pile = make_pile();
  checkpoint.layers = 4;
  EXPECT_NE(error_of(checkpoint, pile, options).find("no moment"), std::string::npos);
  checkpoint.layers = 0;
  checkpoint.world.pop_back();
  EXPECT_NE(error_of(checkpoint, pile, options).find("ends too early"), std::string::npos);
}

}  // namespace resume_test
}  // namespace rubble
