// Scans of LiDARs in rawlogs, through MRPT itself.
#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>

#include "io/mrpt/rawlog_recorder.h"
#include "tests/io/support.h"

namespace rubble {
namespace lidar_recording_test {

// Three LiDARs that see the same two echoes; ring 1 of two, column 3 of eight.
Recording three_lidars() {
  Recording recording;
  for (const LidarPattern pattern : {LidarPattern::spinning, LidarPattern::rosette, LidarPattern::planar}) {
    LidarRecord lidar;
    lidar.name = "lidar" + std::to_string(recording.lidars.size());
    lidar.rig_from_lidar.translation = {0.1, 0.2, 0.3};
    lidar.spec.pattern = pattern;
    lidar.spec.elevations_deg = {-1, 1};
    if (pattern == LidarPattern::planar) lidar.spec.elevations_deg = {0};
    lidar.spec.delays_ns.assign(lidar.spec.elevations_deg.size(), 0);
    lidar.spec.columns = 8, lidar.spec.column_ns = 10'000'000;
    lidar.spec.first_azimuth_deg = pattern == LidarPattern::planar ? -78.75 : 180;
    lidar.spec.span_deg = pattern == LidarPattern::planar ? 180 : -360;
    lidar.spec.returns = LidarReturns::dual;
    recording.lidars.push_back(lidar);
  }
  return recording;
}

RangeScan two_echoes(int sensor) {
  RangeScan scan;
  scan.stamp_ns = 1'500'000'000, scan.sensor = sensor;
  const auto ring = std::uint16_t(sensor == 2 ? 0 : 1);
  scan.points = {{3, 4, 0, 50, 0.03f, ring, 3}, {6, 8, 0, 20, 0.03f, ring, 3}};
  return scan;
}

TEST(LidarRawlog, MrptReadsRangesPointsAndPlaces) {
  test::ScratchFolder folder;
  const auto recorder = make_rawlog_recorder(folder / "mission.rawlog", {0, 0.001, three_lidars()});
  for (int i = 0; i < 3; ++i) recorder->write_lidar(two_echoes(i));
  recorder->finish();

  mrpt::io::CFileGZInputStream file(folder / "mission.rawlog");
  auto archive = mrpt::serialization::archiveFrom(file);
  const auto rotating = std::dynamic_pointer_cast<mrpt::obs::CObservationRotatingScan>(archive.ReadObject());
  const auto cloud = std::dynamic_pointer_cast<mrpt::obs::CObservationPointCloud>(archive.ReadObject());
  const auto planar = std::dynamic_pointer_cast<mrpt::obs::CObservation2DRangeScan>(archive.ReadObject());
  ASSERT_TRUE(rotating && cloud && planar);

  EXPECT_EQ(rotating->sensorLabel, "lidar0");
  EXPECT_EQ(rotating->rowCount, 2);
  EXPECT_EQ(rotating->columnCount, 8);
  EXPECT_NEAR(rotating->rangeImage(1, 3) * rotating->rangeResolution, 5, rotating->rangeResolution / 2);
  EXPECT_NEAR(rotating->rangeOtherLayers.at("SECOND")(1, 3) * rotating->rangeResolution, 10, 0.002);
  EXPECT_EQ(rotating->rangeImage(0, 3), 0);
  EXPECT_EQ(rotating->intensityImage(1, 3), 50);
  EXPECT_NEAR(rotating->sensorPose.z(), 0.3, 1e-12);
  EXPECT_NEAR(rotating->sweepDuration, 0.07, 1e-9);

  // Beams of its own have no place in a matrix.
  Recording own = three_lidars();
  own.lidars[0].spec.regular = false;
  const auto other = make_rawlog_recorder(folder / "own.rawlog", {0, 0.001, own});
  other->write_lidar(two_echoes(0));
  other->finish();
  mrpt::io::CFileGZInputStream own_file(folder / "own.rawlog");
  auto own_archive = mrpt::serialization::archiveFrom(own_file);
  EXPECT_TRUE(std::dynamic_pointer_cast<mrpt::obs::CObservationPointCloud>(own_archive.ReadObject()));

  const auto points = std::dynamic_pointer_cast<mrpt::maps::CPointsMapXYZI>(cloud->pointcloud);
  ASSERT_TRUE(points);
  ASSERT_EQ(points->size(), 2u);
  float x, y, z;
  points->getPoint(1, x, y, z);
  EXPECT_EQ(x, 6);
  EXPECT_EQ(y, 8);
  EXPECT_NEAR(points->getPointIntensity(1), 0.2f, 1e-6f);

  ASSERT_EQ(planar->getScanSize(), 8u);
  EXPECT_TRUE(planar->getScanRangeValidity(3));
  EXPECT_FALSE(planar->getScanRangeValidity(4));
  EXPECT_EQ(planar->getScanRange(3), 5);
  EXPECT_NEAR(planar->getScanAngle(3), (-78.75 + 3 * 22.5) * std::acos(-1.0) / 180, 1e-6);
}

}  // namespace lidar_recording_test
}  // namespace rubble
