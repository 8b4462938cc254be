#include "io/mrpt/simplemap_recorder.h"

#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include <algorithm>
#include <cmath>

#include "io/base/atomic_file.h"
#include "io/base/compressed_file.h"
#include "io/base/little_endian.h"
#include "io/mrpt/mrpt_types.h"
#include "io/recording/frame_order.h"
#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/system/isolated_worker.h"

namespace rubble {
namespace {

// An empty map as MRPT writes it ends in a count of 32 bits and the mark of an object's end. Key
// frames go between the two: the whole map need never be in memory.
struct EmptyMap {
  std::string before_count, after_frames;
};

std::string bytes_of(const mrpt::maps::CSimpleMap& map) {
  const ForkHold hold;  // children read by MRPT, too
  MemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(static_cast<mrpt::io::CStream&>(stream));
  archive << map;
  return stream.bytes();
}

EmptyMap make_empty_map() {
  const std::string bytes = bytes_of({});
  const std::size_t count_at = bytes.size() - 1 - sizeof(std::uint32_t);
  return {bytes.substr(0, count_at), bytes.substr(bytes.size() - 1)};
}

class SimplemapRecorder : public Recorder {
 public:
  SimplemapRecorder(const std::string& path, const SimplemapOptions& options)
      : file_(path), order_(path, channels(options)), options_(options), empty_(make_empty_map()) {
    file_.write(head());
  }

  void write(const Frame& frame) override {
    order_.check(frame);
    if (key_frames_ > 0 && !moved_enough(frame.world_from_camera)) return;
    last_ = frame.world_from_camera;
    ++key_frames_;
    try {
      write_key_frame(frame);
    } catch (const RunError&) {
      throw;
    } catch (const std::exception& error) {
      throw RunError("cannot record " + file_.path() + ": " + error.what());
    }
  }

  void finish() override {
    file_.write(make_gzip_member(empty_.after_frames, 0));
    file_.overwrite(0, head());
    file_.commit();
  }

 private:
  static Channels channels(const SimplemapOptions& options) {
    Channels channels;
    channels.measured_depth = options.recording.cameras.front().channels.measured_depth;
    return channels;
  }

  // Stored, not compressed, so that it has one size whatever the count.
  std::string head() const {
    std::string bytes = empty_.before_count;
    put(bytes, key_frames_);
    return make_gzip_member(bytes, 0);
  }

  bool moved_enough(const Pose& pose) const {
    const Quat turn = last_.rotation.conjugate() * pose.rotation;
    const double angle = 2 * portable::acos(std::min(1.0, std::fabs(turn.w)));
    return distance(last_.translation, pose.translation) >= options_.distance ||
           angle >= options_.angle_deg * (portable::kPi / 180);
  }

  // What a map of this key frame alone has between its count and its end, whichever MRPT writes it.
  void write_key_frame(const Frame& frame) {
    const auto seen = mrpt::obs::CSensoryFrame::Create();
    seen->insert(make_scan(frame));
    const auto pose = mrpt::poses::CPose3DPDFGaussian::Create(mrpt_pose(frame.world_from_camera));
    pose->cov.setZero();  // it is the truth
    mrpt::maps::CSimpleMap map;
    map.insert(mrpt::poses::CPose3DPDF::Ptr(pose), seen);
    const std::string bytes = bytes_of(map);
    const std::size_t begin = empty_.before_count.size() + sizeof(std::uint32_t);
    file_.write(make_gzip_member(bytes.substr(begin, bytes.size() - begin - empty_.after_frames.size()), 0));
  }

  mrpt::obs::CObservation3DRangeScan::Ptr make_scan(const Frame& frame) const {
    auto scan = mrpt::obs::CObservation3DRangeScan::Create();
    scan->timestamp = mrpt_time(frame.stamp_ns);
    scan->sensorLabel = "camera";
    scan->cameraParams = scan->cameraParamsIntensity = mrpt_camera(frame.intrinsics);
    scan->hasPoints3D = true;
    fill_points(frame, *scan);
    return scan;
  }

  std::optional<Vec3> ray_through(const Intrinsics& k, int u, int v) const {
    if (options_.ray) return options_.ray(u, v);
    return Vec3{(u - k.cx) / k.fx, (v - k.cy) / k.fy, 1};
  }

  // In the camera body frame.
  void fill_points(const Frame& frame, mrpt::obs::CObservation3DRangeScan& scan) const {
    const Intrinsics& k = frame.intrinsics;
    const auto& depth =
        options_.recording.cameras.front().channels.measured_depth ? frame.measured_depth : frame.depth;
    const int step = std::max(1, k.width / options_.points_across);
    for (int v = step / 2; v < k.height; v += step) {
      const Pose body_from_optical = frame.row_poses.empty() ? camera_from_optical : frame.world_from_camera.inverse() * frame.world_from_optical(v);
      for (int u = step / 2; u < k.width; u += step) {
        const std::size_t i = static_cast<std::size_t>(v) * static_cast<std::size_t>(k.width) +
                              static_cast<std::size_t>(u);
        const double z = static_cast<double>(depth[i]);
        if (!(z > 0) || !std::isfinite(z)) continue;
        const std::optional<Vec3> ray = ray_through(k, u, v);
        if (!ray) continue;
        const Vec3 p = body_from_optical * (*ray * (z / ray->z));
        scan.points3D_x.push_back(static_cast<float>(p.x));
        scan.points3D_y.push_back(static_cast<float>(p.y));
        scan.points3D_z.push_back(static_cast<float>(p.z));
        scan.points3D_idxs_x.push_back(static_cast<std::uint16_t>(u));
        scan.points3D_idxs_y.push_back(static_cast<std::uint16_t>(v));
      }
    }
  }

  AtomicFile file_;
  FrameOrder order_;
  SimplemapOptions options_;
  EmptyMap empty_;
  std::uint32_t key_frames_ = 0;
  Pose last_;
};

}  // namespace

std::unique_ptr<Recorder> make_simplemap_recorder(const std::string& path,
                                                  const SimplemapOptions& options) {
  return std::make_unique<SimplemapRecorder>(path, options);
}

}  // namespace rubble
