#include "io/mrpt/rawlog_recorder.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include "io/base/atomic_file.h"
#include "io/base/gzip.h"
#include "io/image/depth_encoding.h"
#include "io/mrpt/mrpt_types.h"
#include "io/recording/frame_order.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

class RawlogRecorder : public Recorder {
 public:
  RawlogRecorder(const std::string& path, const RawlogOptions& options)
      : file_(path),
        order_(path, format_channels(options.recording.channels)),
        channels_(format_channels(options.recording.channels)),
        options_(options) {
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
  // What MRPT has observations for.
  static Channels format_channels(const Channels& asked) {
    Channels channels;
    channels.right = asked.right;
    channels.measured_depth = asked.measured_depth;
    channels.imu = asked.imu;
    return channels;
  }

  void write_observations(const Frame& frame) {
    stream_.clear();
    auto archive = mrpt::serialization::archiveFrom(static_cast<mrpt::io::CStream&>(stream_));
    if (channels_.imu)
      for (const ImuSample& sample : frame.imu) archive << make_imu(sample);
    archive << make_pose(frame);
    const bool measured = channels_.measured_depth;
    fill_scan(frame, "camera", measured ? frame.measured_depth : frame.depth);
    fill_colour(frame);
    archive << scan_;
    if (measured) {
      fill_scan(frame, "ground_truth_depth", frame.depth);
      scan_.hasIntensityImage = false;
      archive << scan_;
    }
    if (channels_.right) archive << make_right(frame);
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

  static mrpt::obs::CObservationIMU make_imu(const ImuSample& sample) {
    mrpt::obs::CObservationIMU observation;
    observation.timestamp = mrpt_time(sample.stamp_ns);
    observation.sensorLabel = "imu";
    const Vec3 &w = sample.angular_velocity, &a = sample.linear_acceleration;
    observation.set(mrpt::obs::IMU_X_ACC, a.x);
    observation.set(mrpt::obs::IMU_Y_ACC, a.y);
    observation.set(mrpt::obs::IMU_Z_ACC, a.z);
    observation.set(mrpt::obs::IMU_WX, w.x);
    observation.set(mrpt::obs::IMU_WY, w.y);
    observation.set(mrpt::obs::IMU_WZ, w.z);
    return observation;
  }

  // MRPT's cameras stand in the optical frame.
  static mrpt::obs::CObservationImage make_right(const Frame& frame) {
    mrpt::obs::CObservationImage observation;
    observation.timestamp = mrpt_time(frame.stamp_ns);
    observation.sensorLabel = "camera_right";
    observation.cameraParams = mrpt_camera(frame.intrinsics);
    observation.cameraPose = mrpt_pose({camera_from_optical.rotation, {0, -frame.baseline, 0}});
    fill_image(observation.image, frame.intrinsics, frame.rgb_right);
    return observation;
  }

  // Swapped: a colour CImage is B, G, R in memory.
  static void fill_image(mrpt::img::CImage& image, const Intrinsics& k,
                         const std::vector<std::uint8_t>& rgb) {
    image.loadFromMemoryBuffer(static_cast<unsigned>(k.width), static_cast<unsigned>(k.height),
                               true, const_cast<unsigned char*>(rgb.data()), true);
  }

  void fill_scan(const Frame& frame, const char* label, const std::vector<float>& depth) {
    const Intrinsics& k = frame.intrinsics;
    scan_.timestamp = mrpt_time(frame.stamp_ns);
    scan_.sensorLabel = label;
    scan_.cameraParams = scan_.cameraParamsIntensity = mrpt_camera(k);
    scan_.range_is_depth = true;
    scan_.rangeUnits = static_cast<float>(options_.depth_unit);
    scan_.maxRange = static_cast<float>(65535 * options_.depth_unit);
    scan_.stdError = static_cast<float>(options_.depth_unit / 2);
    scan_.hasRangeImage = true;
    // MRPT keeps unit and product as floats: round by the very unit that readers multiply with.
    const auto ranges = encode_depth(depth, static_cast<double>(scan_.rangeUnits));
    scan_.rangeImage_setSize(k.height, k.width);
    std::copy(ranges.begin(), ranges.end(), scan_.rangeImage.data());  // row-major, as ours
  }

  void fill_colour(const Frame& frame) {
    scan_.hasIntensityImage = true;
    scan_.intensityImageChannel = mrpt::obs::CObservation3DRangeScan::CH_VISIBLE;
    fill_image(scan_.intensityImage, frame.intrinsics, frame.rgb);
  }

  AtomicFile file_;
  FrameOrder order_;
  Channels channels_;
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
