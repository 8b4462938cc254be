// Reads our rawlogs through MRPT itself.
#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRange.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/gnss_messages_ascii_nmea.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>
#include <limits>
#include <map>
#include <sstream>

#include "io/base/atomic_file.h"
#include "io/mrpt/rawlog_recorder.h"
#include "io/mrpt/simplemap_recorder.h"
#include "tests/io/support.h"

namespace rubble {
namespace rawlog_test {

using mrpt::obs::CObservation;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationRobotPose;
using test::make_frame;
using test::ScratchFolder;

constexpr int kFrames = 3;

void record(const std::string& path, int gzip_level) {
  RawlogOptions options;
  options.gzip_level = gzip_level;
  const auto recorder = make_rawlog_recorder(path, options);
  for (int i = 0; i < kFrames; ++i) recorder->write(make_frame(i));
  recorder->finish();
}

std::vector<CObservation::Ptr> read_rawlog(const std::string& path) {
  mrpt::io::CFileGZInputStream file(path);
  auto archive = mrpt::serialization::archiveFrom(file);
  std::vector<CObservation::Ptr> observations;
  while (!file.checkEOF()) {
    try {
      observations.push_back(std::dynamic_pointer_cast<CObservation>(archive.ReadObject()));
    } catch (const mrpt::serialization::CExceptionEOF&) {
      break;
    }
  }
  return observations;
}

void expect_pose(const mrpt::poses::CPose3D& found, const Pose& expected) {
  const Vec3& t = expected.translation;
  EXPECT_NEAR(found.x(), t.x, 1e-12);
  EXPECT_NEAR(found.y(), t.y, 1e-12);
  EXPECT_NEAR(found.z(), t.z, 1e-12);
  const Mat3 r = expected.rotation.matrix();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(found.getRotationMatrix()(i, j), r.rows[i][j], 1e-9);
  }
}

// Unprojects by MRPT's own code at the recorded pose; every point must lie on the scene.
void expect_points_on_scene(CObservation3DRangeScan& scan, const mrpt::poses::CPose3D& robot) {
  mrpt::maps::CSimplePointsMap points;
  mrpt::obs::T3DPointsProjectionParams projection;
  projection.takeIntoAccountSensorPoseOnRobot = true;
  projection.robotPoseInTheWorld = robot;
  scan.unprojectInto(points, projection);
  ASSERT_GT(points.size(), 1000u);
  double worst = 0;
  int on_sphere = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    float x, y, z;
    points.getPoint(i, x, y, z);
    const Vec3 p{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
    worst = std::max(worst, test::distance_to_scene(p));
    on_sphere += p.z > 0.1;
  }
  EXPECT_LT(worst, 0.001) << "unit: m";
  EXPECT_GT(on_sphere, 100) << "the sphere is missing";
}

TEST(Rawlog, MrptReadsPosesScansAndPicturesAndUnprojectsOntoTheScene) {
  for (const int level : {0, 1}) {
    ScratchFolder folder;
    record(folder / "mission.rawlog", level);
    const auto observations = read_rawlog(folder / "mission.rawlog");
    ASSERT_EQ(observations.size(), 2u * kFrames);
    for (int i = 0; i < kFrames; ++i) {
      const Frame frame = make_frame(i);
      const auto truth = std::dynamic_pointer_cast<CObservationRobotPose>(
          observations[static_cast<std::size_t>(2 * i)]);
      const auto scan = std::dynamic_pointer_cast<CObservation3DRangeScan>(
          observations[static_cast<std::size_t>(2 * i + 1)]);
      ASSERT_TRUE(truth && scan);
      EXPECT_EQ(truth->sensorLabel, "ground_truth");
      EXPECT_EQ(truth->timestamp, scan->timestamp);
      const std::int64_t ticks = truth->timestamp.time_since_epoch().count();
      EXPECT_EQ((ticks - 116444736000000000) * 100, frame.stamp_ns / 100 * 100);
      expect_pose(truth->pose.mean, frame.world_from_camera);
      expect_points_on_scene(*scan, truth->pose.mean);
    }
  }
}

TEST(Rawlog, ScansCarryTheRightCameraAndColours) {
  ScratchFolder folder;
  record(folder / "mission.rawlog", 0);
  const Frame frame = make_frame(1);
  const auto scan =
      std::dynamic_pointer_cast<CObservation3DRangeScan>(read_rawlog(folder / "mission.rawlog")[3]);
  ASSERT_TRUE(scan);
  EXPECT_TRUE(scan->range_is_depth);
  EXPECT_TRUE(scan->doDepthAndIntensityCamerasCoincide());
  EXPECT_EQ(scan->cameraParams.fx(), frame.intrinsics.fx);
  EXPECT_EQ(scan->cameraParamsIntensity.cy(), frame.intrinsics.cy);
  EXPECT_FALSE(scan->intensityImage.isExternallyStored());
  // A colour CImage holds blue, green, red.
  const int u = 70, v = 33;
  const std::uint8_t* bgr = scan->intensityImage.ptr<std::uint8_t>(u, v, 0);
  EXPECT_EQ(bgr[2], u);
  EXPECT_EQ(bgr[1], v);
  EXPECT_EQ(bgr[0], 207);
  const auto width = static_cast<std::size_t>(frame.intrinsics.width);
  const float depth =
      frame.depth[static_cast<std::size_t>(v) * width + static_cast<std::size_t>(u)];
  EXPECT_NEAR(scan->rangeImage(v, u) * scan->rangeUnits, depth, 0.00051);
  EXPECT_EQ(scan->rangeImage(0, 0), 0) << "the sky must have no return";
}

TEST(Rawlog, RawlogEditReadsIt) {
  ScratchFolder folder;
  record(folder / "mission.rawlog", 0);
  const auto info = test::run_command("rawlog-edit --info -i " + (folder / "mission.rawlog"));
  EXPECT_EQ(info.exit_code, 0) << info.output;
  std::string told = info.output;
  for (std::size_t at = 0; (at = told.find("/ ", at)) != std::string::npos;) told.erase(at + 1, 1);  // as MRPT 2.14 writes
  for (const char* part : {"number of objects         : 6", "camera, ground_truth", "3 /30.000 /0.067"})
    EXPECT_NE(told.find(part), std::string::npos) << part << " is not in:\n" << info.output;
}

TEST(Rawlog, FurtherChannelsAreObservationsOfTheirOwn) {
  ScratchFolder folder;
  RawlogOptions options;
  options.recording = test::full_recording();
  const auto recorder = make_rawlog_recorder(folder / "mission.rawlog", options);
  for (int i = 0; i < 2; ++i) test::write_full(*recorder, i);
  recorder->finish();
  std::map<std::string, std::vector<CObservation::Ptr>> by_label;
  for (const auto& o : read_rawlog(folder / "mission.rawlog"))
    by_label[o->sensorLabel].push_back(o);
  ASSERT_EQ(by_label["imu"].size(), 1u + 5u);
  ASSERT_EQ(by_label["camera_right"].size(), 2u);
  ASSERT_EQ(by_label["ground_truth_depth"].size(), 2u);
  const Frame frame = test::make_full_frame(1);
  const auto& imu = dynamic_cast<mrpt::obs::CObservationIMU&>(*by_label["imu"].back());
  EXPECT_EQ(imu.get(mrpt::obs::IMU_WY), test::make_full_imu(1).back().angular_velocity.y);
  EXPECT_EQ(imu.get(mrpt::obs::IMU_Z_ACC), test::make_full_imu(1).back().linear_acceleration.z);
  const auto& right = dynamic_cast<mrpt::obs::CObservationImage&>(*by_label["camera_right"][1]);
  EXPECT_NEAR(right.cameraPose.y(), -0.12, 1e-12);
  EXPECT_EQ(right.image.ptr<std::uint8_t>(0, 0, 0)[2], frame.rgb_right[0]);
  const std::size_t pixel = 60 * 96 + 48;
  const auto depth_at = [&](const char* label) {
    const auto& scan = dynamic_cast<CObservation3DRangeScan&>(*by_label[label][1]);
    return double(scan.rangeImage(60, 48) * scan.rangeUnits);
  };
  EXPECT_NEAR(depth_at("camera"), double(frame.measured_depth[pixel]), 0.00051);
  EXPECT_NEAR(depth_at("ground_truth_depth"), double(frame.depth[pixel]), 0.00051);
}

double worst_distance(const std::string& points_file, std::size_t& count) {
  std::istringstream text(test::read_text(points_file));
  double worst = 0;
  count = 0;
  for (Vec3 p; text >> p.x >> p.y >> p.z; ++count)
    worst = std::max(worst, test::distance_to_scene(p));
  return worst;
}

// MRPT's own program builds a map of it.
TEST(Rawlog, RobotsHaveOdometryAndTheirTruePose) {
  const ScratchFolder folder;
  RawlogOptions options;
  options.recording.robots.resize(1);
  options.recording.robots[0].name = "cart";
  const auto recorder = make_rawlog_recorder(folder / "a.rawlog", options);
  RobotSample sample;
  sample.stamp_ns = make_frame(0).stamp_ns;
  sample.world_from_base = {{0.8, 0, 0, 0.6}, {1, 2, 0.5}};
  sample.odometry = RobotSample::Odometry{{{0.8, 0, 0, 0.6}, {0.5, -0.25, 0}}, 0.4, -0.2};
  recorder->write_robot(sample);
  recorder->write(make_frame(0));
  recorder->finish();
  const auto observations = read_rawlog(folder / "a.rawlog");
  ASSERT_EQ(observations.size(), 4u);
  const auto odometry =
      std::dynamic_pointer_cast<mrpt::obs::CObservationOdometry>(observations[0]);
  ASSERT_TRUE(odometry);
  EXPECT_EQ(odometry->sensorLabel, "cart_odometry");
  EXPECT_EQ(odometry->odometry.x(), 0.5);
  EXPECT_EQ(odometry->odometry.y(), -0.25);
  EXPECT_NEAR(odometry->odometry.phi(), 2 * std::atan2(0.6, 0.8), 1e-12);
  EXPECT_TRUE(odometry->hasVelocities);
  EXPECT_EQ(odometry->velocityLocal.vx, 0.4);
  EXPECT_EQ(odometry->velocityLocal.omega, -0.2);
  const auto truth = std::dynamic_pointer_cast<CObservationRobotPose>(observations[1]);
  ASSERT_TRUE(truth);
  EXPECT_EQ(truth->sensorLabel, "cart_ground_truth");
  expect_pose(truth->pose.mean, sample.world_from_base);
}

RobotSample make_reading(std::int64_t stamp_ns, double x, double yaw, double angular) {
  RobotSample sample;
  sample.stamp_ns = stamp_ns;
  sample.odometry = RobotSample::Odometry{{{std::cos(yaw / 2), 0, 0, std::sin(yaw / 2)}, {x, 0, 0}}, 0.4, angular};
  return sample;
}

// MRPT's filters divide by the rate of turn.
TEST(Rawlog, OdometryThatDoesNotTurnHasNoVelocities) {
  const ScratchFolder folder;
  RawlogOptions options;
  options.recording.robots.resize(1);
  const auto recorder = make_rawlog_recorder(folder / "a.rawlog", options);
  for (const double angular : {0.0, -0.0, 1e-12, 1e-4, -0.3}) recorder->write_robot(make_reading(1000000000, 1, 0, angular));
  recorder->finish();
  std::vector<bool> found;
  for (const auto& observation : read_rawlog(folder / "a.rawlog"))
    if (const auto o = std::dynamic_pointer_cast<mrpt::obs::CObservationOdometry>(observation)) found.push_back(o->hasVelocities);
  EXPECT_EQ(found, (std::vector<bool>{false, false, false, true, true}));
}

TEST(Rawlog, ReadingsOfSensorsAreMrptsObservations) {
  InertialObservation inertial;
  inertial.magnetic_field = {2e-5, 0, -4e-5}, inertial.orientation = {0.1, 0.2, 0.3, 0.9}, inertial.pressure = {100000};
  SatelliteObservation place;
  place.latitude_deg = 42.5, place.longitude_deg = -71.25, place.altitude = 17, place.hdop = 1.5;
  place.satellites = 7, place.fix = true;
  const std::vector<std::pair<std::string, RawlogObservation>> sensors{
      {"range", RangeObservation{0.04, 4, 1.25, 0.5}},
      {"far", RangeObservation{0.04, 4, std::numeric_limits<double>::infinity(), 0.5}},
      {"inertial", inertial}, {"place", place}, {"bumper", std::monostate()}};
  RawlogOptions options;
  for (const auto& [name, observation] : sensors)
    options.recording.sensors.push_back({name, "", "", "", {{}, {0.1, 0, 0.2}}, std::make_shared<test::FixedObservation>(observation)});
  const ScratchFolder folder;
  const auto recorder = make_rawlog_recorder(folder / "a.rawlog", options);
  constexpr std::int64_t kStamp = 3'723'500'000'000;  // 1 h 2 min 3.5 s
  for (int i = 0; i < int(sensors.size()); ++i) recorder->write_reading({i, kStamp, {}});
  recorder->finish();
  const auto read = read_rawlog(folder / "a.rawlog");
  ASSERT_EQ(read.size(), 4u);  // MRPT has none for a bumper
  const auto range = std::dynamic_pointer_cast<mrpt::obs::CObservationRange>(read[0]);
  ASSERT_TRUE(range);
  EXPECT_EQ(range->sensorLabel, "range");
  EXPECT_EQ(range->sensedData.at(0).sensedDistance, 1.25f);
  EXPECT_EQ(range->maxSensorDistance, 4);
  EXPECT_EQ(range->sensorConeApperture, 0.5f);
  mrpt::poses::CPose3D at;
  range->getSensorPose(at);
  EXPECT_NEAR(at.z(), 0.2, 1e-12);
  EXPECT_EQ(std::dynamic_pointer_cast<mrpt::obs::CObservationRange>(read[1])->sensedData.at(0).sensedDistance, 0);
  const auto imu = std::dynamic_pointer_cast<mrpt::obs::CObservationIMU>(read[2]);
  ASSERT_TRUE(imu);
  EXPECT_NEAR(imu->get(mrpt::obs::IMU_MAG_Z), -0.4, 1e-12);  // gauss
  EXPECT_EQ(imu->get(mrpt::obs::IMU_ORI_QUAT_W), 0.9);
  EXPECT_EQ(imu->get(mrpt::obs::IMU_PRESSURE), 100000);
  EXPECT_FALSE(imu->has(mrpt::obs::IMU_X_ACC));
  const auto gps = std::dynamic_pointer_cast<mrpt::obs::CObservationGPS>(read[3]);
  ASSERT_TRUE(gps);
  const auto& gga = gps->getMsgByClass<mrpt::obs::gnss::Message_NMEA_GGA>().fields;
  EXPECT_EQ(double(gga.latitude_degrees), 42.5);  // a copy: the message is packed, and a reference would be misaligned
  EXPECT_EQ(double(gga.longitude_degrees), -71.25);
  EXPECT_EQ(gga.fix_quality, 1);
  EXPECT_EQ(unsigned(gga.satellitesUsed), 7u);
  EXPECT_EQ(gga.UTCTime.hour, 1);
  EXPECT_EQ(gga.UTCTime.minute, 2);
  EXPECT_NEAR(gga.UTCTime.sec, 3.5, 1e-9);
}

// As MRPT's programs read it. Between two readings odometry goes on evenly.
TEST(Rawlog, ActionsAndSensoryFramesTakeTurns) {
  const ScratchFolder folder;
  RawlogOptions options;
  options.recording.robots.resize(2);
  options.recording.imus.resize(1);
  options.actions_of = 1;
  const auto recorder = make_rawlog_recorder(folder / "a.rawlog", options);
  const std::int64_t first = make_frame(0).stamp_ns, second = make_frame(1).stamp_ns, gap = second - first;
  const auto reading = [&](std::int64_t stamp_ns, double x, double yaw, int robot) {
    RobotSample sample = make_reading(stamp_ns, x, yaw, 0);
    sample.sensor = robot;
    recorder->write_robot(sample);
  };
  reading(first - 1000000, 0.5, 0, 1);
  recorder->write(make_frame(0));
  reading(first, 99, 3, 0);  // the other robot
  reading(first, 0.5, 0, 1);
  ImuSample inertial;
  inertial.stamp_ns = first + gap / 8;
  recorder->write_imu(inertial);
  reading(second - gap / 4, 1, 0.2, 1);
  recorder->write(make_frame(1));
  reading(second + gap / 4, 2, 0.4, 1);
  recorder->finish();
  mrpt::obs::CRawlog log;
  ASSERT_TRUE(log.loadFromRawLogFile(folder / "a.rawlog"));
  ASSERT_EQ(log.size(), 4u);
  const auto movement = [&](std::size_t i) {
    return log.getAsAction(i)->getBestMovementEstimation()->rawOdometryIncrementReading;
  };
  EXPECT_EQ(movement(0).norm(), 0);
  EXPECT_NEAR(movement(2).x(), 1, 1e-9);  // from 0.5 to the middle of 1 and 2
  EXPECT_NEAR(movement(2).phi(), 0.3, 1e-9);
  EXPECT_GT(log.getAsAction(2)->getBestMovementEstimation()->poseChange->getCovariance()(2, 2), std::pow(0.3 * 0.3, 2) / 2);
  const auto frame = log.getAsObservations(1), next = log.getAsObservations(3);
  EXPECT_EQ(frame->size(), 1u);
  ASSERT_TRUE(frame->getObservationByClass<CObservation3DRangeScan>());
  EXPECT_EQ(next->size(), 2u);
  EXPECT_TRUE(next->getObservationByClass<mrpt::obs::CObservationIMU>());
  EXPECT_FALSE(next->getObservationByClass<CObservationRobotPose>()) << "a filter must not be told the truth";
}

TEST(Simplemap, Observations2mapPutsEveryPointOnTheScene) {
  ScratchFolder folder;
  const auto recorder = make_simplemap_recorder(folder / "mission.simplemap");
  for (int i = 0; i < 8; ++i) {  // 0.1 m from one to the next
    Frame frame = make_frame(i);
    if (i == 3) {  // a rolling shutter, whose rows are not where the frame is
      frame.row_poses.assign(std::size_t(frame.intrinsics.height), frame.world_from_optical(0));
      frame.world_from_camera.translation.x += 0.02;
    }
    recorder->write(frame);
  }
  recorder->finish();
  write_text_file(folder / "map.ini",
                  "[MappingApplication]\npointsMap_count=1\n"
                  "pointsMap_00_insertOpts_minDistBetweenLaserPoints=0\n");
  const auto made = test::run_command("cd " + folder.path() +
                                      " && observations2map map.ini mission.simplemap map "
                                      "</dev/null");
  EXPECT_EQ(made.exit_code, 0) << made.output;
  EXPECT_NE(made.output.find("done: 3 observations"), std::string::npos)
      << "key frames 0, 3 and 6\n"
      << made.output;
  std::size_t count = 0;
  EXPECT_LT(worst_distance(folder / "map_mrpt__maps__CSimplePointsMap_00.txt", count), 0.001);
  EXPECT_GT(count, 3000u);
}

// ... and makes point clouds of a rawlog.
TEST(Rawlog, RawlogEditMakesPointCloudsThatLieOnTheScene) {
  ScratchFolder folder;
  record(folder / "mission.rawlog", 0);
  const auto made =
      test::run_command("cd " + folder.path() +
                        " && rawlog-edit --generate-3d-pointclouds -i mission.rawlog -o 3d.rawlog");
  EXPECT_EQ(made.exit_code, 0) << made.output;
  const auto observations = read_rawlog(folder / "3d.rawlog");
  ASSERT_EQ(observations.size(), 2u * kFrames);
  double worst = 0;
  std::size_t count = 0;
  for (std::size_t i = 1; i < observations.size(); i += 2) {
    const auto& scan = dynamic_cast<CObservation3DRangeScan&>(*observations[i]);
    const Pose world_from_camera = make_frame(int(i) / 2).world_from_camera;
    ASSERT_TRUE(scan.hasPoints3D);
    for (std::size_t j = 0; j < scan.points3D_x.size(); ++j, ++count) {
      const Vec3 p{double(scan.points3D_x[j]), double(scan.points3D_y[j]),
                   double(scan.points3D_z[j])};
      worst = std::max(worst, test::distance_to_scene(world_from_camera * p));
    }
  }
  EXPECT_LT(worst, 0.001);
  EXPECT_GT(count, 3000u);
}

}  // namespace rawlog_test
}  // namespace rubble
