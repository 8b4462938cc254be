// The LiDARs of a mission as plain data. lidar_schema.cpp lists their keys.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kernel/base/math.h"
#include "render/scene/lidar_spec.h"
#include "scripting/trajectory/trajectory.h"

namespace rubble {

// Figures and sources: lidar_models.cpp.
enum class LidarModel { vlp16, os0, os1, os2, mid360, utm30lx };

// One of the LiDARs on the rig that flies the trajectory, or on a link of a robot. What is not given is the model's own.
struct LidarScenario {
  std::string name = "lidar";             // lower-case letters, digits and underscores
  LidarModel model = LidarModel::vlp16;   // whose figures it has where no key says otherwise
  Carrier ride{};                         // what carries it instead of the rig
  Vec3 position;                          // in the rig or the link (X forward, Y left, Z up); unit: m
  Vec3 rpy_deg;                           // likewise; unit: degree
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
  bool noise = true;                      // false: exact ranges, and no chance in detection
  std::optional<std::string> topic{};     // ROS; not given: see lidar_topic()
  std::optional<std::string> frame_id{};  // TF; not given: "NAME_link"

  bool has_channels() const;  // whether `channels`, `columns` and keys of beams may be set
  bool has_own_beams() const { return !beam_elevations_deg.empty() || !beam_azimuths_deg.empty() || beam_radius != 0 || beam_height != 0; }
  bool planar() const { return model == LidarModel::utm30lx; }  // ROS: LaserScan, not PointCloud2
  Pose rig_from_lidar() const;
  LidarSpec spec() const;  // with every figure
};

}  // namespace rubble
