#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "app/eval/sfm/sfm_score.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

// Models as the mapper numbers them, in order of the numbers.
std::vector<std::string> list_models(const std::string& folder) {
  if (is_colmap_model(folder)) return {folder};
  std::map<int, std::string> numbered;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    int number = 0;
    const char* last = name.data() + name.size();
    const auto [end, failed] = std::from_chars(name.data(), last, number);
    if (entry.is_directory() && failed == std::errc() && end == last)
      numbered[number] = entry.path().string();
  }
  if (error)
    throw InputError({folder, 0, "", "cannot be read", "a folder with COLMAP models",
                      error.message(), "--model says where the models are"});
  if (numbered.empty()) {
    load_colmap_model(folder);  // says what is there of one
  }
  std::vector<std::string> folders;
  for (const auto& [number, path] : numbered) folders.push_back(path);
  return folders;
}

Pose world_from_optical(const ColmapImage& image) { return image.camera_from_world.inverse(); }

SfmSegment make_segment(ColmapModel model, const SfmGroundTruth& truth,
                        const std::map<std::string, int>& frame_of) {
  SfmSegment segment;
  if (model.images.empty())
    throw InputError({model.folder, 0, "", "the model is empty", "at least one image", "none",
                      "COLMAP may have been stopped while it wrote"});
  std::set<int> seen;
  std::vector<Pose> from, to;
  for (const ColmapImage& image : model.images) {
    const auto found = frame_of.find(image.name);
    if (found == frame_of.end())
      throw InputError({model.folder, 0, "", "has an image that is not in the dataset",
                        "names as in " + truth.model.folder, image.name,
                        "is this model of another dataset?"});
    if (!seen.insert(found->second).second)
      throw InputError(
          {model.folder, 0, "", "has an image twice", "each name once", image.name, ""});
    segment.frames.push_back(found->second);
    from.push_back(world_from_optical(image));
    to.push_back(truth.world_from_optical[std::size_t(found->second)]);
  }
  std::vector<Vec3> from_centres, to_centres;
  for (const Pose& pose : from) from_centres.push_back(pose.translation);
  for (const Pose& pose : to) to_centres.push_back(pose.translation);
  segment.by_positions = rubble::align_points(from_centres, to_centres, true);
  segment.by_poses = align_poses(from, to);
  segment.model = std::move(model);
  return segment;
}

// Root mean square distance of the positions from their mean.
double calc_spread(const std::vector<Pose>& poses) {
  Vec3 mean;
  for (const Pose& pose : poses) mean += pose.translation * (1.0 / double(poses.size()));
  double sum = 0;
  for (const Pose& pose : poses) sum += dot(pose.translation - mean, pose.translation - mean);
  return std::sqrt(sum / double(poses.size()));
}

void add_ends(const std::vector<Pose>& poses, double length, std::vector<Vec3>& points) {
  for (const Pose& pose : poses) {
    points.push_back(pose.translation);
    for (const Vec3& axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
      points.push_back(pose * (length * axis));
  }
}

}  // namespace

SfmGroundTruth load_sfm_ground_truth(const std::string& dataset) {
  const std::string folder = dataset + "/colmap/sparse";
  if (!fs::exists(dataset))
    throw InputError(
        {dataset, 0, "", "no such folder", "the output folder of a run", "nothing", ""});
  if (!is_colmap_model(folder))
    throw InputError({dataset, 0, "", "has no ground truth for COLMAP", folder, "nothing",
                      "run the mission with --set outputs.colmap=true"});
  SfmGroundTruth truth{load_colmap_model(folder), {}};
  if (truth.model.images.empty())
    throw InputError(
        {folder + "/images.txt", 0, "", "holds no image", "the true poses", "none", ""});
  for (const ColmapImage& image : truth.model.images)
    truth.world_from_optical.push_back(world_from_optical(image));
  return truth;
}

std::optional<Similarity> align_poses(const std::vector<Pose>& from, const std::vector<Pose>& to) {
  if (from.size() != to.size() || from.size() < 2) return std::nullopt;
  const double spread_from = calc_spread(from), spread_to = calc_spread(to);
  if (!(spread_from > 0) || !(spread_to > 0)) return std::nullopt;
  std::vector<Vec3> a, b;
  add_ends(from, spread_from, a);
  add_ends(to, spread_to, b);
  return rubble::align_points(a, b, true);
}

std::vector<SfmSegment> load_segments(const std::string& folder, const SfmGroundTruth& truth) {
  std::map<std::string, int> frame_of;
  for (std::size_t i = 0; i < truth.model.images.size(); ++i)
    frame_of[truth.model.images[i].name] = int(i);
  std::vector<SfmSegment> segments;
  for (const std::string& path : list_models(folder))
    segments.push_back(make_segment(load_colmap_model(path), truth, frame_of));
  std::stable_sort(segments.begin(), segments.end(), [](const SfmSegment& a, const SfmSegment& b) {
    return a.frames.size() > b.frames.size();
  });
  return segments;
}

void align_to_world(const std::string& folder, const SfmGroundTruth& truth,
                    std::vector<Vec3>& points) {
  const std::vector<SfmSegment> segments = load_segments(folder, truth);
  if (!segments.front().by_poses)
    throw InputError({folder, 0, "--align", "cannot be aligned", "cameras at two different places",
                      std::to_string(segments.front().frames.size()) + " cameras", ""});
  for (Vec3& p : points) p = *segments.front().by_poses * p;
}

}  // namespace rubble
