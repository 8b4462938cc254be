// Pictures side by side with a line or two below each: what `rubble assets show` writes.
#pragma once

#include <string>
#include <vector>

#include "io/image/image_file.h"

namespace rubble {

struct SheetTile {
  RgbImage picture;  // all of one size
  std::string name;  // printed below; ASCII, cut off where it does not fit
  std::string note;  // below the name, fainter
};

// Throws InputError for a file that --out names and that ends neither with .png nor with .jpg or .jpeg.
void check_picture_name(const std::string& path);

// The tiles, row by row, as a JPEG where the path ends with .jpg or .jpeg, else as a PNG. Throws
// RunError when it cannot be written. columns: range: at least 1; title: printed at the top; ASCII
void write_picture_sheet(const std::string& path, const std::string& title,
                         const std::vector<SheetTile>& tiles, int columns);

}  // namespace rubble
