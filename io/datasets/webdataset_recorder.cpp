#include <nlohmann/json.hpp>

#include "io/base/folder_writer.h"
#include "io/base/little_endian.h"
#include "io/base/tar_text.h"
#include "io/datasets/dataset_recorders.h"
#include "io/image/image_file.h"
#include "io/recording/frame_order.h"
#include "kernel/base/number_text.h"
#include "render/streams/image_streams.h"

namespace rubble {
namespace {

constexpr std::size_t kLargestShard = std::size_t(128) << 20;  // of one with several frames, not compressed; unit: byte

template <typename T>
constexpr const char* numpy_type() {
  if constexpr (std::is_same_v<T, float>) return "<f4";
  if constexpr (std::is_same_v<T, std::uint32_t>) return "<i4";  // piece numbers: -1 and -2 are no pieces
  if constexpr (std::is_same_v<T, std::uint16_t>) return "<u2";
  return "|u1";
}

// A file of numpy, version 1.0: rows from the top.
template <typename T>
std::string encode_npy(const Intrinsics& k, int components, const std::vector<T>& values) {
  std::string head = std::string("{'descr': '") + numpy_type<T>() + "', 'fortran_order': False, 'shape': (" +
                     std::to_string(k.height) + ", " + std::to_string(k.width) +
                     (components > 1 ? ", " + std::to_string(components) : "") + "), }";
  constexpr std::size_t kBefore = 10, kAlignment = 64;
  head.append(kAlignment - (kBefore + head.size() + 1) % kAlignment, ' ');
  head += '\n';
  std::string bytes{"\x93NUMPY\x01\x00", 8};
  put(bytes, static_cast<std::uint16_t>(head.size()));
  bytes += head;
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  return bytes;
}

std::string sample_json(const Frame& frame, double baseline) {
  const Intrinsics& k = frame.intrinsics;
  const Quat& q = frame.world_from_camera.rotation;
  const Vec3 &t = frame.world_from_camera.translation, &v = frame.linear_velocity;
  const nlohmann::ordered_json json{
      {"index", frame.index},
      {"stamp_ns", frame.stamp_ns},
      {"camera", {{"width", k.width}, {"height", k.height}, {"fx", k.fx}, {"fy", k.fy}, {"cx", k.cx}, {"cy", k.cy},
                  {"lens", k.lens == LensModel::fisheye ? "fisheye" : "plumb_bob"}, {"distortion", k.distortion},
                  {"baseline", baseline}}},
      {"world_from_camera", {{"position", {t.x, t.y, t.z}}, {"quaternion_wxyz", {q.w, q.x, q.y, q.z}}}},
      {"linear_velocity", {v.x, v.y, v.z}}};
  return json.dump(1) + "\n";
}

std::string frame_in_tar(const Frame& frame, const Channels& channels) {
  const Intrinsics& k = frame.intrinsics;
  const std::string key = index_text(frame.index);
  std::string tar;
  add_to_tar(tar, key + ".rgb.png", encode_png(RgbImage{k.width, k.height, frame.rgb}));
  if (channels.right) add_to_tar(tar, key + ".right.png", encode_png(RgbImage{k.width, k.height, frame.rgb_right}));
  add_to_tar(tar, key + ".depth.npy", encode_npy(k, 1, channels.measured_depth ? frame.measured_depth : frame.depth));
  if (channels.measured_depth) add_to_tar(tar, key + ".depth_true.npy", encode_npy(k, 1, frame.depth));
  for (const ImageStream* stream : channels.truth)
    std::visit([&](const auto* values) { add_to_tar(tar, key + "." + stream->name + ".npy", encode_npy(k, stream->components, *values)); },
               *find_image(frame, *stream));
  add_to_tar(tar, key + ".json", sample_json(frame, frame.baseline));
  return tar;
}

class WebDatasetRecorder : public Recorder {
 public:
  WebDatasetRecorder(const std::string& path, const Recording& recording, int threads)
      : channels_(recording.cameras.front().channels), order_(path, channels_), folder_(path, {}, threads), recording_(recording) {}

  void write(const Frame& frame) override {
    order_.check(frame);
    const std::size_t size = size_of(frame);
    if (!frames_.empty() && size_ + size > kLargestShard) close_shard();
    frames_.push_back(frame);
    size_ += size;
  }

  void finish() override {
    if (!frames_.empty()) close_shard();
    if (channels_.has_legend()) folder_.write("legend.json", legend_to_json(recording_.legend) + "\n");
    folder_.finish();
  }

 private:
  std::size_t size_of(const Frame& frame) const {
    std::size_t bytes = frame.rgb.size() + frame.rgb_right.size() + 4 * (frame.depth.size() + frame.measured_depth.size());
    for (const ImageStream* stream : channels_.truth) bytes += stream->bytes_per_pixel() * frame.depth.size();
    return bytes;
  }

  void close_shard() {
    const auto shard = std::make_shared<std::vector<Frame>>(std::move(frames_));
    folder_.add("rubble-" + index_text(shards_++) + ".tar", [shard, channels = channels_] {
      std::string tar;
      for (const Frame& frame : *shard) tar += frame_in_tar(frame, channels);
      end_tar(tar);
      return tar;
    });
    frames_.clear();
    size_ = 0;
  }

  Channels channels_;
  FrameOrder order_;
  FolderWriter folder_;
  Recording recording_;
  std::vector<Frame> frames_;  // of the open shard
  std::size_t size_ = 0;       // of their pixels; unit: byte
  int shards_ = 0;
};

}  // namespace

std::unique_ptr<Recorder> make_webdataset_recorder(const std::string& path, const Recording& recording, int threads) {
  return std::make_unique<WebDatasetRecorder>(path, recording, threads);
}

}  // namespace rubble
