#include "io/playback/picture_sources.h"

#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <exception>

#include "kernel/base/system/disk_cache.h"
#include "kernel/base/error.h"
#include "kernel/base/read_file.h"
#include "kernel/base/system/isolated_worker.h"

namespace rubble {
namespace {

using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationImage;

RecordedPicture colour_of(const mrpt::img::CImage& image) {
  RecordedPicture picture;
  picture.width = static_cast<int>(image.getWidth());
  picture.height = static_cast<int>(image.getHeight());
  picture.components = 3;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      for (int c = 2; c >= 0; --c)  // B, G, R in memory
        picture.values.push_back(image.at<std::uint8_t>(
            static_cast<unsigned>(x), static_cast<unsigned>(y), static_cast<std::int8_t>(c)));
  return picture;
}

RecordedPicture depth_of(const CObservation3DRangeScan& scan) {
  RecordedPicture picture;
  picture.width = static_cast<int>(scan.rangeImage.cols());
  picture.height = static_cast<int>(scan.rangeImage.rows());
  picture.step = static_cast<double>(scan.rangeUnits);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      picture.values.push_back(picture.step * scan.rangeImage(y, x));
  return picture;
}

// The label of the observation that has the channel; empty: none has.
std::string label_of(const PictureWanted& wanted) {
  const std::string camera = wanted.camera.empty() ? "camera" : wanted.camera;
  if (wanted.channel == "rgb" || wanted.channel == "measured_depth") return camera;
  if (wanted.channel == "rgb_right") return camera + "_right";
  const std::string truth = (wanted.camera.empty() ? "" : camera + "_") + std::string("ground_truth_depth");
  if (wanted.channel == "depth") return wanted.measured_depth ? truth : camera;
  return "";
}

RecordedPicture picture_of(const mrpt::obs::CObservation& observation, bool colour) {
  if (const auto* right = dynamic_cast<const CObservationImage*>(&observation))
    return colour_of(right->image);
  const auto& scan = dynamic_cast<const CObservation3DRangeScan&>(observation);
  return colour ? colour_of(scan.intensityImage) : depth_of(scan);
}

// Of an object of a rawlog: itself, or those of a sensory frame; none of an action.
std::vector<mrpt::obs::CObservation::Ptr> observations_of(const mrpt::serialization::CSerializable::Ptr& object) {
  if (const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object))
    return {frame->begin(), frame->end()};
  if (std::dynamic_pointer_cast<mrpt::obs::CActionCollection>(object)) return {};
  const auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object);
  if (!observation) throw std::runtime_error("it holds something that is no observation");
  return {observation};
}

// Of no pixels: there is none.
RecordedPicture import_picture(const std::string& path, const std::string& label,
                               const PictureWanted& wanted) {
  check_readable_file(path);
  try {
    mrpt::io::CFileGZInputStream file;
    if (!file.open(path)) throw std::runtime_error("no such file");
    auto archive = mrpt::serialization::archiveFrom(file);
    const bool colour = wanted.channel == "rgb" || wanted.channel == "rgb_right";
    for (int left = wanted.frame; !file.checkEOF();) {
      for (const mrpt::obs::CObservation::Ptr& observation : observations_of(archive.ReadObject())) {
        if (observation->sensorLabel == label && left-- == 0) return picture_of(*observation, colour);
      }
    }
  } catch (const std::exception& error) {
    throw InputError(
        {path, 0, "", std::string("cannot be read as a rawlog: ") + error.what(), "", "", ""});
  }
  return {};
}

}  // namespace

std::optional<RecordedPicture> find_rawlog_picture(const std::string& folder,
                                                   const PictureWanted& wanted) {
  const std::string label = label_of(wanted), path = folder + "/mission.rawlog";
  if (label.empty()) return std::nullopt;
  const std::string bytes = run_isolated(path, "rawlog", [&] {
    const RecordedPicture picture = import_picture(path, label, wanted);
    CacheWriter writer;
    writer.put(picture.width);
    writer.put(picture.height);
    writer.put(picture.components);
    writer.put(picture.step);
    writer.put(picture.values);
    return writer.bytes();
  });
  CacheReader reader(bytes);
  RecordedPicture picture;
  reader.get(picture.width);
  reader.get(picture.height);
  reader.get(picture.components);
  reader.get(picture.step);
  reader.get(picture.values);
  if (picture.values.empty()) return std::nullopt;
  picture.file = "mission.rawlog";
  return picture;
}

}  // namespace rubble
