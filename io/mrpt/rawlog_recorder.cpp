#include "io/mrpt/rawlog_recorder.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <cmath>

#include "io/base/atomic_file.h"
#include "io/base/compressed_file.h"
#include "io/image/image_file.h"
#include "io/mrpt/action_frames.h"
#include "io/mrpt/mrpt_types.h"
#include "io/mrpt/reading_observations.h"
#include "io/recording/frame_order.h"
#include "kernel/base/error.h"
#include "kernel/base/system/isolated_worker.h"

namespace rubble {
namespace {

// Odometry that turns more slowly than this has no velocities in a rawlog; unit: rad/s.
constexpr double kLeastTurning = 1e-6;

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
    guard([&] { write_observations(frame); });
    write_frames(false);
    if (stream_.bytes().empty()) return;  // actions wait for their odometry
    file_.write(make_gzip_member(stream_.bytes(), options_.gzip_level));
    stream_.clear();
  }

  // Into the gzip member of the next frame.
  void write_imu(const ImuSample& sample) override {
    guard([&] {
      if (acts()) frames_.keep_for_next(make_imu(sample));
      if (!acts()) emit(sample.stamp_ns, make_imu(sample));
    });
  }

  void write_robot(const RobotSample& sample) override {
    const std::string& name = recording_.robots.at(std::size_t(sample.sensor)).name;
    guard([&] {
      const bool moves = acts() && sample.sensor == options_.actions_of && sample.odometry;
      if (moves) frames_.note_odometry(sample.stamp_ns, make_odometry(sample, "").odometry);
      if (acts()) return;  // actions have the odometry, and robots/NAME.txt the truth
      if (sample.odometry) emit(sample.stamp_ns, make_odometry(sample, name + "_odometry"));
      emit(sample.stamp_ns, make_truth(sample.stamp_ns, name + "_ground_truth", sample.world_from_base));
    });
    write_frames(false);
  }

  void write_reading(const Reading& reading) override {
    const SensorRecord& sensor = recording_.sensors.at(std::size_t(reading.sensor));
    guard([&] {
      write_reading_observation(reading, sensor, [&](const auto& observation) { emit(reading.stamp_ns, observation); });
    });
  }

  void finish() override {
    write_frames(true);
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

  bool acts() const { return options_.actions_of >= 0; }

  // MRPT's errors as ours.
  template <typename Work>
  void guard(const Work& work) {
    const ForkHold hold;  // children read rawlogs by MRPT, too
    try {
      work();
    } catch (const RunError&) {
      throw;
    } catch (const std::exception& error) {
      throw RunError("cannot record " + file_.path() + ": " + error.what());
    }
  }

  void put(const mrpt::serialization::CSerializable& object) {
    auto archive = mrpt::serialization::archiveFrom(static_cast<mrpt::io::CStream&>(stream_));
    archive << object;
  }

  void emit(std::int64_t stamp_ns, const mrpt::obs::CObservation& observation) {
    if (acts()) return frames_.add(stamp_ns, observation);
    put(observation);
  }

  // Of sensory frames those whose action is known.
  void write_frames(bool all) {
    if (!acts()) return;
    guard([&] {
      frames_.write(
          [&](const auto& actions, const auto& frame) {
            put(actions);
            put(frame);
          },
          all);
    });
  }

  // The pose of the rig once for the frames of one instant; of a link that carries a camera, for each.
  void write_observations(const Frame& frame) {
    const CameraRecord& camera = recording_.cameras[std::size_t(frame.sensor)];
    if (!acts()) put_truth(frame, camera);
    const bool measured = camera.channels.measured_depth;
    fill_scan(frame, camera, camera.name, measured ? frame.measured_depth : frame.depth);
    fill_colour(frame);
    emit(frame.stamp_ns, scan_);
    if (measured) {
      fill_scan(frame, camera, truth_label(camera), frame.depth);
      scan_.hasIntensityImage = false;
      emit(frame.stamp_ns, scan_);
    }
    if (camera.channels.right) emit(frame.stamp_ns, make_right(frame, camera));
  }

  void put_truth(const Frame& frame, const CameraRecord& camera) {
    if (!camera.carrier.empty())
      put(make_truth(frame.stamp_ns, camera.name + "_ground_truth", frame.world_from_rig));
    else if (frame.stamp_ns != last_ns_)
      put(make_truth(frame.stamp_ns, "ground_truth", frame.world_from_rig));
    if (camera.carrier.empty()) last_ns_ = frame.stamp_ns;
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
    observation.hasVelocities = std::abs(from.angular) > kLeastTurning;
    if (observation.hasVelocities) observation.velocityLocal = {from.linear, 0, from.angular};
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
  ActionFrames frames_;
  mrpt::obs::CObservation3DRangeScan scan_;  // reused: its buffers are large
};

}  // namespace

std::unique_ptr<Recorder> make_rawlog_recorder(const std::string& path,
                                               const RawlogOptions& options) {
  return std::make_unique<RawlogRecorder>(path, options);
}

}  // namespace rubble
