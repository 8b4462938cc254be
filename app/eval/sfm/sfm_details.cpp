#include "app/eval/sfm/sfm_details.h"

#include <map>

#include "io/base/atomic_file.h"
#include "io/base/escaped_text.h"
#include "io/base/little_endian.h"
#include "kernel/base/number_text.h"

namespace rubble {
namespace {

void write_points(const std::string& path, const std::vector<SfmSegment>& segments) {
  std::string bytes;
  std::size_t count = 0;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    if (!segments[s].by_poses) continue;
    for (const ColmapPoint& point : segments[s].model.points) {
      const Vec3 p = *segments[s].by_poses * point.position;
      for (int i = 0; i < 3; ++i) put(bytes, float(p[i]));
      for (const std::uint8_t c : point.rgb) put(bytes, c);
      put(bytes, std::int32_t(s));
      ++count;
    }
  }
  write_text_file(path, "ply\nformat binary_little_endian 1.0\nelement vertex " +
                            std::to_string(count) +
                            "\nproperty float x\nproperty float y\nproperty float z\n"
                            "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                            "property int segment\nend_header\n" +
                            bytes);
}

std::string position_text(const Vec3& p) {
  return exact_text(p.x) + "," + exact_text(p.y) + "," + exact_text(p.z);
}

void write_track(const std::string& path, const std::vector<SfmSegment>& segments,
                 const SfmGroundTruth& truth) {
  std::map<int, std::string> rows;  // by frame
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const SfmSegment& segment = segments[s];
    if (!segment.for_positions()) continue;
    for (std::size_t i = 0; i < segment.frames.size(); ++i) {
      const ColmapImage& image = segment.model.images[i];
      const Vec3 estimate =
          *segment.for_positions() * image.camera_from_world.inverse().translation;
      const Vec3& true_position =
          truth.world_from_optical[std::size_t(segment.frames[i])].translation;
      rows[segment.frames[i]] += std::to_string(segment.frames[i]) + "," + csv_text(image.name) + "," +
                                 std::to_string(s) + "," + position_text(estimate) + "," +
                                 position_text(true_position) + "," +
                                 exact_text(distance(estimate, true_position)) + "\n";
    }
  }
  std::string text = "frame,image,segment,x,y,z,true_x,true_y,true_z,error_m\n";
  for (const auto& [frame, row] : rows) text += row;
  write_text_file(path, text);
}

}  // namespace

void write_sfm_details(const std::string& folder, const std::string& name,
                       const std::vector<SfmSegment>& segments, const SfmGroundTruth& truth) {
  write_points(folder + "/" + name + "_points.ply", segments);
  write_track(folder + "/" + name + "_track.csv", segments, truth);
}

}  // namespace rubble
