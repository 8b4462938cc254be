#include "io/learning/lerobot_recorder.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "io/base/folder_writer.h"
#include "io/image/image_file.h"
#include "io/learning/mp4_file.h"
#include "io/learning/parquet_file.h"
#include "io/recording/frame_order.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

using LerobotJson = nlohmann::ordered_json;

constexpr int kVideoQuality = 95;  // of JPEG
constexpr char kTask[] = "move through a collapsed structure";
const std::string kFirstFile = "/chunk-000/file-000";

void put_pose(const Pose& pose, std::vector<float>& state) {
  const Vec3& t = pose.translation;
  const Quat& q = pose.rotation;
  for (const double value : {t.x, t.y, t.z, q.w, q.x, q.y, q.z}) state.push_back(float(value));
}

void put_vector(const Vec3& v, std::vector<float>& state) {
  for (int i = 0; i < 3; ++i) state.push_back(float(v[i]));
}

// Least, most, mean and deviation of each value of a feature.
class FeatureStats {
 public:
  void add(const std::vector<double>& values) {
    if (count_++ == 0) least_ = most_ = values, sum_.assign(values.size(), 0), squares_ = sum_;
    for (std::size_t i = 0; i < values.size(); ++i) {
      least_[i] = std::min(least_[i], values[i]), most_[i] = std::max(most_[i], values[i]);
      sum_[i] += values[i], squares_[i] += values[i] * values[i];
    }
  }
  // of_images: three channels, as channels x 1 x 1.
  LerobotJson json(bool of_images) const {
    std::vector<double> mean, deviation;
    for (std::size_t i = 0; i < sum_.size(); ++i) {
      mean.push_back(sum_[i] / double(count_));
      deviation.push_back(std::sqrt(std::max(0.0, squares_[i] / double(count_) - mean[i] * mean[i])));
    }
    const auto shaped = [&](const std::vector<double>& values) {
      LerobotJson list = LerobotJson::array();
      for (const double value : values) list.push_back(of_images ? LerobotJson{LerobotJson{value}} : LerobotJson(value));
      return list;
    };
    return {{"min", shaped(least_)}, {"max", shaped(most_)}, {"mean", shaped(mean)}, {"std", shaped(deviation)}, {"count", {count_}}};
  }

 private:
  std::uint64_t count_ = 0;
  std::vector<double> least_, most_, sum_, squares_;
};

class LerobotRecorder : public Recorder {
 public:
  LerobotRecorder(const std::string& path, const Recording& recording, int threads)
      : recording_(recording), order_(path, std::vector<Channels>(recording.cameras.size())),
        folder_(path, folders(recording), threads), path_(path), videos_(recording.cameras.size()), robots_(recording.robots.size()) {
    name_state();
  }

  void write_robot(const RobotSample& sample) override { robots_.at(std::size_t(sample.sensor)) = sample; }

  void write(const Frame& frame) override {
    order_.check(frame);
    if (frame.starts_sequence && frame.index > 0)
      throw RunError(path_ + ": an episode has one rate; record without record_settling");
    if (stamps_ns_.empty() || stamps_ns_.back() != frame.stamp_ns) add_row(frame);
    add_picture(frame);
  }

  void finish() override {
    folder_.wait();
    for (std::size_t i = 0; i < videos_.size(); ++i) {
      const Video& video = videos_[i];
      if (video.count != int(stamps_ns_.size()))
        throw RunError(path_ + ": camera " + recording_.cameras[i].name + " has " + std::to_string(video.count) + " pictures at " +
                       std::to_string(stamps_ns_.size()) + " instants: all cameras must have one rate");
      folder_.append(video_file(i), video.file->tail());
    }
    write_table();
    write_episodes();
    folder_.write("meta/info.json", info().dump(4) + "\n");
    folder_.write("meta/stats.json", stats().dump(4) + "\n");
    folder_.finish();
  }

 private:
  struct Video {
    std::optional<Mp4Video> file;
    int width = 0, height = 0, count = 0;
    FeatureStats stats;  // of colours, 0 to 1
  };

  static std::string feature_of(const CameraRecord& camera) { return "observation.images." + camera.name; }
  std::string video_file(std::size_t camera) const {
    return "videos/" + feature_of(recording_.cameras[camera]) + kFirstFile + ".mp4";
  }

  static std::vector<std::string> folders(const Recording& recording) {
    std::vector<std::string> names{"meta/episodes/chunk-000", "data/chunk-000"};
    for (const CameraRecord& camera : recording.cameras) names.push_back("videos/" + feature_of(camera) + "/chunk-000");
    return names;
  }

