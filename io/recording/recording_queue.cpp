#include "io/recording/recording_queue.h"

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <string>
#include <thread>

#include "kernel/base/error.h"

namespace rubble {

// One lock for all: it is taken a few times a frame, and frames take milliseconds.
struct RecordingQueue::Shared {
  ~Shared() { stop(); }

  enum class Phase { recording, finishing, stopped };

  std::vector<std::unique_ptr<Recorder>> recorders;
  std::size_t capacity = 1;
  std::vector<std::thread> threads;

  std::mutex mutex;
  std::condition_variable wake_workers, wake_producer;
  Phase phase = Phase::recording;
  std::deque<std::shared_ptr<const Sample>> samples;  // the first one is number `first`
  std::size_t first = 0;
  std::vector<std::size_t> next;           // per recorder: the number of the sample it takes next
  std::vector<std::exception_ptr> errors;  // per recorder

  bool failed() const {
    return std::any_of(errors.begin(), errors.end(), [](const auto& e) { return e != nullptr; });
  }
  std::size_t end() const { return first + samples.size(); }
  // Frames and scans are what takes memory.
  std::size_t count_frames() const {
    return std::size_t(std::count_if(samples.begin(), samples.end(), [](const auto& sample) {
      const auto* reading = std::get_if<Reading>(sample.get());
      return std::holds_alternative<Frame>(*sample) || (reading && reading->scan);
    }));
  }
  bool drained() const {
    return std::all_of(next.begin(), next.end(), [this](std::size_t n) { return n == end(); });
  }

  void drop_what_all_have() {
    const std::size_t slowest = next.empty() ? end() : *std::min_element(next.begin(), next.end());
    while (first < slowest) samples.pop_front(), ++first;
  }

  // Waits for sample next[i]; none once there is nothing more to write.
  std::shared_ptr<const Sample> wait_for_sample(std::size_t i) {
    std::unique_lock lock(mutex);
    wake_workers.wait(lock, [&] { return phase >= Phase::finishing || next[i] < end(); });
    return phase >= Phase::finishing ? nullptr : samples[next[i] - first];
  }

  void mark_written(std::size_t i) {
    const std::lock_guard lock(mutex);
    ++next[i];
    drop_what_all_have();
    wake_producer.notify_all();
  }

  void work(std::size_t i) {
    try {
      while (const auto sample = wait_for_sample(i)) {
        write_sample(*recorders[i], *sample);
        mark_written(i);
      }
      if (!stopped()) recorders[i]->finish();
    } catch (...) {
      store_error(i);
    }
  }

  // An error while frames are written stops all; one while finishing concerns that recorder alone.
  void store_error(std::size_t i) {
    const std::lock_guard lock(mutex);
    errors[i] = std::current_exception();
    if (phase != Phase::finishing) phase = Phase::stopped;
    wake_workers.notify_all();
    wake_producer.notify_all();
  }

  bool stopped() {
    const std::lock_guard lock(mutex);
    return phase == Phase::stopped;
  }

  void stop() {
    {
      const std::lock_guard lock(mutex);
      phase = Phase::stopped;
    }
    wake_workers.notify_all();
    join();
  }

  void join() {
    for (std::thread& thread : threads) {
      if (thread.joinable()) thread.join();
    }
  }

