// A LeRobot dataset, version 3.0: episodes of rows, with values, and a picture of each camera for every row.
//
//   meta/info.json, meta/stats.json, meta/tasks.parquet, meta/episodes/chunk-000/file-000.parquet
//   data/chunk-000/file-000.parquet        a row for each instant of each episode
//   videos/NAME/chunk-000/file-000.mp4     colour of each camera, episode after episode: JPEG pictures in MP4
// Depth and ground truth have no place in the format.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/base/folder_writer.h"
#include "io/learning/mp4_file.h"

namespace rubble {

struct LerobotFeature {
  enum class Kind { values, number, flag };  // a list of float32; a float32; true or false
  std::string name;                          // observation.state, action, next.reward
  Kind kind = Kind::values;
  std::vector<std::string> parts{};          // names of the values of a list
};

// Least, most, mean and deviation of each value of a feature.
struct LerobotStats {
  std::uint64_t count = 0;
  std::vector<double> least{}, most{}, sum{}, squares{};

  void add(const std::vector<double>& values);
};

class LerobotDataset {
 public:
  struct Spec {
    std::vector<std::string> videos{};         // observation.images.NAME
    std::vector<LerobotFeature> features{};    // in the order of the columns
    std::optional<std::string> robot_type{};
    std::string task{};
    double rate_hz = 0;                        // of the rows; 0: that of the times of the first episode
    bool infos = false;                        // whether the table of episodes has a column of texts about them
  };

  // Writes into "PATH.part" until finish(). Throws RunError when `path` cannot be created.
  LerobotDataset(const std::string& path, Spec spec, int threads);

  // since_ns: of the picture or row, since the first of its episode. values: of each feature, one for numbers and flags.
  void add_picture(std::size_t video, std::int64_t since_ns, int width, int height, std::vector<std::uint8_t> rgb);
  void add_row(std::int64_t since_ns, std::vector<std::vector<float>> values);
  // Of the rows since the last one. Throws RunError where a camera has another number of pictures than there are rows.
  void end_episode(const std::string& info = "");
  // After the end of the last episode. Throws RunError where there is none.
  void finish();

  const std::string& path() const { return path_; }

 private:
  struct Video {
    std::optional<Mp4Video> file;
    int width = 0, height = 0;
    std::size_t count = 0;  // of all episodes
    LerobotStats stats;     // of colours, 0 to 1
  };
  struct Episode {
    std::int64_t length = 0;
    std::string info;
  };

  std::string video_file(std::size_t video) const;
  std::size_t count_rows() const;  // of episodes that ended
  double rate() const;
  void write_table();
  void write_episodes();
  std::string info_json() const;
  std::string stats_json() const;

  Spec spec_;
  FolderWriter folder_;
  std::string path_;  // for messages
  std::vector<Video> videos_;
  std::vector<Episode> episodes_;
  std::vector<std::vector<std::vector<float>>> columns_;  // by feature, of all rows so far
  std::vector<std::int64_t> times_ns_;                    // of all rows so far, each since the first of its episode
  std::int64_t begin_ns_ = 0;                             // of the running episode in the videos
  std::vector<LerobotStats> stats_;                       // by feature
};

}  // namespace rubble
