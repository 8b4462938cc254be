// preview.png: some frames of a recording at a glance, colour beside depth, and what a sensor that scans has measured until then.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/image/image_file.h"
#include "io/recording/recorder.h"

namespace rubble {

struct ContactSheetOptions {
  int total_frames = 0;  // how many will come, so that the chosen ones spread evenly; > 0
  int shown = 12;        // pairs on the sheet at most; range: 1 to 100
  int columns = 3;       // pairs a row; range: 1 to 10
  int tile = 320;        // width of one picture; unit: pixel; range: 64 to 2048
  std::string title;     // printed at the top; ASCII
  std::string scanner;   // name of the sensor whose scans are shown; empty: none
  int scanner_number = 0;  // Reading::sensor of its scans
};

// The picture of scans looks from above: the last scan before the frame, its echoes placed by the true motion and coloured
// by height above the sensor; all scans before it in grey; the way of the sensor as a line. X is to the right.
//
// The first and the last frame are always among the shown. All depth pictures share one logarithmic
// scale, printed at the bottom: warm is near, cold is far, grey is no return.
// Throws InputError for options out of range, RunError when `path` cannot be created.
std::unique_ptr<Recorder> make_contact_sheet_recorder(const std::string& path,
                                                      const ContactSheetOptions& options);

// The colour pictures of a sheet that was made with the default size of tiles, in their order; empty: it is no such sheet.
std::vector<RgbImage> cut_colour_tiles(const RgbImage& sheet);

}  // namespace rubble
