// Readings of sensors as MRPT's observations. Internal to io/mrpt.
#pragma once

#include <mrpt/obs/CObservation.h>

#include <functional>

#include "io/recording/recording.h"

namespace rubble {

// RangeObservation: CObservationRange; no echo is 0. InertialObservation: CObservationIMU; fields in gauss.
// SatelliteObservation: CObservationGPS with a GGA message; without a fix its quality is 0.
// write: called once, or not at all where MRPT has no observation.
void write_reading_observation(const Reading& reading, const SensorRecord& sensor,
                               const std::function<void(const mrpt::obs::CObservation&)>& write);

}  // namespace rubble
