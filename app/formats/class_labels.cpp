#include "app/formats/class_labels.h"

#include "render/scene/frame.h"

namespace rubble {

ClassLabels::ClassLabels(const Scenario& scenario, const std::vector<PieceType>& types) : names_{"sky", "ground"} {
  for (const PieceType& type : types) names_.push_back(type.name);
  robots_ = std::uint16_t(names_.size());
  if (!scenario.robots.empty()) names_.push_back("robot");
  fines_ = std::uint16_t(names_.size());
  if (scenario.fines.amount > 0) names_.insert(names_.end(), fine_names().begin(), fine_names().end());
  surroundings_ = std::uint16_t(names_.size());
  if (scenario.surroundings.on()) names_.insert(names_.end(), surrounding_names().begin(), surrounding_names().end());
}

std::uint16_t ClassLabels::of_type(int type) const { return std::uint16_t(kFirstAssetLabel + type); }

}  // namespace rubble
