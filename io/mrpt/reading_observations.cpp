#include "io/mrpt/reading_observations.h"

#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationRange.h>
#include <mrpt/obs/gnss_messages_ascii_nmea.h>

#include <cmath>

#include "io/mrpt/mrpt_types.h"
#include "io/mrpt/range_scan_observations.h"

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

}  // namespace rubble
