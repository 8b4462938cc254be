// The figures that kinds of robots add to missions, by the names of their keys.
#pragma once

#include <string>

#include "scripting/robots/robot_figures.h"

namespace rubble::testing {

// Throws std::logic_error: no kind has such a key.
inline Value figure_of(const FiguresOfKinds& figures, const std::string& key) {
  for (const auto& own : figures.all()) {
    Schema keys;
    own->add_keys(keys);
    if (const Key* found = keys.find(key)) return read_slot(found->bind(0));
  }
  throw std::logic_error("no kind of robot has the key " + key);
}
inline double number_of(const FiguresOfKinds& figures, const std::string& key) { return figure_of(figures, key).number; }

}  // namespace rubble::testing
