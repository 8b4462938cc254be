#include "io/recording/recording.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace rubble {

bool Channels::has_legend() const {
  return std::any_of(truth.begin(), truth.end(), [](const auto* s) { return s->has_legend; });
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
  json["ground_instance"] = kGroundInstance;
  json["no_instance"] = kNoInstance;
  return json.dump();
}

}  // namespace rubble
