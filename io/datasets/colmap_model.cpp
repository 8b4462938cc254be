#include "io/datasets/colmap_model.h"

#include <filesystem>
#include <unordered_map>

#include "io/datasets/colmap_parts.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

struct CameraModel {
  const char* name;
  std::size_t parameters;
};

// In the order of COLMAP's numbers.
constexpr CameraModel kModels[] = {{"SIMPLE_PINHOLE", 3},
                                   {"PINHOLE", 4},
                                   {"SIMPLE_RADIAL", 4},
                                   {"RADIAL", 5},
                                   {"OPENCV", 8},
                                   {"OPENCV_FISHEYE", 8},
                                   {"FULL_OPENCV", 12},
                                   {"FOV", 5},
                                   {"SIMPLE_RADIAL_FISHEYE", 4},
                                   {"RADIAL_FISHEYE", 5},
                                   {"THIN_PRISM_FISHEYE", 12}};
const char* const kFiles[] = {"cameras", "images", "points3D"};

bool has_all(const std::string& folder, const char* extension) {
  for (const char* name : kFiles)
    if (!std::filesystem::exists(folder + "/" + name + extension)) return false;
  return true;
}

// What only the whole model shows: ids that repeat, or that another file does not have.
class Check {
 public:
  Check(const ColmapParts& parts, bool binary)
      : model_(parts.model), places_(parts.places), binary_(binary) {}

  void run() {
    for (const ColmapCamera& camera : model_.cameras) cameras_.emplace(camera.id, 0);
    for (std::size_t i = 0; i < model_.images.size(); ++i) check_image(i);
    for (std::size_t i = 0; i < model_.points.size(); ++i) check_point(i);
    for (std::size_t i = 0; i < model_.images.size(); ++i)
      for (const ColmapFeature& feature : model_.images[i].features)
        if (feature.point != kNoColmapPoint && !points_.count(feature.point))
          refuse("images", places_.images[i], "sees a point that is not there",
                 "a POINT3D_ID of the points", std::to_string(feature.point));
  }

 private:
  void check_image(std::size_t i) {
    const ColmapImage& image = model_.images[i];
    if (!images_.emplace(image.id, &image).second)
      refuse("images", places_.images[i], "the id repeats", "a new IMAGE_ID",
             std::to_string(image.id));
    if (!cameras_.count(image.camera))
      refuse("images", places_.images[i], "no such camera", "a CAMERA_ID of the cameras",
             std::to_string(image.camera));
  }

  void check_point(std::size_t i) {
    const ColmapPoint& point = model_.points[i];
    if (!points_.emplace(point.id, 0).second)
      refuse("points3D", places_.points[i], "the id repeats", "a new POINT3D_ID",
             std::to_string(point.id));
    for (const ColmapTrackElement& element : point.track) {
      const auto image = images_.find(element.image);
      if (image == images_.end() || element.feature >= image->second->features.size() ||
          image->second->features[element.feature].point != point.id)
        refuse("points3D", places_.points[i], "the track does not agree with the images",
               "features that see point " + std::to_string(point.id),
               "image " + std::to_string(element.image) + ", feature " +
                   std::to_string(element.feature));
    }
  }

  [[noreturn]] void refuse(const std::string& file, std::size_t place, const std::string& message,
                           const std::string& expected, const std::string& found) const {
    const std::string path = model_.folder + "/" + file + (binary_ ? ".bin" : ".txt");
    const std::string key = binary_ ? "byte " + std::to_string(place) : "";
    throw InputError({path, binary_ ? 0 : int(place), key, message, expected, found, ""});
  }

  const ColmapModel& model_;
  const ColmapPlaces& places_;
  bool binary_;
  std::unordered_map<std::uint32_t, int> cameras_;
  std::unordered_map<std::uint32_t, const ColmapImage*> images_;
  std::unordered_map<std::uint64_t, int> points_;
};

}  // namespace

std::size_t colmap_parameter_count(const std::string& model) {
  for (const CameraModel& m : kModels)
    if (model == m.name) return m.parameters;
  return 0;
}

std::string colmap_model_name(int number) {
  const bool known = number >= 0 && std::size_t(number) < std::size(kModels);
  return known ? kModels[number].name : "";
}

bool is_colmap_model(const std::string& folder) {
  return has_all(folder, ".bin") || has_all(folder, ".txt");
}

ColmapModel load_colmap_model(const std::string& folder) {
  const bool binary = has_all(folder, ".bin");
  if (!binary && !has_all(folder, ".txt")) {
    std::string found;
    for (const char* name : kFiles)
      for (const char* extension : {".bin", ".txt"})
        if (std::filesystem::exists(folder + "/" + name + extension))
          found += (found.empty() ? "" : ", ") + std::string(name) + extension;
    throw InputError({folder, 0, "", "is no whole COLMAP model",
                      "cameras, images and points3D, all as .bin or all as .txt",
                      found.empty() ? "none of them" : found, ""});
  }
  ColmapParts parts = binary ? read_colmap_binary(folder) : read_colmap_text(folder);
  Check(parts, binary).run();
  return std::move(parts.model);
}

}  // namespace rubble
