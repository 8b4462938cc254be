#include "app/recorders.h"

#include "io/contact_sheet.h"
#include "io/mcap_recorder.h"
#include "io/rawlog_recorder.h"
#include "io/rosbag_recorder.h"
#include "io/tum_recorder.h"

namespace rubble {

RecorderSet make_recorders(const OutputScenario& outputs, int frames, const std::string& title,
                           const RunFolder& folder) {
  RecorderSet set;
  const auto add = [&](bool wanted, const char* name, const auto& make) {
    if (!wanted) return;
    set.names.push_back(name);
    set.recorders.push_back(make(folder.file(name)));
  };
  RosOptions ros;
  if (outputs.depth == DepthEncoding::metres) ros.depth = RosDepth::metres;
  if (outputs.pictures == PictureEncoding::png) ros.pictures = RosPictures::png;
  if (outputs.pictures == PictureEncoding::jpeg) ros.pictures = RosPictures::jpeg;
  add(outputs.rawlog, "mission.rawlog",
      [](const std::string& p) { return make_rawlog_recorder(p); });
  add(outputs.bag, "mission.bag",
      [&](const std::string& p) { return make_rosbag_recorder(p, ros); });
  add(outputs.mcap, "mission.mcap",
      [&](const std::string& p) { return make_mcap_recorder(p, ros); });
  add(outputs.groundtruth, "groundtruth.txt",
      [](const std::string& p) { return make_tum_trajectory_recorder(p); });
  ContactSheetOptions sheet;
  sheet.total_frames = frames;
  sheet.title = title;
  add(outputs.preview, "preview.png",
      [&](const std::string& p) { return make_contact_sheet_recorder(p, sheet); });
  return set;
}

}  // namespace rubble
