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
ScanObservation two_echoes(LidarPattern pattern, bool regular = true) {
  LidarSpec spec;
  spec.pattern = pattern, spec.regular = regular;
  spec.elevations_deg = {-1, 1};
  if (spec.planar()) spec.elevations_deg = {0};
  spec.delays_ns.assign(spec.elevations_deg.size(), 0);
  spec.columns = 8, spec.column_ns = 10'000'000;
  spec.first_azimuth_deg = spec.planar() ? -78.75 : 180;
  spec.span_deg = spec.planar() ? 180 : -360;
  spec.returns = LidarReturns::dual;
  RangeScan scan;
  scan.spec = std::make_shared<const LidarSpec>(spec);
  scan.stamp_ns = 1'500'000'000;
  const auto ring = std::uint16_t(spec.planar() ? 0 : 1);
  scan.points = {{3, 4, 0, 50, 0.03f, ring, 3}, {6, 8, 0, 20, 0.03f, ring, 3}};
  return {std::make_shared<const RangeScan>(scan)};
}

// Its file, with an observation of each.
void write_scans(const std::string& path, const std::vector<ScanObservation>& scans) {
  RawlogOptions options;
  for (const ScanObservation& scan : scans)
    options.recording.sensors.push_back({"lidar" + std::to_string(options.recording.sensors.size()), "", "", "", {{}, {0.1, 0.2, 0.3}},
                                         std::make_shared<test::FixedObservation>(scan)});
  const auto recorder = make_rawlog_recorder(path, options);
  for (int i = 0; i < int(scans.size()); ++i) recorder->write_reading({i, 1'500'000'000, {}});
  recorder->finish();
}

TEST(LidarRawlog, MrptReadsRangesPointsAndPlaces) {
  test::ScratchFolder folder;
  write_scans(folder / "mission.rawlog",
              {two_echoes(LidarPattern::spinning), two_echoes(LidarPattern::rosette), two_echoes(LidarPattern::planar)});

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
  write_scans(folder / "own.rawlog", {two_echoes(LidarPattern::spinning, false)});
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
