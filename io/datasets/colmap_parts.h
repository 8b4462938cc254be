// The two encodings of a COLMAP model; for colmap_model.cpp.
#pragma once

#include <string>

#include "io/datasets/colmap_model.h"

namespace rubble {

// Where each image and point was found, for errors that only the whole model shows: line numbers of
// a text, bytes of a binary file.
struct ColmapPlaces {
  std::vector<std::size_t> images, points;  // in the order of the model's
};

struct ColmapParts {
  ColmapModel model;    // not checked across files
  ColmapPlaces places;  // of its images and points
};

// Throw InputError as load_colmap_model; they do not compare the files with each other.
ColmapParts read_colmap_text(const std::string& folder);
ColmapParts read_colmap_binary(const std::string& folder);

// "3.5" and the like as a finite number; false for anything else.
bool parse_colmap_number(const std::string& word, double& value);

}  // namespace rubble
