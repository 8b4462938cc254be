#include "tests/io/all_recorders.h"

#include <algorithm>
#include <filesystem>

#include "io/datasets/colmap_recorder.h"
#include "io/datasets/dataset_recorders.h"
#include "io/datasets/euroc_recorder.h"
#include "io/datasets/frames_recorder.h"
#include "io/datasets/tum_recorder.h"
#include "io/mrpt/rawlog_recorder.h"
#include "io/mrpt/simplemap_recorder.h"
#include "io/recording/contact_sheet.h"
#include "io/ros/mcap_recorder.h"
#include "io/ros/rosbag_recorder.h"
#include "tests/io/support.h"

namespace rubble::test {
namespace {

RosOptions ros_options(RosDepth depth, RosPictures pictures) {
  return {depth, pictures, full_recording()};
}

ContactSheetOptions sheet_options(int total_frames) {
  ContactSheetOptions options;
  options.total_frames = total_frames;
  options.tile = 96;
  options.columns = 2;
  options.title = "frames";
  return options;
}

}  // namespace

std::vector<RecorderKind> all_recorders(int total_frames) {
  const RosOptions png = ros_options(RosDepth::millimetres, RosPictures::png);
  const RosOptions jpeg = ros_options(RosDepth::metres, RosPictures::jpeg);
  const Recording full = full_recording();
  SimplemapOptions every_frame;
  every_frame.distance = 0;
  const ContactSheetOptions sheet = sheet_options(total_frames);
  return {
      {"rosbag", [](const auto& p) { return make_rosbag_recorder(p); }},
      {"rosbag_png", [=](const auto& p) { return make_rosbag_recorder(p, png); }},
      {"mcap", [](const auto& p) { return make_mcap_recorder(p); }},
      {"mcap_jpeg", [=](const auto& p) { return make_mcap_recorder(p, jpeg); }},
      {"rawlog", [](const auto& p) { return make_rawlog_recorder(p); }},
      {"rawlog_full",
       [=](const auto& p) {
         return make_rawlog_recorder(p, {1, 0.001, full});
       }},
      {"simplemap", [=](const auto& p) { return make_simplemap_recorder(p, every_frame); }},
      {"tum", [=](const auto& p) { return make_tum_recorder(p, full, 2); }},
      {"euroc", [=](const auto& p) { return make_euroc_recorder(p, full, 2); }},
      {"colmap", [=](const auto& p) { return make_colmap_recorder(p, full, 2); }},
      {"frames", [=](const auto& p) { return make_frames_recorder(p, full, 2); }},
      {"kitti_odometry", [=](const auto& p) { return make_kitti_odometry_recorder(p, full, 2); }},
      {"nerfstudio", [=](const auto& p) { return make_nerfstudio_recorder(p, full, {}, 2); }},
      {"coco", [=](const auto& p) { return make_coco_recorder(p, full, 2); }},
      {"webdataset", [=](const auto& p) { return make_webdataset_recorder(p, full, 2); }},
      {"trajectory", [](const auto& p) { return make_tum_trajectory_recorder(p); }},
      {"contact_sheet", [=](const auto& p) { return make_contact_sheet_recorder(p, sheet); }},
  };
}

std::string read_tree(const std::string& path) {
  namespace fs = std::filesystem;
  if (!fs::is_directory(path)) return read_text(path);
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(path))
    if (entry.is_regular_file()) files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  std::string all;
  for (const std::string& file : files)
    all += file.substr(path.size()) + "\n" + read_text(file) + "\n";
  return all;
}

}  // namespace rubble::test
