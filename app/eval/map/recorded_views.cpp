#include "app/eval/map/recorded_views.h"

#include <filesystem>

#include "app/eval/scores/trajectory_file.h"
#include "kernel/base/error.h"

namespace rubble {

void RecordedViews::add(const RecordedCamera& added, const std::vector<Pose>& poses) {
  camera.insert(camera.end(), poses.size(), cameras.size());
  cameras.push_back(added);
  world_from_optical.insert(world_from_optical.end(), poses.begin(), poses.end());
}

bool RecordedViews::has_in_picture(std::size_t frame, const Vec3& point) const {
  const auto& [intrinsics, lens, range] = camera_of(frame);
  const Vec3 p = world_from_optical[frame].rotation.conjugate().rotate(
      point - world_from_optical[frame].translation);
  if (p.z < range.nearest || p.z > range.farthest) return false;
  const auto at = lens.project(p);
  // A pixel reaches half a pixel to each side of its centre.
  return at && at->u >= -0.5 && at->v >= -0.5 && at->u <= intrinsics.width - 0.5 &&
         at->v <= intrinsics.height - 0.5;
}

std::optional<Vec3> RecordedViews::direction(std::size_t frame, double u, double v) const {
  const std::optional<Vec3> optical = camera_of(frame).lens.direction(u, v);
  if (!optical) return std::nullopt;
  return world_from_optical[frame].rotation.rotate(*optical);
}

std::vector<Pose> load_true_poses(const std::string& folder) {
  const std::string path = folder + "/groundtruth.txt";
  if (!std::filesystem::exists(path))
    throw InputError({path, 0, "", "the run has no true poses", "groundtruth.txt", "no such file",
                      "run the mission with outputs.groundtruth = true, which is the default"});
  std::vector<Pose> poses;
  for (const StampedPose& pose : load_trajectory(path)) poses.push_back(pose.world_from_body);
  return poses;
}

}  // namespace rubble
