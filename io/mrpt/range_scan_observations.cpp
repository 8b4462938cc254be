#include "io/mrpt/range_scan_observations.h"

#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRotatingScan.h>

#include <algorithm>
#include <cmath>

#include "io/mrpt/mrpt_types.h"
#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

constexpr double kRadian = portable::kPi / 180;
constexpr double kMostSteps = 65535;
constexpr double kStep = 0.002;  // of ranges; unit: m

double range_of(const ScanPoint& p) {
  return std::sqrt(double(p.x) * double(p.x) + double(p.y) * double(p.y) + double(p.z) * double(p.z));
}

// The finest multiple of kStep by which its reach fits into 16 bits.
double range_step(const LidarSpec& spec) { return kStep * std::ceil(spec.max_range / (kStep * kMostSteps)); }

void describe(const RangeScan& scan, const SensorRecord& sensor, mrpt::obs::CObservation& out) {
  out.timestamp = mrpt_time(scan.stamp_ns);
  out.sensorLabel = sensor.name;
  out.setSensorPose(mrpt_pose(sensor.rig_from_sensor));
}

mrpt::obs::CObservationRotatingScan rotating_scan(const RangeScan& scan, const SensorRecord& sensor) {
  const LidarSpec& spec = *scan.spec;
  mrpt::obs::CObservationRotatingScan out;
  describe(scan, sensor, out);
  out.originalReceivedTimestamp = out.timestamp;
  out.lidarModel = spec.model;
  out.rowCount = std::uint16_t(spec.rings()), out.columnCount = std::uint16_t(spec.columns);
  out.minRange = spec.min_range, out.maxRange = spec.max_range;
  out.rangeResolution = range_step(spec);
  out.startAzimuth = spec.first_azimuth_deg * kRadian;
  out.azimuthSpan = spec.span_deg * (spec.columns - 1) / spec.columns * kRadian;
  out.sweepDuration = double(spec.column_ns) * 1e-9 * (spec.columns - 1);
  out.rangeImage.setZero(spec.rings(), spec.columns);
  out.intensityImage.setZero(spec.rings(), spec.columns);
  if (spec.returns == LidarReturns::dual) out.rangeOtherLayers["SECOND"].setZero(spec.rings(), spec.columns);
  for (const ScanPoint& p : scan.points) {
    const auto steps = std::uint16_t(std::min(kMostSteps, range_of(p) / out.rangeResolution + 0.5));
    if (out.rangeImage(p.ring, p.column) != 0) {
      out.rangeOtherLayers.at("SECOND")(p.ring, p.column) = steps;
      continue;
    }
    out.rangeImage(p.ring, p.column) = steps;
    out.intensityImage(p.ring, p.column) = std::uint8_t(std::min(255.0f, p.intensity + 0.5f));
  }
  return out;
}

mrpt::obs::CObservationPointCloud point_cloud(const RangeScan& scan, const SensorRecord& sensor) {
  mrpt::obs::CObservationPointCloud out;
  describe(scan, sensor, out);
  auto points = mrpt::maps::CPointsMapXYZI::Create();
  points->resize(scan.points.size());
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const ScanPoint& p = scan.points[i];
    points->setPointFast(i, p.x, p.y, p.z);
    points->setPointIntensity(i, p.intensity / 100);
  }
  out.pointcloud = points;
  return out;
}

mrpt::obs::CObservation2DRangeScan planar_scan(const RangeScan& scan, const SensorRecord& sensor) {
  const LidarSpec& spec = *scan.spec;
  mrpt::obs::CObservation2DRangeScan out;
  describe(scan, sensor, out);
  out.aperture = float(std::fabs(spec.span_deg) * (spec.columns - 1) / spec.columns * kRadian);
  out.rightToLeft = spec.span_deg > 0;
  out.maxRange = float(spec.max_range);
  out.stdError = float(spec.range_noise);
  out.beamAperture = float(spec.divergence_mrad * 1e-3);
  out.resizeScanAndAssign(std::size_t(spec.columns), 0, false);
  out.setScanHasIntensity(true);
  for (auto p = scan.points.rbegin(); p != scan.points.rend(); ++p) {
    out.setScanRange(p->column, float(range_of(*p)));
    out.setScanRangeValidity(p->column, true);
    out.setScanIntensity(p->column, int(p->intensity + 0.5f));
  }
  return out;
}

}  // namespace

void write_range_scan(const RangeScan& scan, const SensorRecord& sensor,
                      const std::function<void(const mrpt::obs::CObservation&)>& write) {
  switch (scan.spec->pattern) {
    case LidarPattern::spinning:  // a matrix of ranges has no place for beams of its own
      return scan.spec->regular ? write(rotating_scan(scan, sensor)) : write(point_cloud(scan, sensor));
    case LidarPattern::rosette:
      return write(point_cloud(scan, sensor));
    case LidarPattern::planar:
      return write(planar_scan(scan, sensor));
  }
}

}  // namespace rubble
