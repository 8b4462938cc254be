#include "io/learning/lerobot_dataset.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "io/image/image_file.h"
#include "io/learning/parquet_file.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

using LerobotJson = nlohmann::ordered_json;
using Numbers = std::vector<std::int64_t>;

constexpr int kVideoQuality = 95;  // of JPEG
const std::string kFirstFile = "/chunk-000/file-000";

// of_images: three channels, as channels x 1 x 1.
LerobotJson stats_of(const LerobotStats& stats, bool of_images) {
  std::vector<double> mean, deviation;
  for (std::size_t i = 0; i < stats.sum.size(); ++i) {
    mean.push_back(stats.sum[i] / double(stats.count));
    deviation.push_back(std::sqrt(std::max(0.0, stats.squares[i] / double(stats.count) - mean[i] * mean[i])));
  }
  const auto shaped = [&](const std::vector<double>& values) {
    LerobotJson list = LerobotJson::array();
    for (const double value : values) list.push_back(of_images ? LerobotJson{LerobotJson{value}} : LerobotJson(value));
    return list;
  };
  return {{"min", shaped(stats.least)}, {"max", shaped(stats.most)}, {"mean", shaped(mean)}, {"std", shaped(deviation)},
          {"count", {stats.count}}};
}

// That the text is the index of the table, for pandas.
LerobotJson pandas_index() {
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

std::vector<std::string> dataset_folders(const LerobotDataset::Spec& spec) {
  std::vector<std::string> names{"meta/episodes/chunk-000", "data/chunk-000"};
  for (const std::string& video : spec.videos) names.push_back("videos/" + video + "/chunk-000");
  return names;
}

}  // namespace

void LerobotStats::add(const std::vector<double>& values) {
  if (count++ == 0) least = most = values, sum.assign(values.size(), 0), squares = sum;
  for (std::size_t i = 0; i < values.size(); ++i) {
    least[i] = std::min(least[i], values[i]), most[i] = std::max(most[i], values[i]);
    sum[i] += values[i], squares[i] += values[i] * values[i];
  }
}

LerobotDataset::LerobotDataset(const std::string& path, Spec spec, int threads)
    : spec_(std::move(spec)), folder_(path, dataset_folders(spec_), threads), path_(path), videos_(spec_.videos.size()),
      columns_(spec_.features.size()), stats_(spec_.features.size()) {}

std::string LerobotDataset::video_file(std::size_t video) const { return "videos/" + spec_.videos[video] + kFirstFile + ".mp4"; }

std::size_t LerobotDataset::count_rows() const {
  std::size_t rows = 0;
  for (const Episode& episode : episodes_) rows += std::size_t(episode.length);
  return rows;
}

void LerobotDataset::add_picture(std::size_t index, std::int64_t since_ns, int width, int height, std::vector<std::uint8_t> rgb) {
  Video& video = videos_.at(index);
  if (!video.file) {
    video.file.emplace(width, height);
    video.width = width, video.height = height;
    folder_.append(video_file(index), Mp4Video::head());
  }
  if (width != video.width || height != video.height)
    throw RunError(path_ + ": a picture of " + spec_.videos[index] + " has " + std::to_string(width) + " x " + std::to_string(height) +
                   " pixels: expected " + std::to_string(video.width) + " x " + std::to_string(video.height) + ", as the first one");
  ++video.count;
  constexpr std::size_t kStride = 16;  // of the pixels that count
  for (std::size_t i = 0; i + 2 < rgb.size(); i += 3 * kStride)
    video.stats.add({rgb[i] / 255.0, rgb[i + 1] / 255.0, rgb[i + 2] / 255.0});
  folder_.append(
      video_file(index), [width, height, rgb = std::move(rgb)] { return Mp4Video::part(encode_jpeg(width, height, rgb.data(), kVideoQuality)); },
      [&video, at = begin_ns_ + since_ns](std::size_t size) { video.file->note(size, at); });
}

