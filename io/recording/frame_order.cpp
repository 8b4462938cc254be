#include "io/recording/frame_order.h"

#include "kernel/base/error.h"
#include "render/streams/image_streams.h"

namespace rubble {
namespace {

void check_size(const char* what, std::size_t found, std::size_t expected,
                const std::string& where) {
  if (found == expected) return;
  throw RunError(where + "the " + what + " picture has " + std::to_string(found) +
                 " values where the intrinsics ask for " + std::to_string(expected));
}

void check_pictures(const Frame& frame, const Channels& channels, const std::string& where) {
  const Intrinsics& k = frame.intrinsics;
  if (k.width <= 0 || k.height <= 0) throw RunError(where + "the picture has no pixels");
  const std::size_t pixels = static_cast<std::size_t>(k.width) * static_cast<std::size_t>(k.height);
  check_size("colour", frame.rgb.size(), 3 * pixels, where);
  check_size("depth", frame.depth.size(), pixels, where);
  if (channels.right) check_size("right", frame.rgb_right.size(), 3 * pixels, where);
  if (channels.measured_depth)
    check_size("measured depth", frame.measured_depth.size(), pixels, where);
  for (const ImageStream* stream : channels.truth) {
    const auto image = find_image(frame, *stream);
    check_size(stream->name.c_str(), image ? count_values(*image) : 0,
               pixels * std::size_t(stream->components), where);
  }
}

}  // namespace

// Frames of a sequence come at a steady rate, rounded to nanoseconds: one interval that is half as long again as
// another means that something is missing between.
void FrameOrder::check_stamp(const Frame& frame, const std::string& where) {
  if (count_ == 0) return;
  const std::int64_t interval = frame.stamp_ns - last_stamp_ns_;
  if (interval <= 0) {
    throw RunError(where + "its stamp of " + std::to_string(frame.stamp_ns) +
                   " ns is not later than the one before, " + std::to_string(last_stamp_ns_) +
                   " ns");
  }
  if (frame.starts_sequence) {
    period_ns_ = 0;
    return;
  }
  if (period_ns_ == 0) period_ns_ = interval;
  if (2 * interval > 3 * period_ns_ || 3 * interval < 2 * period_ns_) {
    throw RunError(where + "it comes " + std::to_string(interval) +
                   " ns after the one before, where " + std::to_string(period_ns_) +
                   " ns are usual: there is a gap in the stamps");
  }
}

void FrameOrder::check(const Frame& frame) {
  const std::string where = recorder_ + ": frame " + std::to_string(frame.index) + ": ";
  if (frame.index != count_)
    throw RunError(where + "frame " + std::to_string(count_) + " was expected");
  check_stamp(frame, where);
  check_pictures(frame, channels_, where);
  last_stamp_ns_ = frame.stamp_ns;
  ++count_;
}

}  // namespace rubble
