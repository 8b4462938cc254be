#include "io/mrpt/rawlog_recorder.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include "io/base/atomic_file.h"
#include "io/base/gzip.h"
#include "io/image/depth_encoding.h"
#include "io/mrpt/lidar_observations.h"
#include "io/mrpt/mrpt_types.h"
#include "io/recording/frame_order.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

class RawlogRecorder : public Recorder {
 public:
  RawlogRecorder(const std::string& path, const RawlogOptions& options)
      : file_(path),
        recording_(format_recording(options.recording)),
        order_(path, channels_of(recording_)),
        options_(options) {
    // A setting of the whole process; colour must be what was rendered, not a JPEG of it.
    mrpt::img::CImage::DISABLE_JPEG_COMPRESSION(true);
  }

  void write(const Frame& frame) override {
    order_.check(frame);
    observe([&](auto& archive) { write_observations(frame, archive); });
    file_.write(make_gzip_member(stream_.bytes(), options_.gzip_level));
    stream_.clear();
  }

  // Into the gzip member of the next frame.
  void write_imu(const ImuSample& sample) override {
    observe([&](auto& archive) { archive << make_imu(sample); });
  }

  void write_robot(const RobotSample& sample) override {
    const std::string& name = recording_.robots.at(std::size_t(sample.sensor)).name;
    observe([&](auto& archive) {
      if (sample.odometry) archive << make_odometry(sample, name + "_odometry");
      archive << make_truth(sample.stamp_ns, name + "_ground_truth", sample.world_from_base);
    });
  }

  void write_lidar(const LidarScan& scan) override {
    const LidarRecord& lidar = recording_.lidars.at(std::size_t(scan.sensor));
    observe([&](auto& archive) { write_lidar_observation(scan, lidar, archive); });
  }

  void finish() override {
    if (!stream_.bytes().empty())
      file_.write(make_gzip_member(stream_.bytes(), options_.gzip_level));
    file_.commit();
  }

 private:
  // What MRPT has observations for.
  static Recording format_recording(Recording recording) {
    for (CameraRecord& camera : recording.cameras) {
      const Channels asked = camera.channels;
      camera.channels = {};
      camera.channels.right = asked.right;
      camera.channels.measured_depth = asked.measured_depth;
    }
    return recording;
  }

  // write: with an archive.
  template <typename Write>
  void observe(const Write& write) {
    try {
      auto archive = mrpt::serialization::archiveFrom(static_cast<mrpt::io::CStream&>(stream_));
      write(archive);
    } catch (const RunError&) {
      throw;
    } catch (const std::exception& error) {
      throw RunError("cannot record " + file_.path() + ": " + error.what());
    }
  }

  // The pose of the rig once for the frames of one instant; of a link that carries a camera, for each.
  template <typename Archive>
  void write_observations(const Frame& frame, Archive& archive) {
    const CameraRecord& camera = recording_.cameras[std::size_t(frame.sensor)];
    if (!camera.carrier.empty())
      archive << make_truth(frame.stamp_ns, camera.name + "_ground_truth", frame.world_from_rig);
    else if (frame.stamp_ns != last_ns_)
      archive << make_truth(frame.stamp_ns, "ground_truth", frame.world_from_rig);
    if (camera.carrier.empty()) last_ns_ = frame.stamp_ns;
    const bool measured = camera.channels.measured_depth;
    fill_scan(frame, camera, camera.name, measured ? frame.measured_depth : frame.depth);
    fill_colour(frame);
    archive << scan_;
    if (measured) {
      fill_scan(frame, camera, truth_label(camera), frame.depth);
      scan_.hasIntensityImage = false;
      archive << scan_;
    }
    if (camera.channels.right) archive << make_right(frame, camera);
  }

  std::string truth_label(const CameraRecord& camera) const {
    return recording_.cameras.size() > 1 ? camera.name + "_ground_truth_depth"
                                         : "ground_truth_depth";
  }

  static mrpt::obs::CObservationRobotPose make_truth(std::int64_t stamp_ns, const std::string& label,
                                                     const Pose& pose) {
    mrpt::obs::CObservationRobotPose observation;
    observation.timestamp = mrpt_time(stamp_ns);
    observation.sensorLabel = label;
    observation.pose.mean = mrpt_pose(pose);
    observation.pose.cov.setZero();  // it is the truth
    return observation;
  }

  static mrpt::obs::CObservationOdometry make_odometry(const RobotSample& sample,
                                                       const std::string& label) {
    const RobotSample::Odometry& from = *sample.odometry;
    const mrpt::poses::CPose3D pose = mrpt_pose(from.odom_from_base);
    mrpt::obs::CObservationOdometry observation;
    observation.timestamp = mrpt_time(sample.stamp_ns);
    observation.sensorLabel = label;
    observation.odometry = mrpt::poses::CPose2D(pose.x(), pose.y(), pose.yaw());
    observation.hasVelocities = true;
    observation.velocityLocal = {from.linear, 0, from.angular};
    return observation;
  }

  mrpt::obs::CObservationIMU make_imu(const ImuSample& sample) const {
    const ImuRecord& imu = recording_.imus.at(std::size_t(sample.sensor));
    mrpt::obs::CObservationIMU observation;
    observation.timestamp = mrpt_time(sample.stamp_ns);
    observation.sensorLabel = imu.name;
    if (imu.frame_id != recording_.frame_of(imu.carrier)) observation.sensorPose = mrpt_pose(imu.rig_from_imu);
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
  static mrpt::obs::CObservationImage make_right(const Frame& frame, const CameraRecord& camera) {
    mrpt::obs::CObservationImage observation;
    observation.timestamp = mrpt_time(frame.stamp_ns);
    observation.sensorLabel = camera.name + "_right";
    observation.cameraParams = mrpt_camera(frame.intrinsics);
    observation.cameraPose =
        mrpt_pose(camera.in_rig({camera_from_optical.rotation, {0, -frame.baseline, 0}}));
    fill_image(observation.image, frame.intrinsics, frame.rgb_right);
    return observation;
  }

  // Swapped: a colour CImage is B, G, R in memory.
  static void fill_image(mrpt::img::CImage& image, const Intrinsics& k,
                         const std::vector<std::uint8_t>& rgb) {
    image.loadFromMemoryBuffer(static_cast<unsigned>(k.width), static_cast<unsigned>(k.height),
                               true, const_cast<unsigned char*>(rgb.data()), true);
  }

  void fill_scan(const Frame& frame, const CameraRecord& camera, const std::string& label,
                 const std::vector<float>& depth) {
    const Intrinsics& k = frame.intrinsics;
    scan_.timestamp = mrpt_time(frame.stamp_ns);
    scan_.sensorLabel = label;
    scan_.sensorPose =
        camera.is_rig() ? mrpt::poses::CPose3D() : mrpt_pose(camera.rig_from_camera);
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
  Recording recording_;
  FrameOrder order_;
  std::int64_t last_ns_ = -1;  // of the last pose
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
