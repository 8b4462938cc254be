#include <cmath>
#include <nlohmann/json.hpp>
#include <unordered_set>

#include "io/base/folder_writer.h"
#include "io/base/little_endian.h"
#include "io/datasets/dataset_recorders.h"
#include "io/datasets/pose_rows.h"
#include "io/image/image_file.h"
#include "io/recording/frame_order.h"
#include "kernel/base/number_text.h"

namespace rubble {
namespace {

using NerfJson = nlohmann::ordered_json;

constexpr double kMillimetre = 0.001;

// nerfstudio measures pixels from the corner of the picture: ours are half a pixel less.
NerfJson intrinsics_json(const Intrinsics& k) {
  NerfJson json{{"w", k.width}, {"h", k.height}, {"fl_x", k.fx}, {"fl_y", k.fy}, {"cx", k.cx + 0.5}, {"cy", k.cy + 0.5}};
  const bool fisheye = k.lens == LensModel::fisheye;
  const char* names[] = {"k1", "k2", fisheye ? "k3" : "p1", fisheye ? "k4" : "p2", "k3"};
  for (std::size_t i = 0; i < (fisheye ? 4u : 5u); ++i) json[names[i]] = k.distortion[i];
  return json;
}

// From the optical frame to OpenGL's: Y and Z the other way round.
NerfJson camera_to_world(const Pose& world_from_camera) {
  NerfJson matrix = NerfJson::array();
  const auto rows = pose_rows(world_from_camera * camera_from_optical);
  for (std::size_t i = 0; i < 12; i += 4) matrix.push_back({rows[i], -rows[i + 1], -rows[i + 2], rows[i + 3]});
  matrix.push_back({0.0, 0.0, 0.0, 1.0});
  return matrix;
}

// What is seen of surfaces, thinned to one point for each voxel: the first one there.
class SurfacePoints {
 public:
  // ray: empty: of a pinhole.
  void add(const Frame& frame, const PixelRay& ray) {
    const Intrinsics& k = frame.intrinsics;
    for (int v = 0; v < k.height; v += kStride) {
      const Pose world_from_optical = frame.world_from_optical(v);
      for (int u = 0; u < k.width; u += kStride) {
        const std::size_t pixel = std::size_t(v) * std::size_t(k.width) + std::size_t(u);
        const float depth = frame.depth[pixel];
        if (!(depth > 0) || !(depth < kFarthest)) continue;
        const std::optional<Vec3> along = ray ? ray(u, v) : Vec3{(u - k.cx) / k.fx, (v - k.cy) / k.fy, 1};
        if (!along || !(along->z > 0)) continue;
        add_point(world_from_optical * (*along * (double(depth) / along->z)), &frame.rgb[3 * pixel]);
      }
    }
  }

  std::string ply() const {
    return "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(points_.size()) +
           "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
           "property uchar blue\nend_header\n" +
           bytes_;
  }

 private:
  static constexpr int kStride = 4;          // of the pixels that are looked at
  static constexpr double kVoxel = 0.05;     // unit: m
  static constexpr float kFarthest = 65;     // what depth in millimetres can hold; unit: m

  void add_point(const Vec3& point, const std::uint8_t* rgb) {
    std::uint64_t key = 0;
    for (int i = 0; i < 3; ++i)
      key = key << 21 | (std::uint64_t(std::int64_t(std::floor(point[i] / kVoxel)) + (1 << 20)) & 0x1fffff);
    if (!points_.insert(key).second) return;
    for (int i = 0; i < 3; ++i) put(bytes_, float(point[i]));
    bytes_.append(reinterpret_cast<const char*>(rgb), 3);
  }

  std::unordered_set<std::uint64_t> points_;  // asked only whether a voxel is in it
  std::string bytes_;
};

class NerfstudioRecorder : public Recorder {
 public:
  NerfstudioRecorder(const std::string& path, const Recording& recording, std::vector<PixelRay> rays, int threads)
      : recording_(recording),
        order_(path, std::vector<Channels>(recording.cameras.size())),
        folder_(path, {"images", "depths"}, threads),
        rays_(std::move(rays)) {
    rays_.resize(recording.cameras.size());
  }

  void write(const Frame& frame) override {
    order_.check(frame);
    const auto camera = std::size_t(frame.sensor);
    const Intrinsics& k = frame.intrinsics;
    // nerfstudio makes smaller pictures in one folder, whatever folders they came from.
    const std::string name =
        (recording_.cameras.size() > 1 ? recording_.cameras[camera].name + "_" : "") + index_text(frame.index) + ".png";
    folder_.add("images/" + name, [image = RgbImage{k.width, k.height, frame.rgb}] { return encode_png(image); });
    const bool measured = recording_.cameras[camera].channels.measured_depth;
    folder_.add("depths/" + name,
                [image = DepthImage{k.width, k.height, encode_depth(measured ? frame.measured_depth : frame.depth, kMillimetre)}] {
                  return encode_png(image);
                });
    add_entry(frame, name);
    points_.add(frame, rays_[camera]);
  }

  void finish() override {
    const char* models[] = {"OPENCV", "OPENCV_FISHEYE"};
    NerfJson json{{"camera_model", models[fisheye_ ? 1 : 0]}};
    if (recording_.cameras.size() == 1) json.update(first_);
    json["depth_unit_scale_factor"] = kMillimetre;
    json["ply_file_path"] = "sparse_pc.ply";
    json["frames"] = frames_;
    folder_.write("transforms.json", json.dump(1) + "\n");
    folder_.write("sparse_pc.ply", points_.ply());
    folder_.finish();
  }

 private:
  void add_entry(const Frame& frame, const std::string& name) {
    const NerfJson intrinsics = intrinsics_json(frame.intrinsics);
    if (frames_.empty()) first_ = intrinsics;
    fisheye_ = frame.intrinsics.lens == LensModel::fisheye;
    NerfJson entry{{"file_path", "images/" + name}, {"depth_file_path", "depths/" + name}};
    if (recording_.cameras.size() > 1) entry.update(intrinsics);
    entry["stamp_ns"] = frame.stamp_ns;
    entry["transform_matrix"] = camera_to_world(frame.world_from_camera);
    frames_.push_back(std::move(entry));
  }

  Recording recording_;
  FrameOrder order_;
  FolderWriter folder_;
  std::vector<PixelRay> rays_;                 // by camera
  bool fisheye_ = false;                       // all cameras: the missions check that
  NerfJson first_;                             // intrinsics of the first frame
  NerfJson frames_ = NerfJson::array();        // the entries, so far
  SurfacePoints points_;
};

}  // namespace

std::unique_ptr<Recorder> make_nerfstudio_recorder(const std::string& path, const Recording& recording, std::vector<PixelRay> rays,
                                                   int threads) {
  return std::make_unique<NerfstudioRecorder>(path, recording, std::move(rays), threads);
}

}  // namespace rubble
