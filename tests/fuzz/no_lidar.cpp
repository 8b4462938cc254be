// Of LiDARs, which the kinds of sensors name: the fuzz targets read missions and take no scans.
#include <stdexcept>

#include "render/lidar/lidar.h"

namespace rubble {

Lidar::Lidar(const LidarSpec& spec, std::shared_ptr<RayWorld>, LidarPlace, const Medium&, std::uint64_t, int)
    : seed_(0), pattern_(spec) {
  throw std::logic_error("a fuzz target takes a scan");
}

RangeScan Lidar::take(int) { throw std::logic_error("a fuzz target takes a scan"); }

}  // namespace rubble