void LerobotDataset::add_row(std::int64_t since_ns, std::vector<std::vector<float>> values) {
  if (values.size() != columns_.size()) throw RunError(path_ + ": a row has another number of features");
  for (std::size_t i = 0; i < values.size(); ++i) {
    const LerobotFeature& feature = spec_.features[i];
    const std::size_t expected = feature.kind == LerobotFeature::Kind::values ? feature.parts.size() : 1;
    if (values[i].size() != expected)
      throw RunError(path_ + ": " + feature.name + " has " + std::to_string(values[i].size()) + " values: expected " + std::to_string(expected));
    stats_[i].add({values[i].begin(), values[i].end()});
    columns_[i].push_back(std::move(values[i]));
  }
  times_ns_.push_back(since_ns);
}

void LerobotDataset::end_episode(const std::string& info) {
  const std::size_t rows = times_ns_.size() - count_rows();
  for (std::size_t i = 0; i < videos_.size(); ++i)
    if (videos_[i].count != times_ns_.size())
      throw RunError(path_ + ": " + spec_.videos[i] + " has " + std::to_string(videos_[i].count) + " pictures at " +
                     std::to_string(times_ns_.size()) + " instants: all cameras must have one rate");
  if (rows == 0) return;
  episodes_.push_back({std::int64_t(rows), info});
  begin_ns_ = std::int64_t(std::llround(double(times_ns_.size()) / rate() * 1e9));
}

// A whole number where it is one.
double LerobotDataset::rate() const {
  if (spec_.rate_hz > 0) return spec_.rate_hz;
  const auto rows = std::size_t(episodes_.empty() ? 0 : episodes_.front().length);
  if (rows < 2) return 1;
  const double rate = double(rows - 1) * 1e9 / double(times_ns_[rows - 1]);
  return std::fabs(rate - std::round(rate)) < 1e-4 ? std::round(rate) : rate;
}

void LerobotDataset::write_table() {
  const std::size_t rows = times_ns_.size();
  std::vector<float> times;
  Numbers within, episodes, numbers;
  for (std::size_t episode = 0; episode < episodes_.size(); ++episode)
    for (std::int64_t i = 0; i < episodes_[episode].length; ++i) {
      within.push_back(i);
      episodes.push_back(std::int64_t(episode));
      times.push_back(float(double(times_ns_[numbers.size()]) * 1e-9));
      numbers.push_back(std::int64_t(numbers.size()));
    }
  ParquetTable table;
  for (std::size_t i = 0; i < spec_.features.size(); ++i) {
    const LerobotFeature& feature = spec_.features[i];
    std::vector<float> values;
    if (feature.kind != LerobotFeature::Kind::values)
      for (const std::vector<float>& row : columns_[i]) values.push_back(row.front());
    if (feature.kind == LerobotFeature::Kind::values)
      table.add_lists(feature.name, columns_[i]);
    else if (feature.kind == LerobotFeature::Kind::number)
      table.add(feature.name, values);
    else
      table.add(feature.name, std::vector<bool>(values.begin(), values.end()));
  }
  table.add("timestamp", times);
  table.add("frame_index", within);
  table.add("episode_index", episodes);
  table.add("index", numbers);
  table.add("task_index", Numbers(rows, 0));
  folder_.write("data" + kFirstFile + ".parquet", table.encode());
}

void LerobotDataset::write_episodes() {
  const std::size_t count = episodes_.size();
  const Numbers zeros(count, 0);
  Numbers index, length, from, to;
  std::vector<std::string> infos;
  for (const Episode& episode : episodes_) {
    index.push_back(std::int64_t(index.size()));
    length.push_back(episode.length);
    from.push_back(to.empty() ? 0 : to.back());
    to.push_back(from.back() + episode.length);
    infos.push_back(episode.info);
  }
  ParquetTable episodes;
  episodes.add("episode_index", index);
  episodes.add_lists("tasks", std::vector<std::vector<std::string>>(count, {spec_.task}));
  episodes.add("length", length);
  for (const char* name : {"data/chunk_index", "data/file_index"}) episodes.add(name, zeros);
  episodes.add("dataset_from_index", from);
  episodes.add("dataset_to_index", to);
  std::vector<double> begins, ends;
  for (const std::int64_t row : from) begins.push_back(double(row) / rate());
  for (const std::int64_t row : to) ends.push_back(double(row) / rate());
  for (const std::string& name : spec_.videos) {
    const std::string video = "videos/" + name;
    episodes.add(video + "/chunk_index", zeros);
    episodes.add(video + "/file_index", zeros);
    episodes.add(video + "/from_timestamp", begins);
    episodes.add(video + "/to_timestamp", ends);
  }
  for (const char* name : {"meta/episodes/chunk_index", "meta/episodes/file_index"}) episodes.add(name, zeros);
  if (spec_.infos) episodes.add("info", infos);
  folder_.write("meta/episodes" + kFirstFile + ".parquet", episodes.encode());

  ParquetTable tasks;
  tasks.add("task_index", Numbers{0});
  tasks.add("__index_level_0__", std::vector<std::string>{spec_.task});
  tasks.set_metadata("pandas", pandas_index().dump());
  folder_.write("meta/tasks.parquet", tasks.encode());
}

