// One picture of one frame as a recording holds it, read back to say where two recordings part.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "render/scene/frame.h"

namespace rubble {

class PictureImporter;

struct PictureWanted {
  std::string channel;  // the name of an image stream: render/streams/image_streams.h
  int frame = 0;        // from 0
  bool measured_depth =
      false;  // whether the frames have that channel: the exact depth is elsewhere
  std::string camera{};  // of several: its name; formats that hold one camera are in cameras/NAME
  std::string topic{};   // ROS: prefix of its topics; empty: "/NAME"
};

struct RecordedPicture {
  std::string file;            // relative to the folder: "frames/rgb/000003.png", "mission.bag"
  int width = 0, height = 0;   // unit: pixel
  int components = 1;          // values of a pixel
  std::vector<double> values;  // rows from the top; NaN: none
  double step = 0;             // what the file rounds depth to; unit: m; 0: it is exact
};

// From the first of these that the folder of a run has and that can be read: `frames`, mission.bag,
// mission.mcap, mission.rawlog, `tum`, `colmap`. Those that keep every bit of the channel come
// before those that round; what was compressed with losses is none of them. `left_out`: files
// (names relative to the folder) that are not to be believed.
std::optional<RecordedPicture> find_recorded_picture(const std::string& folder,
                                                     const PictureWanted& wanted,
                                                     const std::set<std::string>& left_out = {});

// Out of the folder `frames`, which has every channel bit for bit. importer: of that folder. Throws InputError: there is
// none, or it is damaged.
std::optional<RecordedPicture> read_frames_picture(PictureImporter& importer, const std::string& folder,
                                                   const PictureWanted& wanted);

// Makes it the channel of a frame that it was: colour, depth or a stream of ground truth. The mark of an unknown flow
// becomes NaN, and depth of 0, where integers hold it, as well.
void put_picture(const RecordedPicture& picture, const std::string& channel, Frame& frame);

// "pixel (12, 7) is the first that differs: 12 34 56 instead of 12 34 57, and so do 3 more"; empty:
// they are the same, NaN included. Pixels are numbered from 0, columns first.
std::string describe_difference(const RecordedPicture& was, const RecordedPicture& is);

}  // namespace rubble
