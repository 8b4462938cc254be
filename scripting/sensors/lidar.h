// The figures of LiDARs: what a mission states, and what the models of makers give for the rest.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/scene/lidar_spec.h"
#include "scripting/sensors/sensor_item.h"

namespace rubble {

// Figures and sources: lidar_models.cpp.
enum class LidarModel { vlp16, os0, os1, os2, mid360, utm30lx };

// Whose driver's messages its scans are in ROS.
enum class LidarDriver { velodyne, ouster, livox };

// The names of the models in missions, in their order.
const std::vector<std::string>& lidar_model_names();

// What is not given is the model's own.
struct LidarFigures {
  LidarModel model = LidarModel::vlp16;   // whose figures it has where no key says otherwise
  int channels = 0;                       // of os0, os1, os2: 32, 64 or 128; 0: 64
  int columns = 0;                        // of os0, os1, os2: 512, 1024 or 2048; 0: 1024
  std::vector<double> beam_elevations_deg{};  // of each ring, rising; empty: of the model; unit: degree
  std::vector<double> beam_azimuths_deg{};    // of each ring beside its column, from X towards Y; empty: 0; unit: degree
  double beam_radius = 0, beam_height = 0;    // as LidarSpec's; unit: m
  std::optional<double> rate_hz{};        // scans per second; unit: Hz
  std::optional<double> min_range{}, max_range{};  // unit: m
  std::optional<double> range_at_10_percent{};     // unit: m
  std::optional<double> range_noise{};    // standard deviation; unit: m
  std::optional<double> range_step{};     // unit: m
  std::optional<double> divergence_mrad{};  // full angle; unit: mrad
  LidarReturns returns = LidarReturns::strongest;  // which echoes are reported
  LidarDriver driver = LidarDriver::velodyne;      // not of 2-D scanners

  bool has_channels() const;  // whether `channels`, `columns` and keys of beams may be set
  bool has_own_beams() const { return !beam_elevations_deg.empty() || !beam_azimuths_deg.empty() || beam_radius != 0 || beam_height != 0; }
  bool planar() const { return model == LidarModel::utm30lx; }  // ROS: LaserScan, not PointCloud2
  double rate() const { return rate_hz.value_or(planar() ? 40 : 10); }
  LidarSpec spec() const;  // with every figure
};

// A LiDAR of that name, as a mission would have it.
SensorItem make_lidar_item(const std::string& name, const LidarFigures& figures);

}  // namespace rubble
