#include "scripting/scenario/optics_schema.h"

namespace rubble {

void add_optics_keys(Schema& k, const std::string& at, OpticsSpec& o) {
  k.value(at + "optics.point_spread", o.point_spread,
          "Blur of the whole image: standard deviation of the Gaussian core of the point spread function.")
      .between(0, 20)
      .unit("pixel");
  k.value(at + "optics.glare", o.glare,
          "Veiling glare and bloom: share of the light that the lens scatters.")
      .between(0, 0.5);
  k.value(at + "optics.focus_distance", o.focus_distance,
          "Distance in focus; 0: all distances are sharp.")
      .between(0, 1e4)
      .unit("m");
  k.value(at + "optics.focal_length", o.focal_length,
          "Focal length. The diameter of the aperture is focal_length / `exposure.f_number`. The field of view does "
          "not change.")
      .between(1e-4, 2)
      .unit("m");
  k.value(at + "optics.lateral_colour", o.lateral_colour,
          "Lateral chromatic aberration: distance of red outside blue in the farthest corner.")
      .between(-20, 20)
      .unit("pixel");
  k.value(at + "optics.dirt", o.dirt, "Opacity of smudges on the lens, drawn from the seed; 0: clean.")
      .between(0, 1);
  k.value(at + "optics.drops", o.drops, "Number of rain drops on the lens, drawn from the seed.")
      .between(0, 500);
}

void add_sensor_pattern_keys(Schema& k, const std::string& at, ImageSensorSpec& s) {
  k.value(at + "sensor.pixel_samples", s.pixel_samples,
          "Colour samples of a pixel along each axis, for smooth edges; n x n images are rendered. Depth and "
          "channels are those of the pixel centre.")
      .between(1, 4);
  k.choice(at + "sensor.mosaic", s.mosaic, {"none", "rggb", "bggr", "grbg", "gbrg"},
           "Bayer mosaic of colour filters; the image is demosaiced (Malvar, He and Cutler 2004).");
  k.value(at + "sensor.prnu", s.prnu,
          "Photo response non-uniformity: standard deviation of the gain of the pixels.")
      .between(0, 0.5);
  k.value(at + "sensor.dsnu", s.dsnu,
          "Dark signal non-uniformity: standard deviation of the offset of the pixels, in electrons.")
      .between(0, 1e4);
  k.value(at + "sensor.dark_current", s.dark_current, "Dark current of every pixel.")
      .between(0, 1e7)
      .unit("electron/s");
  k.value(at + "sensor.hot_pixels", s.hot_pixels,
          "Share of hot pixels, drawn from the seed.")
      .between(0, 0.1);
  k.value(at + "sensor.hot_current", s.hot_current,
          "Mean dark current of a hot pixel; exponential distribution.")
      .between(0, 1e8)
      .unit("electron/s");
  k.value(at + "sensor.jpeg_quality", s.jpeg_quality,
          "Artefacts of JPEG compression at this quality, in all outputs; 0: none.")
      .between(0, 100);
}

void check_optics(const CameraScenario& camera, const std::string& at, std::vector<Diagnostic>& mistakes) {
  const OpticsSpec& o = camera.optics;
  const ImageSensorSpec& s = camera.sensor;
  const auto add = [&](const char* key, const char* message, const std::string& expected) {
    mistakes.push_back({"", 0, at + key, message, expected, "", ""});
  };
  if (o.focus_distance > 0 && o.focus_distance <= o.focal_length)
    add("optics.focus_distance", "no lens is sharp within its focal length",
        "more than " + at + "optics.focal_length, or 0");
  if (camera.colour.quality == RenderQuality::reference && s.pixel_samples > 1)
    add("sensor.pixel_samples", "path tracing samples the pixel already", "1");
  if (camera.exposure.mode != ExposureMode::ideal) return;
  const std::string modelled = at + "exposure.mode of \"fixed\" or \"automatic\"";
  if (o.any()) add("optics", "an ideal image has a perfect lens", modelled);
  if (s.mosaic != Mosaic::none || s.has_pattern() || s.jpeg_quality > 0 || s.pixel_samples > 1)
    add("sensor", "an ideal image has no mosaic, fixed pattern, artefacts or pixel_samples", modelled);
}

}  // namespace rubble