std::string LerobotDataset::info_json() const {
  LerobotJson features;
  for (std::size_t i = 0; i < videos_.size(); ++i) {
    const Video& video = videos_[i];
    features[spec_.videos[i]] = {
        {"dtype", "video"},
        {"shape", {video.height, video.width, 3}},
        {"names", {"height", "width", "channels"}},
        {"info", {{"video.height", video.height}, {"video.width", video.width}, {"video.codec", "mjpeg"}, {"video.pix_fmt", "yuvj420p"},
                  {"video.is_depth_map", false}, {"video.fps", rate()}, {"video.channels", 3}, {"has_audio", false}}}};
  }
  for (const LerobotFeature& feature : spec_.features)
    if (feature.kind == LerobotFeature::Kind::values)
      features[feature.name] = {{"dtype", "float32"}, {"shape", {feature.parts.size()}}, {"names", feature.parts}};
    else
      features[feature.name] = {
          {"dtype", feature.kind == LerobotFeature::Kind::flag ? "bool" : "float32"}, {"shape", {1}}, {"names", nullptr}};
  features["timestamp"] = {{"dtype", "float32"}, {"shape", {1}}, {"names", nullptr}};
  for (const char* name : {"frame_index", "episode_index", "index", "task_index"})
    features[name] = {{"dtype", "int64"}, {"shape", {1}}, {"names", nullptr}};
  const std::string file = "/chunk-{chunk_index:03d}/file-{file_index:03d}";
  LerobotJson info{{"codebase_version", "v3.0"},
                   {"robot_type", spec_.robot_type ? LerobotJson(*spec_.robot_type) : LerobotJson(nullptr)},
                   {"total_episodes", episodes_.size()},
                   {"total_frames", times_ns_.size()},
                   {"total_tasks", 1},
                   {"chunks_size", 1000},
                   {"data_files_size_in_mb", 100},
                   {"video_files_size_in_mb", 200},
                   {"fps", rate()},
                   {"splits", {{"train", "0:" + std::to_string(episodes_.size())}}},
                   {"data_path", "data" + file + ".parquet"},
                   {"video_path", "videos/{video_key}" + file + ".mp4"},
                   {"features", features}};
  if (rate() == std::round(rate())) info["fps"] = std::int64_t(rate());  // readers want a whole number
  return info.dump(4) + "\n";
}

std::string LerobotDataset::stats_json() const {
  LerobotJson stats;
  for (std::size_t i = 0; i < videos_.size(); ++i) stats[spec_.videos[i]] = stats_of(videos_[i].stats, true);
  for (std::size_t i = 0; i < spec_.features.size(); ++i) stats[spec_.features[i].name] = stats_of(stats_[i], false);
  return stats.dump(4) + "\n";
}

void LerobotDataset::finish() {
  if (count_rows() != times_ns_.size()) throw RunError(path_ + ": the last episode has not ended");
  if (episodes_.empty()) throw RunError(path_ + ": no episode was recorded");
  folder_.wait();
  for (std::size_t i = 0; i < videos_.size(); ++i) folder_.append(video_file(i), videos_[i].file->tail());
  write_table();
  write_episodes();
  folder_.write("meta/info.json", info_json());
  folder_.write("meta/stats.json", stats_json());
  folder_.finish();
}

}  // namespace rubble
