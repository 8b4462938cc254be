// Videos of JPEG pictures in the MP4 container (ISO/IEC 14496-12 and -14), to be written from front to back: a head, a part
// for each picture, a tail.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace rubble {

class Mp4Video {
 public:
  Mp4Video(int width, int height) : width_(width), height_(height) {}

  static std::string head();
  static std::string part(std::string_view jpeg);  // of a picture
  // Notes a part that was written. stamp_ns: of its picture, since the first one.
  void note(std::size_t part_size, std::int64_t stamp_ns);
  std::string tail() const;  // at least one picture was noted

 private:
  int width_, height_;                      // unit: pixel
  std::vector<std::uint64_t> begins_, sizes_;  // of the pictures in the file; unit: byte
  std::vector<std::int64_t> times_;         // of the pictures, in ticks
  std::uint64_t end_ = head().size();       // of what was written
};

}  // namespace rubble
