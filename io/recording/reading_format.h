// How the readings of a sensor are written: as columns, as ROS messages, as observations of MRPT.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "kernel/base/math.h"
#include "render/scene/reading.h"

namespace rubble {

namespace ros {
enum class Version;
struct MessageType;
struct Header;
}  // namespace ros

// What MRPT has observations for (io/mrpt/reading_observations.h).
struct RangeObservation {  // CObservationRange
  double min_range = 0, max_range = 0, range = 0;  // unit: m
  double cone = 0;                                 // full angle; unit: rad
};
struct InertialObservation {  // CObservationIMU; what is not given is not there
  std::vector<double> magnetic_field{};  // x, y, z; unit: T
  std::vector<double> orientation{};     // x, y, z, w
  std::vector<double> pressure{};        // one number; unit: Pa
  std::vector<double> altitude{};        // one number; unit: m
};
struct SatelliteObservation {  // CObservationGPS, message GGA
  double latitude_deg = 0, longitude_deg = 0, altitude = 0, hdop = 0;
  int satellites = 0;
  bool fix = false;
};
struct ScanObservation {  // CObservationRotatingScan, CObservationPointCloud or CObservation2DRangeScan, as its rays lie
  std::shared_ptr<const RangeScan> scan;
};
// monostate: MRPT has none.
using RawlogObservation =
    std::variant<std::monostate, RangeObservation, InertialObservation, SatelliteObservation, ScanObservation>;

struct ReadingColumn {
  std::string name, unit;  // unit: empty: none
};

class ReadingFormat {
 public:
  virtual ~ReadingFormat() = default;

  // Meanings of Reading::values, in their order; empty: its readings are scans.
  virtual std::vector<ReadingColumn> columns() const = 0;
  virtual double most_points() const { return 0; }  // of a scan, with all its echoes; 0: it does not scan
  virtual std::shared_ptr<const LidarSpec> scan_spec() const { return nullptr; }  // of its scans, where their rays go; null: no scans
  bool exact = false;  // whether readings have no noise: messages then state no variance
  virtual std::string sample_name() const { return "reading"; }  // of what it gives: to Python

  // A reading is a message on each of these, below the sensor's own topic.
  struct Topic {
    std::string suffix;  // "" or "/wrench"
    const ros::MessageType* type;
  };
  virtual std::vector<Topic> topics() const = 0;
  // topic: index into topics().
  virtual std::string message(std::size_t topic, ros::Version version, const ros::Header& header,
                              const Reading& reading) const = 0;

  virtual RawlogObservation observe(const Reading&) const { return {}; }
};

}  // namespace rubble
