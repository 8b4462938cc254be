#include "app/formats/recording_formats.h"

#include <algorithm>

#include "io/datasets/colmap_recorder.h"
#include "io/datasets/dataset_recorders.h"
#include "io/datasets/euroc_recorder.h"
#include "io/datasets/frames_recorder.h"
#include "io/datasets/range_scan_recorder.h"
#include "io/datasets/reading_recorder.h"
#include "io/datasets/tum_recorder.h"
#include "io/learning/lerobot_recorder.h"
#include "io/mrpt/rawlog_recorder.h"
#include "io/mrpt/simplemap_recorder.h"
#include "io/recording/contact_sheet.h"
#include "io/ros/mcap_recorder.h"
#include "io/ros/rosbag_recorder.h"
#include "kernel/base/error.h"
#include "render/camera/lens.h"

namespace rubble {
namespace {

using Path = const std::string&;
using In = const RecordingInputs&;
using Size = const RecordedSize&;
using Made = std::unique_ptr<Recorder>;

constexpr double kPreviewBytes = 6e6;  // of a full contact sheet

PixelRay pixel_ray(const MountedCamera& camera) {
  const auto lens = std::make_shared<const Lens>(camera.camera.intrinsics());
  return [lens](double u, double v) { return lens->direction(u, v); };
}

SimplemapOptions simplemap_options(In in) {
  SimplemapOptions options;
  options.recording = in.recording;
  options.ray = pixel_ray(in.scenario.cameras[in.camera]);
  return options;
}

// In the order of the recording's cameras, which are all of the mission's.
std::vector<PixelRay> pixel_rays(In in) {
  std::vector<PixelRay> rays;
  for (const MountedCamera& camera : in.scenario.cameras) rays.push_back(pixel_ray(camera));
  return rays;
}

RawlogOptions rawlog_options(In in) {
  RawlogOptions options;
  options.gzip_level = in.scenario.outputs.rawlog_gzip;
  options.recording = in.recording;
  const auto& robots = in.recording.robots;
  const auto robot =
      std::find_if(robots.begin(), robots.end(), [](const RobotRecord& r) { return r.has_odometry; });
  if (in.scenario.outputs.rawlog_format == RawlogFormat::actions && robot != robots.end())
    options.actions_of = int(robot - robots.begin());
  return options;
}

ContactSheetOptions sheet_options(In in) {
  ContactSheetOptions sheet;
  sheet.total_frames = in.frames.at(0);
  sheet.title = in.title;
  const std::vector<SensorRecord>& sensors = in.recording.sensors;
  const auto first = std::find_if(sensors.begin(), sensors.end(), [](const SensorRecord& sensor) { return sensor.scans(); });
  if (first != sensors.end()) {
    sheet.scanner = first->name, sheet.scanner_number = int(first - sensors.begin());
    sheet.columns = 2;  // three pictures beside each other are wide
  }
  return sheet;
}

double size_of_simplemap_frame(const CameraScenario& camera) {
  const double across = std::min(camera.width, SimplemapOptions().points_across);
  return 16 * across * (across * camera.height / camera.width + 1) + kFrameOverhead;
}

RosOptions ros_of(In in) { return ros_options(in.scenario.outputs, in.recording); }

// Scans, and joints, odometry, transforms and contacts of robots; unit: byte.
double size_of_ros_samples(const FlightSize& flight) {
  return size_of_scans(flight, 500, 22) + 3000 * flight.robot_samples;
}

constexpr HeldSamples kFrames{}, kAll{true, true, true, true, false}, kInertial{true, false, false, false, true},
    kScans{false, true}, kReadings{false, false, true}, kRobots{false, false, false, true};

// Rows: key, what it leaves, whether that is a folder, the member that asks for it, what it holds, the recorder,
// the size, whether it holds one camera.
const std::vector<RecordingFormat> kFormats{
    {"rawlog", "mission.rawlog", false, &OutputScenario::rawlog, kAll,
     [](Path p, In in) -> Made {
       return make_rawlog_recorder(p, rawlog_options(in));
     },
     [](Size s) {
       return s.of(s.picture.rawlog() + kFrameOverhead, 420) + size_of_scans(s.flight, 2000, 16) +
              700 * s.flight.robot_samples;
     }},
    {"simplemap", "mission.simplemap", false, &OutputScenario::simplemap, kFrames,
     [](Path p, In in) -> Made {
       return make_simplemap_recorder(p, simplemap_options(in));
     },
     [](Size s) { return s.flight.key_frames * size_of_simplemap_frame(s.camera.camera) + 1000; },
     true},
    {"bag", "mission.bag", false, &OutputScenario::bag, kAll,
     [](Path p, In in) -> Made { return make_rosbag_recorder(p, ros_of(in)); },
     [](Size s) {
       return s.of(s.picture.ros() + kFrameOverhead, 420, s.legend) + size_of_ros_samples(s.flight);
     }},
    {"mcap", "mission.mcap", false, &OutputScenario::mcap, kAll,
     [](Path p, In in) -> Made { return make_mcap_recorder(p, ros_of(in)); },
     [](Size s) {
       return s.of(s.picture.ros() + kFrameOverhead, 420, s.legend + 1e5) + size_of_ros_samples(s.flight);
     },
     false, false, kBagMetadata},
    {"groundtruth", "groundtruth.txt", false, &OutputScenario::groundtruth, kFrames,
     [](Path p, In) -> Made { return make_tum_trajectory_recorder(p); },
     [](Size s) { return s.of(140, 0, 100); }, true},
    {"tum", "tum", true, &OutputScenario::tum, kFrames,
     [](Path p, In in) -> Made { return make_tum_recorder(p, in.recording); },
     [](Size s) { return s.of(s.picture.tum() + 3 * kPictureOverhead, 0, 2000); }, true},
    {"euroc", "euroc", true, &OutputScenario::euroc, kInertial,
     [](Path p, In in) -> Made { return make_euroc_recorder(p, in.recording); },
     [](Size s) { return s.of(s.picture.euroc() + 2 * kPictureOverhead, 500, 10000); }},
    {"colmap", "colmap", true, &OutputScenario::colmap, kFrames,
     [](Path p, In in) -> Made { return make_colmap_recorder(p, in.recording); },
     [](Size s) { return s.of(s.picture.colours() + 4 * kPictureOverhead, 0, 4000); }},
    {"frames", "frames", true, &OutputScenario::frames, kInertial,
     [](Path p, In in) -> Made { return make_frames_recorder(p, in.recording); },
     [](Size s) {
       const double files = kPictureOverhead * PictureSize::most_files();
       return s.of(s.picture.frames() + files, 320, s.legend);
     },
     true},
    {"pcd", "pcd", true, &OutputScenario::pcd, kScans,
     [](Path p, In in) -> Made { return make_pcd_recorder(p, in.recording); },
     [](Size s) { return size_of_scans(s.flight, kPictureOverhead + 1.1e5, 22); }},
    {"kitti", "kitti", true, &OutputScenario::kitti, kScans,
     [](Path p, In in) -> Made { return make_kitti_recorder(p, in.recording); },
     [](Size s) { return size_of_scans(s.flight, kPictureOverhead, 16); }},
    {"kitti_odometry", "kitti_odometry", true, &OutputScenario::kitti_odometry, kScans,
     [](Path p, In in) -> Made { return make_kitti_odometry_recorder(p, in.recording); },
     [](Size s) {
       return s.of(s.picture.colours() * 4 / 3 + 5 * kPictureOverhead, 0, 2000) + size_of_scans(s.flight, kPictureOverhead, 16);
     },
     true},
    {"nerfstudio", "nerfstudio", true, &OutputScenario::nerfstudio, kFrames,
     [](Path p, In in) -> Made { return make_nerfstudio_recorder(p, in.recording, pixel_rays(in)); },
     [](Size s) { return s.of(s.picture.nerfstudio() + 4 * kPictureOverhead, 0, 2000); }},
    {"coco", "coco", true, &OutputScenario::coco, kFrames,
     [](Path p, In in) -> Made { return make_coco_recorder(p, in.recording); },
     [](Size s) { return s.of(s.picture.coco() + 2 * kPictureOverhead, 0, s.legend); }, true},
    {"webdataset", "webdataset", true, &OutputScenario::webdataset, kFrames,
     [](Path p, In in) -> Made { return make_webdataset_recorder(p, in.recording); },
     [](Size s) { return s.of(s.picture.frames() + kPictureOverhead * PictureSize::most_files(), 0, s.legend); }, true},
    {"lerobot", "lerobot", true, &OutputScenario::lerobot, kRobots,
     [](Path p, In in) -> Made { return make_lerobot_recorder(p, in.recording); },
     [](Size s) { return s.of(s.picture.colours() + kFrameOverhead, 0, 2e4); }},
    {"sensors", "sensors", true, &OutputScenario::sensors, kReadings,
     [](Path p, In in) -> Made { return make_reading_recorder(p, in.recording); },
     [](Size s) { return s.flight.readings * 200; }, false, true},
    {"preview", "preview.png", false, &OutputScenario::preview, kScans,
     [](Path p, In in) -> Made {
       return make_contact_sheet_recorder(p, sheet_options(in));
     },
     [](Size) { return kPreviewBytes; }, true},
};

}  // namespace

const std::vector<RecordingFormat>& recording_formats() { return kFormats; }

bool is_wanted(const RecordingFormat& format, const Scenario& scenario) {
  return scenario.outputs.*format.wanted && !(format.of_sensors && std::all_of(scenario.sensors.begin(), scenario.sensors.end(), scans));
}

const RecordingFormat& find_recording_format(const std::string& name) {
  std::string names;
  for (const RecordingFormat& format : kFormats) {
    if (format.name == name) return format;
    names += (names.empty() ? "" : ", ") + format.name;
  }
  throw InputError({"", 0, "", "unknown recording format", "one of " + names, "`" + name + "`", ""});
}

RosOptions ros_options(const OutputScenario& outputs, const Recording& recording) {
  RosOptions ros;
  ros.recording = recording;
  if (outputs.depth == DepthEncoding::metres) ros.depth = RosDepth::metres;
  if (outputs.pictures == PictureEncoding::png) ros.pictures = RosPictures::png;
  if (outputs.pictures == PictureEncoding::jpeg) ros.pictures = RosPictures::jpeg;
  ros.vector_colours = outputs.vectors == VectorEncoding::colours;
  return ros;
}

}  // namespace rubble
