#include "io/recording/recording_queue.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <thread>

#include "io/datasets/tum_recorder.h"
#include "kernel/base/error.h"
#include "tests/io/support.h"

namespace rubble {
namespace recording_queue_test {

using test::make_frame;

// What a recorder saw; outlives it.
struct Log {
  std::atomic<int> written{0};
  std::atomic<bool> in_order{true}, finished{false}, destroyed{false};
};

class FakeRecorder : public Recorder {
 public:
  FakeRecorder(Log& log, int fails_at = -1, int delay_ms = 0, bool fails_in_finish = false)
      : log_(log), fails_at_(fails_at), delay_ms_(delay_ms), fails_in_finish_(fails_in_finish) {}
  ~FakeRecorder() override { log_.destroyed = true; }

  void write(const Frame& frame) override {
    if (frame.index == fails_at_) throw RunError("fake failure at " + std::to_string(fails_at_));
    if (frame.index != log_.written) log_.in_order = false;
    std::this_thread::sleep_for(std::chrono::milliseconds(delay_ms_));
    ++log_.written;
  }
  void finish() override {
    if (fails_in_finish_) throw RunError("fake failure in finish");
    log_.finished = true;
  }

 private:
  Log& log_;
  int fails_at_, delay_ms_;
  bool fails_in_finish_;
};

template <typename... Arguments>
void add(std::vector<std::unique_ptr<Recorder>>& recorders, Arguments&&... arguments) {
  recorders.push_back(std::make_unique<FakeRecorder>(std::forward<Arguments>(arguments)...));
}

TEST(RecordingQueue, LetsNothingThroughThatIsNotFinite) {
  const double nan = std::nan(""), inf = HUGE_VAL;
  const std::vector<std::pair<const char*, std::function<void(Frame&)>>> faults = {
      {"position", [&](Frame& f) { f.world_from_camera.translation.y = nan; }},
      {"orientation", [&](Frame& f) { f.world_from_camera.rotation.w = nan; }},
      {"velocity", [&](Frame& f) { f.linear_velocity.x = inf; }},
      {"camera matrix", [&](Frame& f) { f.intrinsics.cy = nan; }},
      {"exposure time", [&](Frame& f) { f.exposure_s = inf; }},
      {"carrier's motion", [&](Frame& f) { f.rig_velocity.y = nan; }}};
  for (const auto& [what, spoil] : faults) {
    Log log;
    std::vector<std::unique_ptr<Recorder>> recorders;
    add(recorders, log);
    RecordingQueue queue(std::move(recorders));
    queue.push(make_frame(0, 8, 8));
    Frame bad = make_frame(1, 8, 8);
    spoil(bad);
    try {
      queue.push(bad);
      ADD_FAILURE() << what;
    } catch (const RunError& error) {
      EXPECT_NE(std::string(error.what()).find(std::string("its ") + what), std::string::npos) << error.what();
    }
  }
}

TEST(RecordingQueue, LetsNoReadingThroughThatIsNotFinite) {
  Log log;
  std::vector<std::unique_ptr<Recorder>> recorders;
  add(recorders, log);
  RecordingQueue queue(std::move(recorders));
  ImuSample reading;
  queue.push(reading);
  reading.linear_acceleration.z = std::nan("");
  try {
    queue.push(reading);
    ADD_FAILURE();
  } catch (const RunError& error) {
    EXPECT_NE(std::string(error.what()).find("its inertial measurement"), std::string::npos)
        << error.what();
  }
}

TEST(RecordingQueue, GivesEveryFrameInOrderToEveryRecorder) {
  Log fast, slow;
  std::vector<std::unique_ptr<Recorder>> recorders;
  add(recorders, fast);
  add(recorders, slow, -1, 2);
  RecordingQueue queue(std::move(recorders), 3);
  for (int i = 0; i < 40; ++i) queue.push(make_frame(i, 8, 8));
  queue.finish();
  for (const Log* log : {&fast, &slow}) {
    EXPECT_EQ(log->written, 40);
    EXPECT_TRUE(log->in_order);
    EXPECT_TRUE(log->finished);
  }
}

TEST(RecordingQueue, HoldsNoMoreThanItsCapacity) {
  Log slow;
  std::vector<std::unique_ptr<Recorder>> recorders;
  add(recorders, slow, -1, 3);
  RecordingQueue queue(std::move(recorders), 2);
  for (int i = 0; i < 20; ++i) {
    queue.push(make_frame(i, 8, 8));
    // Frame i could only enter after frame i - 2 had left.
    EXPECT_GE(slow.written, i - 1);
  }
  queue.finish();
}

TEST(RecordingQueue, AFailureStopsAllAndSurfaces) {
  Log good, bad;
  std::vector<std::unique_ptr<Recorder>> recorders;
  add(recorders, good);
  add(recorders, bad, 5);
  {
    RecordingQueue queue(std::move(recorders), 2);
    std::string message;
    try {
      for (int i = 0; i < 100; ++i) queue.push(make_frame(i, 8, 8));
    } catch (const RunError& error) {
      message = error.what();
    }
    EXPECT_EQ(message, "fake failure at 5");
    EXPECT_THROW(queue.finish(), RunError);
  }
  EXPECT_FALSE(good.finished);
  EXPECT_FALSE(bad.finished);
  EXPECT_TRUE(good.destroyed);
}

TEST(RecordingQueue, AFailureWithTheLastFrameSurfacesInFinish) {
  Log good, bad;
  std::vector<std::unique_ptr<Recorder>> recorders;
  add(recorders, good);
  add(recorders, bad, 1, 5);
  RecordingQueue queue(std::move(recorders), 8);
  for (int i = 0; i < 2; ++i) queue.push(make_frame(i, 8, 8));
  EXPECT_THROW(queue.finish(), RunError);
  EXPECT_FALSE(good.finished);
}

TEST(RecordingQueue, AFailureInFinishSurfacesAndTheOthersAreFinished) {
  Log good, bad;
  std::vector<std::unique_ptr<Recorder>> recorders;
  add(recorders, bad, -1, 0, true);
  add(recorders, good);
  RecordingQueue queue(std::move(recorders));
  queue.push(make_frame(0, 8, 8));
  EXPECT_THROW(queue.finish(), RunError);
  EXPECT_TRUE(good.finished);
}

TEST(RecordingQueue, WithoutFinishTheRecordersLeaveNothing) {
  test::ScratchFolder folder;
  {
    std::vector<std::unique_ptr<Recorder>> recorders;
    recorders.push_back(make_tum_trajectory_recorder(folder / "groundtruth.txt"));
    RecordingQueue queue(std::move(recorders));
    for (int i = 0; i < 5; ++i) queue.push(make_frame(i, 8, 8));
  }
  EXPECT_TRUE(folder.names().empty());
}

TEST(RecordingQueue, AFrameAfterTheLastIsRefused) {
  Log log;
  std::vector<std::unique_ptr<Recorder>> recorders;
  add(recorders, log);
  RecordingQueue queue(std::move(recorders));
  queue.push(make_frame(0, 8, 8));
  queue.finish();
  EXPECT_THROW(queue.push(make_frame(1, 8, 8)), RunError);
}

}  // namespace recording_queue_test
}  // namespace rubble
