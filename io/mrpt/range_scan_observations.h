// Scans of ranges as MRPT's observations. Internal to io/mrpt.
#pragma once

#include <mrpt/obs/CObservation.h>

#include <functional>

#include "io/recording/recording.h"
#include "render/scene/range_scan.h"

namespace rubble {

// spinning: CObservationRotatingScan. Rows are rings, the lowest first, columns go the way the sensor
//   turns; ranges are multiples of 2 mm, beyond a reach of 131 m of 4 mm and so on, 0 without an echo. The second echo of a ray is in the layer "SECOND".
// rosette: CObservationPointCloud with a CPointsMapXYZI. planar: CObservation2DRangeScan, whose
//   rays MRPT takes to lie evenly about X.
// write: called once.
void write_range_scan(const RangeScan& scan, const SensorRecord& sensor,
                      const std::function<void(const mrpt::obs::CObservation&)>& write);

}  // namespace rubble
