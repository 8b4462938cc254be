// Readings of sensors as MRPT's observations. Internal to io/mrpt.
#pragma once

#include <functional>
#include <mrpt/obs/CObservation.h>

#include "io/recording/recording.h"
#include "render/scene/range_scan.h"

namespace rubble {

// RangeObservation: CObservationRange; no echo is 0. InertialObservation: CObservationIMU; fields in gauss.
// SatelliteObservation: CObservationGPS with a GGA message; without a fix its quality is 0.
// write: called once, or not at all where MRPT has no observation.
void write_reading_observation(const Reading& reading, const SensorRecord& sensor,
                               const std::function<void(const mrpt::obs::CObservation&)>& write);

// Scans of ranges as such.
// spinning: CObservationRotatingScan. Rows are rings, the lowest first, columns go the way the sensor
//   turns; ranges are multiples of 2 mm, beyond a reach of 131 m of 4 mm and so on, 0 without an echo. The second echo of a ray is in the layer "SECOND".
// rosette: CObservationPointCloud with a CPointsMapXYZI. planar: CObservation2DRangeScan, whose
//   rays MRPT takes to lie evenly about X.
// write: called once.
void write_range_scan(const RangeScan& scan, const SensorRecord& sensor,
                      const std::function<void(const mrpt::obs::CObservation&)>& write);

}  // namespace rubble
