// The pixels of an event camera: each reports when the logarithm of its light has changed by a
// threshold since its last report (Rebecq, Gehrig and Scaramuzza 2018, "ESIM: an open event camera
// simulator").
//
// Between two images the logarithm is taken to change evenly, so an event's time is that of the
// crossing. A pixel's thresholds differ from the stated ones by a fixed normal error; for the
// refractory time after an event the pixel stays silent, though its reference level goes on; events
// of noise come as a Poisson process, of either sign.
#pragma once

#include <cstdint>
#include <vector>

#include "render/colour/light_watch.h"
#include "render/scene/camera_spec.h"

namespace rubble {

class EventPixels {
 public:
  EventPixels(const EventCameraSpec& spec, int width, int height, std::uint64_t seed);

  // light: luminance, one a pixel, rows from the top; unit: cd/m2. The first image only sets the
  // levels. Events since the image before are appended in order of stamp, row, column.
  void see(std::int64_t stamp_ns, const std::vector<float>& light, std::vector<Event>& events);
  // The same of the pixels alone that report, where a device has found them from pixels(). Not for one that has seen images.
  void see_changes(std::int64_t stamp_ns, const std::vector<LightChange>& changes, std::vector<Event>& events);
  WatchedPixels pixels() const;

 private:
  // reference: ln(light) of the last event; that of the last of these afterwards.
  void cross(std::size_t pixel, std::int64_t from_ns, std::int64_t to_ns, double from, double to,
             double& reference, std::vector<Event>& events);
  // Since the image before: with noise, in order from number `first` on.
  void end_image(std::int64_t stamp_ns, std::size_t first, std::vector<Event>& events);
  void add_noise(std::int64_t from_ns, std::int64_t to_ns, std::vector<Event>& events);

  EventCameraSpec spec_;
  int width_;
  std::uint64_t seed_;
  std::uint64_t images_ = 0;
  std::int64_t last_ns_ = 0;
  std::vector<double> level_, reference_;     // ln(light): seen last, of the last event
  std::vector<float> up_, down_;              // thresholds
  std::vector<std::int64_t> silent_until_ns_;
};

}  // namespace rubble
