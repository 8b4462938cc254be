#include "app/provenance/differing_pixel.h"

#include <algorithm>

#include "io/playback/recorded_picture.h"
#include "kernel/base/number_text.h"

namespace rubble {
namespace {

// Which of the camera's own frames the row is.
int number_of_camera(const FrameHashes& hashes, const std::string& camera, int row) {
  const auto& channels = hashes.channels;
  const auto at = std::find(channels.begin(), channels.end(), camera + "/pose");
  const auto pose = std::size_t(at - channels.begin());
  int number = 0;
  for (int i = 0; i < row && pose < channels.size(); ++i) number += hashes.frames[std::size_t(i)][pose] != 0;
  return number;
}

}  // namespace

std::string describe_pixel(const FrameDifference& apart, const FrameHashes& was, const std::string& folder_was,
                           const std::string& folder_is, const std::set<std::string>& altered) {
  if (apart.channel.empty() || !is_picture(apart.channel)) return "";
  PictureWanted wanted{apart.channel, apart.frame, false, ""};
  const std::size_t slash = apart.channel.find('/');
  if (slash != std::string::npos) {  // of several cameras
    wanted.camera = apart.channel.substr(0, slash);
    wanted.channel = apart.channel.substr(slash + 1);
    wanted.frame = number_of_camera(was, wanted.camera, apart.frame);
  }
  const std::string measured = apart.channel.substr(0, slash + 1) + "measured_depth";
  wanted.measured_depth = std::find(was.channels.begin(), was.channels.end(), measured) != was.channels.end();
  const auto before = find_recorded_picture(folder_was, wanted, altered);
  const auto now = find_recorded_picture(folder_is, wanted, altered);
  if (!before || !now || before->file != now->file)
    return "; no recording holds its pixels without losses, so which of them stays open";
  const std::string pixel = describe_difference(*before, *now);
  if (!pixel.empty()) return "; " + pixel + ", by " + before->file;
  return before->step > 0 ? "; " + before->file + " rounds depth to " + exact_text(before->step) + " m and shows no difference"
                          : "; yet " + before->file + " holds the same pixels: the manifest was altered";
}

}  // namespace rubble
