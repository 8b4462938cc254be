// The only file of the library that includes MRPT.
#include "io/rawlog_recorder.h"

#include <mrpt/io/CStream.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/serialization/CArchive.h>

#include <stdexcept>

#include "io/atomic_file.h"
#include "io/depth_encoding.h"
#include "io/frame_order.h"
#include "io/gzip.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

// MRPT serializes into memory. Its own file streams swallow the errors of closing a file, so the
// bytes go to the disk through AtomicFile, one gzip member a frame.
class MemoryStream : public mrpt::io::CStream {
 public:
  std::size_t Write(const void* data, std::size_t size) override {
    bytes_.append(static_cast<const char*>(data), size);
    return size;
  }
  std::size_t Read(void*, std::size_t) override { throw std::logic_error("write-only"); }
  std::uint64_t Seek(std::int64_t, CStream::TSeekOrigin) override {
    throw std::logic_error("write-only");
  }
  std::uint64_t getTotalBytesCount() const override { return bytes_.size(); }
  std::uint64_t getPosition() const override { return bytes_.size(); }
  std::string getStreamDescription() const override { return "memory"; }

  const std::string& bytes() const { return bytes_; }
  void clear() { bytes_.clear(); }  // keeps its memory for the next frame

 private:
  std::string bytes_;
};

mrpt::Clock::time_point mrpt_time(std::int64_t stamp_ns) {
  constexpr std::int64_t kTicksTo1970 = 116444736000000000;  // 100 ns each, from 1601
  return mrpt::Clock::time_point(mrpt::Clock::duration(stamp_ns / 100 + kTicksTo1970));
}

mrpt::poses::CPose3D mrpt_pose(const Pose& pose) {
  const Quat& q = pose.rotation;
  const Vec3& t = pose.translation;
  return {mrpt::math::CQuaternionDouble(q.w, q.x, q.y, q.z), t.x, t.y, t.z};
}

mrpt::img::TCamera mrpt_camera(const Intrinsics& k) {
  mrpt::img::TCamera camera;
  camera.ncols = static_cast<std::uint32_t>(k.width);
  camera.nrows = static_cast<std::uint32_t>(k.height);
  camera.setIntrinsicParamsFromValues(k.fx, k.fy, k.cx, k.cy);
  const auto& d = k.distortion;
  camera.setDistortionPlumbBob(d[0], d[1], d[2], d[3], d[4]);
  camera.cameraName = "camera";
  return camera;
}

class RawlogRecorder : public Recorder {
 public:
  RawlogRecorder(const std::string& path, const RawlogOptions& options)
      : file_(path), order_(path), options_(options) {
    // A setting of the whole process; colour must be what was rendered, not a JPEG of it.
    mrpt::img::CImage::DISABLE_JPEG_COMPRESSION(true);
  }

  void write(const Frame& frame) override {
    order_.check(frame);
    try {
      write_observations(frame);
    } catch (const RunError&) {
      throw;
    } catch (const std::exception& error) {
      throw RunError("cannot record " + file_.path() + ": " + error.what());
    }
  }

  void finish() override { file_.commit(); }

 private:
  void write_observations(const Frame& frame) {
    stream_.clear();
    auto archive = mrpt::serialization::archiveFrom(static_cast<mrpt::io::CStream&>(stream_));
    archive << make_pose(frame);
    fill_scan(frame);
    archive << scan_;
    file_.write(make_gzip_member(stream_.bytes(), options_.gzip_level));
  }

  static mrpt::obs::CObservationRobotPose make_pose(const Frame& frame) {
    mrpt::obs::CObservationRobotPose observation;
    observation.timestamp = mrpt_time(frame.stamp_ns);
    observation.sensorLabel = "ground_truth";
    observation.pose.mean = mrpt_pose(frame.world_from_camera);
    observation.pose.cov.setZero();  // it is the truth
    return observation;
  }

  void fill_scan(const Frame& frame) {
    const Intrinsics& k = frame.intrinsics;
    scan_.timestamp = mrpt_time(frame.stamp_ns);
    scan_.sensorLabel = "camera";
    scan_.cameraParams = scan_.cameraParamsIntensity = mrpt_camera(k);
    scan_.range_is_depth = true;
    scan_.rangeUnits = static_cast<float>(options_.depth_unit);
    scan_.maxRange = static_cast<float>(65535 * options_.depth_unit);
    scan_.stdError = static_cast<float>(options_.depth_unit / 2);
    scan_.hasRangeImage = true;
    // MRPT keeps unit and product as floats: round by the very unit that readers multiply with.
    const auto ranges = encode_depth(frame.depth, static_cast<double>(scan_.rangeUnits));
    scan_.rangeImage_setSize(k.height, k.width);
    std::copy(ranges.begin(), ranges.end(), scan_.rangeImage.data());  // row-major, as ours
    scan_.hasIntensityImage = true;
    scan_.intensityImageChannel = mrpt::obs::CObservation3DRangeScan::CH_VISIBLE;
    // Swapped: a colour CImage is B, G, R in memory.
    scan_.intensityImage.loadFromMemoryBuffer(static_cast<unsigned>(k.width),
                                              static_cast<unsigned>(k.height), true,
                                              const_cast<unsigned char*>(frame.rgb.data()), true);
  }

  AtomicFile file_;
  FrameOrder order_;
  RawlogOptions options_;
  MemoryStream stream_;
  mrpt::obs::CObservation3DRangeScan scan_;  // reused: its buffers are large
};

}  // namespace

std::unique_ptr<Recorder> make_rawlog_recorder(const std::string& path,
                                               const RawlogOptions& options) {
  return std::make_unique<RawlogRecorder>(path, options);
}

}  // namespace rubble