  void rethrow_error() {
    for (const std::exception_ptr& error : errors) {
      if (error) std::rethrow_exception(error);
    }
  }
};

RecordingQueue::RecordingQueue(std::vector<std::unique_ptr<Recorder>> recorders,
                               std::size_t capacity)
    : shared_(std::make_unique<Shared>()) {
  shared_->recorders = std::move(recorders);
  shared_->capacity = std::max<std::size_t>(capacity, 1);
  shared_->next.resize(shared_->recorders.size());
  shared_->errors.resize(shared_->recorders.size());
  for (std::size_t i = 0; i < shared_->recorders.size(); ++i) {
    shared_->threads.emplace_back([shared = shared_.get(), i] { shared->work(i); });
  }
}

RecordingQueue::~RecordingQueue() = default;

namespace {

bool is_finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// What of a frame is not a number; null: nothing.
const char* find_not_finite(const Frame& frame) {
  const Quat& q = frame.world_from_camera.rotation;
  const Intrinsics& k = frame.intrinsics;
  if (!is_finite(frame.world_from_camera.translation)) return "position";
  if (!is_finite({q.x, q.y, q.z}) || !std::isfinite(q.w)) return "orientation";
  if (!is_finite(frame.linear_velocity)) return "velocity";
  if (!is_finite({k.fx, k.fy, k.cx}) || !std::isfinite(k.cy)) return "camera matrix";
  for (const double c : k.distortion)
    if (!std::isfinite(c)) return "distortion";
  if (!std::isfinite(frame.exposure_s)) return "exposure time";
  if (!std::isfinite(frame.baseline)) return "stereo baseline";
  if (!is_finite(frame.world_from_rig.translation) || !is_finite(frame.rig_velocity))
    return "carrier's motion";
  return nullptr;
}

const char* find_not_finite(const ImuSample& s) {
  const bool finite = is_finite(s.angular_velocity) && is_finite(s.linear_acceleration) &&
                      is_finite(s.angular_bias) && is_finite(s.acceleration_bias);
  return finite ? nullptr : "inertial measurement";
}

const char* find_not_finite(const RobotSample& s) {
  for (const auto* list : {&s.positions, &s.speeds, &s.efforts})
    for (const double value : *list)
      if (!std::isfinite(value)) return "joint state";
  for (const RobotSample::Wrench& w : s.contacts)
    if (!is_finite(w.force) || !is_finite(w.moment)) return "contact force";
  const bool finite = is_finite(s.world_from_base.translation) && is_finite(s.linear_velocity) &&
                      is_finite(s.angular_velocity);
  return finite ? nullptr : "motion";
}

// Its values may be infinite or unknown.
const char* find_not_finite(const Reading& reading) {
  if (!reading.scan) return nullptr;
  for (const ScanPoint& p : reading.scan->points)
    if (!std::isfinite(p.x + p.y + p.z) || !std::isfinite(p.intensity)) return "echo";
  return nullptr;
}

std::string describe(const Frame& frame) { return "frame " + std::to_string(frame.index); }
std::string describe(const ImuSample& sample) {
  return "the reading at " + std::to_string(sample.stamp_ns) + " ns";
}
std::string describe(const Reading& reading) {
  return reading.scan ? "scan " + std::to_string(reading.scan->index) : "the reading at " + std::to_string(reading.stamp_ns) + " ns";
}

std::string describe(const RobotSample& sample) {
  return "what a robot senses at " + std::to_string(sample.stamp_ns) + " ns";
}

void refuse_not_finite(const Sample& sample) {
  std::visit(
      [](const auto& s) {
        if (const char* what = find_not_finite(s))
          throw RunError(describe(s) + " is not recorded: its " + what +
                         " is not a finite number; this is a fault of the program or of the "
                         "numbers in the mission's trajectory");
      },
      sample);
}

}  // namespace

void RecordingQueue::push(Sample sample) {
  refuse_not_finite(sample);
  auto shared_sample = std::make_shared<const Sample>(std::move(sample));
  Shared& s = *shared_;
  std::unique_lock lock(s.mutex);
  s.wake_producer.wait(lock, [&] { return s.failed() || s.count_frames() < s.capacity; });
  if (s.failed()) {
    lock.unlock();
    s.join();  // so that the errors of all are there, and the first of them is always the same
    s.rethrow_error();
  }
  if (s.phase != Shared::Phase::recording) throw RunError("a sample came after the last one");
  s.samples.push_back(std::move(shared_sample));
  s.drop_what_all_have();
  s.wake_workers.notify_all();
}

void RecordingQueue::finish() {
  Shared& s = *shared_;
  {
    std::unique_lock lock(s.mutex);
    s.wake_producer.wait(lock, [&] { return s.failed() || s.drained(); });
    if (!s.failed() && s.phase == Shared::Phase::recording) s.phase = Shared::Phase::finishing;
  }
  s.wake_workers.notify_all();
  s.join();
  s.rethrow_error();
}

}  // namespace rubble
