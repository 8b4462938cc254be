#include "io/learning/lerobot_recorder.h"

#include <algorithm>
#include <optional>

#include "io/learning/lerobot_dataset.h"
#include "io/recording/frame_order.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

void put_pose(const Pose& pose, std::vector<float>& state) {
  const Vec3& t = pose.translation;
  const Quat& q = pose.rotation;
  for (const double value : {t.x, t.y, t.z, q.w, q.x, q.y, q.z}) state.push_back(float(value));
}

void put_vector(const Vec3& v, std::vector<float>& state) {
  for (int i = 0; i < 3; ++i) state.push_back(float(v[i]));
}

class LerobotRecorder : public Recorder {
 public:
  LerobotRecorder(const std::string& path, const Recording& recording, int threads)
      : recording_(recording), order_(path, std::vector<Channels>(recording.cameras.size())),
        state_names_(name_state(recording)), dataset_(path, spec(), threads), robots_(recording.robots.size()) {}

  void write_robot(const RobotSample& sample) override { robots_.at(std::size_t(sample.sensor)) = sample; }

  void write(const Frame& frame) override {
    order_.check(frame);
    if (frame.starts_sequence && frame.index > 0)
      throw RunError(dataset_.path() + ": an episode has one rate; record without record_settling");
    if (stamps_ns_.empty() || stamps_ns_.back() != frame.stamp_ns) {
      stamps_ns_.push_back(frame.stamp_ns);
      states_.push_back(state_at(frame));
    }
    const Intrinsics& k = frame.intrinsics;
    dataset_.add_picture(std::size_t(frame.sensor), frame.stamp_ns - stamps_ns_.front(), k.width, k.height, frame.rgb);
  }

  void finish() override {
    for (std::size_t i = 0; i < states_.size(); ++i)
      dataset_.add_row(stamps_ns_[i] - stamps_ns_.front(), {states_[i], states_[std::min(i + 1, states_.size() - 1)]});
    dataset_.end_episode();
    dataset_.finish();
  }

 private:
  LerobotDataset::Spec spec() const {
    LerobotDataset::Spec spec;
    for (const CameraRecord& camera : recording_.cameras) spec.videos.push_back("observation.images." + camera.name);
    for (const char* name : {"observation.state", "action"}) spec.features.push_back({name, LerobotFeature::Kind::values, state_names_});
    if (!recording_.robots.empty()) spec.robot_type = recording_.robots.front().name;
    spec.task = "move through a collapsed structure";
    return spec;
  }

  static std::vector<std::string> name_state(const Recording& recording) {
    std::vector<std::string> names;
    const auto name_pose = [&](const std::string& of) {
      for (const char* part : {"x", "y", "z", "qw", "qx", "qy", "qz"}) names.push_back(of + part);
    };
    for (const RobotRecord& robot : recording.robots) {
      const std::string own = recording.robots.size() > 1 ? robot.name + "." : "";
      for (const char* what : {".position", ".velocity"})
        for (const RobotRecord::Joint& joint : robot.joints)
          if (!joint.fixed) names.push_back(own + joint.name + what);
      name_pose(own + "base.");
    }
    if (!recording.robots.empty()) return names;
    name_pose("rig.");
    for (const char* part : {"vx", "vy", "vz"}) names.push_back(std::string("rig.") + part);
    return names;
  }

  std::vector<float> state_at(const Frame& frame) const {
    std::vector<float> state;
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      const std::optional<RobotSample>& sample = robots_[i];
      if (!sample) throw RunError(dataset_.path() + ": no reading of robot " + recording_.robots[i].name + " comes before the first picture");
      for (const auto* values : {&sample->positions, &sample->speeds})
        for (std::size_t k = 0; k < values->size(); ++k)
          if (!recording_.robots[i].joints[k].fixed) state.push_back(float((*values)[k]));
      put_pose(sample->world_from_base, state);
    }
    if (!robots_.empty()) return state;
    put_pose(frame.world_from_rig, state);
    put_vector(frame.rig_velocity, state);
    return state;
  }

  Recording recording_;
  FrameOrder order_;
  std::vector<std::string> state_names_;
  LerobotDataset dataset_;
  std::vector<std::optional<RobotSample>> robots_;  // the last sample of each
  std::vector<std::int64_t> stamps_ns_;             // of the rows, so far
  std::vector<std::vector<float>> states_;          // likewise
};

}  // namespace

std::unique_ptr<Recorder> make_lerobot_recorder(const std::string& path, const Recording& recording, int threads) {
  return std::make_unique<LerobotRecorder>(path, recording, threads);
}

}  // namespace rubble
