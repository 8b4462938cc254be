#include "io/recording/recording.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace rubble {

bool Channels::has_legend() const {
  return std::any_of(truth.begin(), truth.end(), [](const auto* s) { return s->has_legend; });
}

bool CameraRecord::is_rig() const {
  return rig_from_camera.rotation == Quat() && rig_from_camera.translation == Vec3();
}

// The same bits where the camera is the rig.
Pose CameraRecord::in_rig(const Pose& camera_from_it) const {
  return is_rig() ? camera_from_it : rig_from_camera * camera_from_it;
}

bool Recording::has_legend() const {
  return std::any_of(cameras.begin(), cameras.end(),
                     [](const CameraRecord& c) { return c.channels.has_legend(); });
}

Recording Recording::of_camera(std::size_t camera) const {
  Recording one = *this;
  one.cameras = {cameras.at(camera)};
  one.imus.clear();
  for (const ImuRecord& imu : imus)
    if (imu.carrier == one.cameras.front().carrier) one.imus.push_back(imu);
  return one;
}

std::string legend_to_json(const Legend& legend) {
  using Json = nlohmann::ordered_json;
  Json json;
  json["labels"] = Json::array();
  for (std::size_t i = 0; i < legend.labels.size(); ++i)
    json["labels"].push_back({{"label", i}, {"name", legend.labels[i]}});
  json["instances"] = Json::array();
  for (std::size_t i = 0; i < legend.pieces.size(); ++i) {
    const Legend::Piece& piece = legend.pieces[i];
    json["instances"].push_back({{"instance", i}, {"label", piece.label}, {"name", piece.asset}});
  }
  for (std::size_t i = 0; i < legend.fines.size(); ++i)
    json["instances"].push_back({{"instance", legend.first_fine + i},
                                 {"label", legend.fines[i].label},
                                 {"name", legend.fines[i].asset}});
  for (std::size_t i = 0; i < legend.surroundings.size(); ++i)
    json["instances"].push_back({{"instance", legend.first_surrounding + i},
                                 {"label", legend.surroundings[i].label},
                                 {"name", legend.surroundings[i].asset}});
  json["ground_instance"] = kGroundInstance;
  json["no_instance"] = kNoInstance;
  return json.dump();
}

}  // namespace rubble
