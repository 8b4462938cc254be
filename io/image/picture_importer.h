// Pictures that Rubble writes, read back in a child process, since a file may be damaged or from a stranger.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/image/exr_file.h"
#include "io/image/image_file.h"

namespace rubble {

class IsolatedWorker;

// Reads many files by one child process: a child for each would cost 5 ms more a file, or more where this process is large.
class PictureImporter {
 public:
  // recording: the folder of files of one origin, which share a child; other files share one with those beside them.
  explicit PictureImporter(const std::string& recording = "");
  ~PictureImporter();

  // As the functions of these names.
  RgbImage read_rgb_png(const std::string& path);
  DepthImage read_depth_png(const std::string& path);
  ExrImage read_exr(const std::string& path, const std::vector<std::string>& channels);

 private:
  std::unique_ptr<IsolatedWorker> worker_;
};

}  // namespace rubble
