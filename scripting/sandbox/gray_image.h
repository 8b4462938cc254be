// Small grey images that a script may read: PNG files, kept as plain text, so that what a mission was
// made from stays readable in its manifest.
#pragma once

#include <string>
#include <vector>

namespace rubble {

struct GrayGrid {
  int columns = 0, rows = 0;   // unit: pixel; range: 1 to 256
  std::vector<double> values;  // row by row from the top; 0: black, 1: white
};

bool is_png(const std::string& bytes);

// A plain PGM text ("P2"). Larger images than 256 pixels a side are averaged over square blocks.
// Throws std::runtime_error when it is no good PNG or larger than 16 million pixels.
std::string png_to_pgm(const std::string& bytes);

// Throws std::runtime_error for what is no such text.
GrayGrid parse_pgm(const std::string& text);

}  // namespace rubble
