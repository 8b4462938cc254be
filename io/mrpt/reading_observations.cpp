#include "io/mrpt/reading_observations.h"

#include <algorithm>
#include <cmath>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRange.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/gnss_messages_ascii_nmea.h>

#include "io/mrpt/mrpt_types.h"
#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

constexpr double kGauss = 1e-4;  // unit: T

class ObservationWriter {
 public:
  ObservationWriter(const Reading& reading, const SensorRecord& sensor,
                    const std::function<void(const mrpt::obs::CObservation&)>& write)
      : reading_(reading), sensor_(sensor), write_(write) {}

  void operator()(std::monostate) const {}

  void operator()(const ScanObservation& from) const { write_range_scan(*from.scan, sensor_, write_); }

  void operator()(const RangeObservation& from) const {
    mrpt::obs::CObservationRange out;
    out.minSensorDistance = float(from.min_range), out.maxSensorDistance = float(from.max_range);
    out.sensorConeApperture = float(from.cone);
    out.sensedData.emplace_back();
    out.sensedData.back().sensedDistance = std::isinf(from.range) ? 0 : float(from.range);
    send(out);
  }

  void operator()(const InertialObservation& from) const {
    mrpt::obs::CObservationIMU out;
    const auto set = [&out](const std::vector<double>& values, mrpt::obs::TIMUDataIndex first, double unit) {
      for (std::size_t i = 0; i < values.size(); ++i) out.set(mrpt::obs::TIMUDataIndex(int(first) + int(i)), values[i] / unit);
    };
    set(from.magnetic_field, mrpt::obs::IMU_MAG_X, kGauss);
    set(from.orientation, mrpt::obs::IMU_ORI_QUAT_X, 1);
    set(from.pressure, mrpt::obs::IMU_PRESSURE, 1);
    set(from.altitude, mrpt::obs::IMU_ALTITUDE, 1);
    send(out);
  }

  void operator()(const SatelliteObservation& from) const {
    mrpt::obs::gnss::Message_NMEA_GGA gga;
    constexpr std::int64_t kDay = 86400LL * 1000000000;
    const double of_day = double(reading_.stamp_ns % kDay) * 1e-9;
    gga.fields.UTCTime.hour = std::uint8_t(of_day / 3600);
    gga.fields.UTCTime.minute = std::uint8_t(std::fmod(of_day, 3600) / 60);
    gga.fields.UTCTime.sec = std::fmod(of_day, 60);
    gga.fields.latitude_degrees = from.latitude_deg, gga.fields.longitude_degrees = from.longitude_deg;
    gga.fields.altitude_meters = from.altitude, gga.fields.orthometric_altitude = from.altitude;
    gga.fields.fix_quality = from.fix ? 1 : 0;
    gga.fields.satellitesUsed = std::uint32_t(from.satellites);
    gga.fields.thereis_HDOP = from.fix, gga.fields.HDOP = float(from.hdop);
    mrpt::obs::CObservationGPS out;
    out.originalReceivedTimestamp = mrpt_time(reading_.stamp_ns);
    out.has_satellite_timestamp = true;
    out.setMsg(gga);
    send(out);
  }

 private:
  template <typename Observation>
  void send(Observation& out) const {
    out.timestamp = mrpt_time(reading_.stamp_ns);
    out.sensorLabel = sensor_.name;
    out.setSensorPose(mrpt_pose(sensor_.rig_from_sensor));
    write_(out);
  }

  const Reading& reading_;
  const SensorRecord& sensor_;
  const std::function<void(const mrpt::obs::CObservation&)>& write_;
};

}  // namespace

void write_reading_observation(const Reading& reading, const SensorRecord& sensor,
                               const std::function<void(const mrpt::obs::CObservation&)>& write) {
  std::visit(ObservationWriter(reading, sensor, write), sensor.format->observe(reading));
}

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
