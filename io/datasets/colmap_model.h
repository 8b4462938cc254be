// COLMAP's sparse models, read back: text and binary (https://colmap.github.io/format.html).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

struct ColmapCamera {
  std::uint32_t id = 0;                 // unique among the cameras
  std::string model;                    // e.g. "PINHOLE"
  std::uint64_t width = 0, height = 0;  // unit: pixel
  std::vector<double> params;           // as many as the model has; pixel centres at 0.5
};

inline constexpr std::uint64_t kNoColmapPoint = ~std::uint64_t{0};

struct ColmapFeature {
  double x = 0, y = 0;                   // unit: pixel
  std::uint64_t point = kNoColmapPoint;  // id of the point seen there
};

struct ColmapImage {
  std::uint32_t id = 0, camera = 0;  // ids of the image and of its camera
  std::string name;                  // of the picture file
  Pose camera_from_world;  // optical frame; the model's own world and unit of length
  std::vector<ColmapFeature> features;  // in the order of the file
};

struct ColmapTrackElement {
  std::uint32_t image = 0, feature = 0;  // id of an image, index into its features
};

struct ColmapPoint {
  std::uint64_t id = 0;                   // unique among the points
  Vec3 position;                          // in the model's world; unit: the model's
  std::uint8_t rgb[3] = {0, 0, 0};        // range: 0 to 255
  double error = 0;                       // mean reprojection error; unit: pixel
  std::vector<ColmapTrackElement> track;  // where images see it
};

struct ColmapModel {
  std::string folder;                 // that it was read from
  std::vector<ColmapCamera> cameras;  // each list in the order of the file
  std::vector<ColmapImage> images;    // that were registered
  std::vector<ColmapPoint> points;    // that were triangulated
};

// Numbers that a camera model of COLMAP has; 0 for one that COLMAP 3.8 does not know.
std::size_t colmap_parameter_count(const std::string& model);
// By COLMAP's number of the model; empty for one that it does not know.
std::string colmap_model_name(int number);

// Whether the folder holds cameras, images and points3D, all as .bin or all as .txt.
bool is_colmap_model(const std::string& folder);

// Reads the binary files where all three are there, as COLMAP does, else the text. Throws
// InputError with file and line (text) or byte (binary) for: a missing file, one that ends early, a
// number that is none or not finite, an unknown camera model, a rotation of length 0, an id that
// repeats or that no list has, a track and an image that do not agree.
ColmapModel load_colmap_model(const std::string& folder);

}  // namespace rubble
