#include "io/frame_order.h"

#include "kernel/base/error.h"

namespace rubble {
namespace {

void check_size(const char* what, std::size_t found, std::size_t expected,
                const std::string& where) {
  if (found == expected) return;
  throw RunError(where + "the " + what + " picture has " + std::to_string(found) +
                 " values where the intrinsics ask for " + std::to_string(expected));
}

}  // namespace

void FrameOrder::check(const Frame& frame) {
  const std::string where = recorder_ + ": frame " + std::to_string(frame.index) + ": ";
  if (frame.index != count_) {
    throw RunError(where + "frame " + std::to_string(count_) + " was expected");
  }
  if (count_ > 0 && frame.stamp_ns <= last_stamp_ns_) {
    throw RunError(where + "its stamp of " + std::to_string(frame.stamp_ns) +
                   " ns is not later than the one before, " + std::to_string(last_stamp_ns_) +
                   " ns");
  }
  const Intrinsics& k = frame.intrinsics;
  if (k.width <= 0 || k.height <= 0) throw RunError(where + "the picture has no pixels");
  const std::size_t pixels = static_cast<std::size_t>(k.width) * static_cast<std::size_t>(k.height);
  check_size("colour", frame.rgb.size(), 3 * pixels, where);
  check_size("depth", frame.depth.size(), pixels, where);
  last_stamp_ns_ = frame.stamp_ns;
  ++count_;
}

}  // namespace rubble
