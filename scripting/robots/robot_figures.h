// What a kind of robot adds to the keys of a mission: figures of its own, held by value.
#pragma once

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <vector>

#include "scripting/schema/schema.h"

namespace rubble {

class RobotFigures {
 public:
  virtual ~RobotFigures() = default;
  virtual void add_keys(Schema& keys) = 0;  // bound to this object
  virtual std::unique_ptr<RobotFigures> clone() const = 0;
  virtual bool equals(const RobotFigures& other) const = 0;  // of the same type
};

// T: a struct with the figures, which has == .
template <typename T>
class FiguresOf : public RobotFigures {
 public:
  std::unique_ptr<RobotFigures> clone() const override { return std::make_unique<T>(static_cast<const T&>(*this)); }
  bool equals(const RobotFigures& other) const override { return static_cast<const T&>(*this) == static_cast<const T&>(other); }
};

// Those of all kinds, since the tables of a mission have the keys of all; copied with them.
class FiguresOfKinds {
 public:
  FiguresOfKinds() = default;
  FiguresOfKinds(const FiguresOfKinds& other) {
    for (const auto& figures : other.all_) add(figures->clone());
  }
  FiguresOfKinds(FiguresOfKinds&&) noexcept = default;
  FiguresOfKinds& operator=(FiguresOfKinds other) noexcept { return all_.swap(other.all_), *this; }

  void add(std::unique_ptr<RobotFigures> figures) {
    if (figures) all_.push_back(std::move(figures));
  }
  template <typename T>
  T& of() const {
    for (const auto& figures : all_)
      if (auto* found = dynamic_cast<T*>(figures.get())) return *found;
    throw std::logic_error("no kind of robot has these figures");
  }
  const std::vector<std::unique_ptr<RobotFigures>>& all() const { return all_; }

  bool operator==(const FiguresOfKinds& other) const {
    return std::equal(all_.begin(), all_.end(), other.all_.begin(), other.all_.end(),
                      [](const auto& a, const auto& b) { return a->equals(*b); });
  }

 private:
  std::vector<std::unique_ptr<RobotFigures>> all_;
};

}  // namespace rubble