  void name_pose(const std::string& of) {
    for (const char* part : {"x", "y", "z", "qw", "qx", "qy", "qz"}) state_names_.push_back(of + part);
  }

  void name_state() {
    for (const RobotRecord& robot : recording_.robots) {
      const std::string own = recording_.robots.size() > 1 ? robot.name + "." : "";
      for (const char* what : {".position", ".velocity"})
        for (const RobotRecord::Joint& joint : robot.joints)
          if (!joint.fixed) state_names_.push_back(own + joint.name + what);
      name_pose(own + "base.");
    }
    if (!recording_.robots.empty()) return;
    name_pose("rig.");
    for (const char* part : {"vx", "vy", "vz"}) state_names_.push_back(std::string("rig.") + part);
  }

  std::vector<float> state_at(const Frame& frame) const {
    std::vector<float> state;
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      const std::optional<RobotSample>& sample = robots_[i];
      if (!sample) throw RunError(path_ + ": no reading of robot " + recording_.robots[i].name + " comes before the first picture");
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

  void add_row(const Frame& frame) {
    stamps_ns_.push_back(frame.stamp_ns);
    states_.push_back(state_at(frame));
    state_stats_.add({states_.back().begin(), states_.back().end()});
  }

  void add_picture(const Frame& frame) {
    const auto camera = std::size_t(frame.sensor);
    Video& video = videos_[camera];
    const Intrinsics& k = frame.intrinsics;
    if (!video.file) {
      video.file.emplace(k.width, k.height);
      video.width = k.width, video.height = k.height;
      folder_.append(video_file(camera), Mp4Video::head());
    }
    ++video.count;
    constexpr std::size_t kStride = 16;  // of the pixels that count
    for (std::size_t i = 0; i + 2 < frame.rgb.size(); i += 3 * kStride)
      video.stats.add({frame.rgb[i] / 255.0, frame.rgb[i + 1] / 255.0, frame.rgb[i + 2] / 255.0});
    folder_.append(
        video_file(camera), [k, rgb = frame.rgb] { return Mp4Video::part(encode_jpeg(k.width, k.height, rgb.data(), kVideoQuality)); },
        [&video, since = frame.stamp_ns - stamps_ns_.front()](std::size_t size) { video.file->note(size, since); });
  }

  // A whole number where it is one.
  double rate() const {
    if (stamps_ns_.size() < 2) return 1;
    const double rate = double(stamps_ns_.size() - 1) * 1e9 / double(stamps_ns_.back() - stamps_ns_.front());
    return std::fabs(rate - std::round(rate)) < 1e-4 ? std::round(rate) : rate;
  }

  void write_table() {
    const std::size_t rows = stamps_ns_.size();
    std::vector<std::vector<float>> actions(states_.begin() + 1, states_.end());
    actions.push_back(states_.back());
    std::vector<float> times;
    std::vector<std::int64_t> numbers;
    for (std::size_t i = 0; i < rows; ++i) {
      times.push_back(float(double(stamps_ns_[i] - stamps_ns_.front()) * 1e-9));
      numbers.push_back(std::int64_t(i));
    }
    for (const auto& action : actions) action_stats_.add({action.begin(), action.end()});
    const std::vector<std::int64_t> zeros(rows, 0);
    ParquetTable table;
    table.add_lists("observation.state", states_);
    table.add_lists("action", actions);
    table.add("timestamp", times);
    table.add("frame_index", numbers);
    table.add("episode_index", zeros);
    table.add("index", numbers);
    table.add("task_index", zeros);
    folder_.write("data" + kFirstFile + ".parquet", table.encode());
  }

  void write_episodes() {
    using Numbers = std::vector<std::int64_t>;
    const auto rows = std::int64_t(stamps_ns_.size());
    ParquetTable episodes;
    episodes.add("episode_index", Numbers{0});
    episodes.add_lists("tasks", {{kTask}});
    episodes.add("length", Numbers{rows});
    for (const char* name : {"data/chunk_index", "data/file_index", "dataset_from_index"}) episodes.add(name, Numbers{0});
    episodes.add("dataset_to_index", Numbers{rows});
    for (const CameraRecord& camera : recording_.cameras) {
      const std::string video = "videos/" + feature_of(camera);
      episodes.add(video + "/chunk_index", Numbers{0});
      episodes.add(video + "/file_index", Numbers{0});
      episodes.add(video + "/from_timestamp", std::vector<double>{0});
      episodes.add(video + "/to_timestamp", std::vector<double>{double(rows) / rate()});
    }
    for (const char* name : {"meta/episodes/chunk_index", "meta/episodes/file_index"}) episodes.add(name, Numbers{0});
    folder_.write("meta/episodes" + kFirstFile + ".parquet", episodes.encode());

    ParquetTable tasks;
    tasks.add("task_index", Numbers{0});
    tasks.add("__index_level_0__", std::vector<std::string>{kTask});
    tasks.set_metadata("pandas", pandas_index().dump());
    folder_.write("meta/tasks.parquet", tasks.encode());
  }

  // That the text is the index of the table, for pandas.
  static LerobotJson pandas_index() {
    const auto column = [](LerobotJson name, const char* field, const char* pandas, const char* numpy) {
      return LerobotJson{{"name", std::move(name)}, {"field_name", field}, {"pandas_type", pandas}, {"numpy_type", numpy}, {"metadata", nullptr}};
    };
    return {{"index_columns", {"__index_level_0__"}},
            {"column_indexes", LerobotJson::array({column(nullptr, "None", "unicode", "object")})},
            {"columns", {column("task_index", "task_index", "int64", "int64"),
                         column(nullptr, "__index_level_0__", "unicode", "object")}},
            {"creator", {{"library", "rubble"}, {"version", "1"}}},
            {"pandas_version", "2.2.0"}};
  }

  LerobotJson info() const {
    LerobotJson features;
    for (std::size_t i = 0; i < videos_.size(); ++i) {
      const Video& video = videos_[i];
      features[feature_of(recording_.cameras[i])] = {
          {"dtype", "video"},
          {"shape", {video.height, video.width, 3}},
          {"names", {"height", "width", "channels"}},
          {"info", {{"video.height", video.height}, {"video.width", video.width}, {"video.codec", "mjpeg"}, {"video.pix_fmt", "yuvj420p"},
                    {"video.is_depth_map", false}, {"video.fps", rate()}, {"video.channels", 3}, {"has_audio", false}}}};
    }
    for (const char* name : {"observation.state", "action"})
      features[name] = {{"dtype", "float32"}, {"shape", {state_names_.size()}}, {"names", state_names_}};
    features["timestamp"] = {{"dtype", "float32"}, {"shape", {1}}, {"names", nullptr}};
    for (const char* name : {"frame_index", "episode_index", "index", "task_index"})
      features[name] = {{"dtype", "int64"}, {"shape", {1}}, {"names", nullptr}};
    const std::string file = "/chunk-{chunk_index:03d}/file-{file_index:03d}";
    LerobotJson info{{"codebase_version", "v3.0"},
                     {"robot_type", recording_.robots.empty() ? LerobotJson(nullptr) : LerobotJson(recording_.robots.front().name)},
                     {"total_episodes", 1},
                     {"total_frames", stamps_ns_.size()},
                     {"total_tasks", 1},
                     {"chunks_size", 1000},
                     {"data_files_size_in_mb", 100},
                     {"video_files_size_in_mb", 200},
                     {"fps", rate()},
                     {"splits", {{"train", "0:1"}}},
                     {"data_path", "data" + file + ".parquet"},
                     {"video_path", "videos/{video_key}" + file + ".mp4"},
                     {"features", features}};
    if (rate() == std::round(rate())) info["fps"] = std::int64_t(rate());  // readers want a whole number
    return info;
  }

  LerobotJson stats() const {
    LerobotJson stats;
    for (std::size_t i = 0; i < videos_.size(); ++i) stats[feature_of(recording_.cameras[i])] = videos_[i].stats.json(true);
    stats["observation.state"] = state_stats_.json(false);
    stats["action"] = action_stats_.json(false);
    return stats;
  }

  Recording recording_;
  FrameOrder order_;
  FolderWriter folder_;
  std::string path_;  // for messages
  std::vector<Video> videos_;  // by camera
  std::vector<std::optional<RobotSample>> robots_;  // the last sample of each
  std::vector<std::string> state_names_;
  std::vector<std::int64_t> stamps_ns_;     // of the rows, so far
  std::vector<std::vector<float>> states_;  // likewise
  FeatureStats state_stats_, action_stats_;
};

}  // namespace

std::unique_ptr<Recorder> make_lerobot_recorder(const std::string& path, const Recording& recording, int threads) {
  return std::make_unique<LerobotRecorder>(path, recording, threads);
}

}  // namespace rubble
