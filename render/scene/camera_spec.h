// What a camera measures, as plain data: the part of a mission that render/sensors carries out. With
// the defaults every stage is off, and a frame is the renderer's exact pinhole image.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "render/scene/frame.h"
#include "render/scene/image_stream.h"
#include "render/scene/optics_spec.h"

namespace rubble {

// Streams of ground truth beside colour and depth; each costs nothing where it is not asked for.
using StreamSet = std::vector<const ImageStream*>;

// How colours come about. fast: baked light, shadow maps and shading on the graphics device. reference:
// path tracing, see reference/path_tracer.h; slow, exact but for noise. draft: as fast, but shadows of the sun have
// hard edges and air scatters the lamp's light once. Depth and channels are the same.
enum class RenderQuality { fast, reference, draft };

struct ColourSpec {
  RenderQuality quality = RenderQuality::fast;  // the members below are of the reference alone
  int samples = 64;      // a pixel; noise falls with the root; range: 1 to 65536
  bool denoise = false;  // filtered, see reference/denoise.h
};

// The stamp of a frame is the middle of the exposure of the middle row.
struct ShutterSpec {
  // From the first row's exposure to the last row's; 0: all rows at once. unit: s; range: 0 to 1
  double readout = 0;
  // Images over the exposure time, added in linear light, one for each pixel of motion; needs an
  // exposure that is modelled.
  bool motion_blur = false;
  int most_samples = 33;  // images at most; range: 3 to 255
};

enum class ExposureMode {
  ideal,  // a display image: automatic, tone-mapped, nothing else modelled
  fixed,
  automatic,
};

// From luminance to the share x of saturation, by the saturation-based speed of ISO 12232:2006:
//   x = H S / 78 lx s,  H = 0.65 L t / N^2   (L in cd/m2, t in s, speed S, f-number N).
struct ExposureSpec {
  ExposureMode mode = ExposureMode::ideal;  // who sets the exposure
  double time = 0.01;   // unit: s; range: 1e-6 to 1; automatic: the first frame's guess is not used
  double iso = 100;     // speed S; range: 1 to 1e6
  double f_number = 2;  // range: 0.5 to 64
  // Automatic: the mean of the image is brought to 0.18 of saturation times 2^compensation. Time is
  // raised first, up to the longest, then speed. What a frame shows sets the exposure of the next
  // but `delay` frames; its error shrinks by e within every time constant.
  double compensation = 0;     // unit: stops; range: -8 to 8
  double longest_time = 0.02;  // unit: s; range: 1e-6 to 1
  double highest_iso = 1600;   // range: 1 to 1e6
  double time_constant = 0.3;  // unit: s; range: 0 to 60; 0: at once
  int delay = 1;               // unit: frames; range: 0 to 16
};

enum class Response { srgb, gamma, linear };

// Filters over the photosites, by the colours of the first two of the first two rows; none: every pixel
// measures all three colours.
enum class Mosaic { none, rggb, bggr, grbg, gbrg };

// From exposed light to stored numbers, as EMVA 1288 models a linear camera. Only with a modelled
// exposure.
struct ImageSensorSpec {
  bool noise = true;         // shot and read noise
  double full_well = 10000;  // electrons at saturation at speed 100, S times fewer at 100 S
  double read_noise = 4;     // standard deviation; unit: electrons; range: 0 to 1000
  int bits = 12;             // of the converter; range: 1 to 16
  double vignette = 0;       // 0: none; 1: the natural cos^4 fall-off; range: 0 to 4
  Response response = Response::srgb;  // from converter counts to the 8 bits that are stored
  double gamma = 2.2;                  // of Response::gamma; range: 0.2 to 5
  Mosaic mosaic = Mosaic::none;        // formulas: sensors/bayer.h
  // Images along each axis of a pixel that are added: its colour is the mean over its area, not that of
  // its middle. Each costs as much as a frame. range: 1 to 4
  int pixel_samples = 1;
  // What stays the same from picture to picture, by the seed; formulas: sensors/fixed_pattern.h.
  double prnu = 0;           // standard deviation of the gain; share; range: 0 to 0.5
  double dsnu = 0;           // standard deviation of the offset; unit: electron; range: 0 to 1e4
  double dark_current = 0;   // unit: electron/s; range: 0 to 1e7
  double hot_pixels = 0;     // share of photosites; range: 0 to 0.1
  double hot_current = 2e4;  // of these, the mean; our choice; unit: electron/s; range: 0 to 1e8
  int jpeg_quality = 0;      // losses of a JPEG of this quality, 1 to 100; 0: none

  bool has_pattern() const { return prnu > 0 || dsnu > 0 || dark_current > 0 || hot_pixels > 0; }
};

enum class DepthSensorType { none, ideal, structured_light, time_of_flight };

// Formulas and their sources: sensors/depth_sensor.h.
struct DepthSensorSpec {
  DepthSensorType type = DepthSensorType::none;  // none: no such channel
  double min_range = 0.5;  // unit: m; range: 0 to 100
  double max_range = 5;    // unit: m; range: above 0, to 1000
  bool noise = true;       // false: range and quantization alone
  // Structured light.
  double baseline = 0.075;         // projector to the camera's right; unit: m; above 0
  double disparity_step = 0.125;   // unit: pixel of a 640-pixel image; above 0
  double disparity_noise = 0.0625; // all noise, quantisation included; unit as the step's
  // Time of flight.
  double modulation_mhz = 20;      // range: 1 to 1000
  // Electrons of a facing white surface at 1 m; above 0. Against the background below it gives a
  // standard deviation of 17 mm at 3.5 m on a surface of 0.4, which Azure Kinect is stated and was
  // measured to keep (Toelgyessy, Dekan, Chovanec and Hubinsky 2021, "Evaluation of the Azure Kinect
  // and Its Comparison to Kinect V1 and Kinect V2", Sensors 21(2), 413).
  double signal = 2.35e5;
  double background = 2e3;         // electrons of other light; range: 0 and up
  double emitter_offset = 0.03;    // of the emitter, to the lens's right; our choice; unit: m
  double reflectance = 0;          // of all surfaces, in the infrared; 0: of each its own;
                                   // range: 0 to 1
  // Electrons; weaker returns are dropped: with the signal above a surface of 0.1 at 5.6 m, near the
  // 5.46 m to which that sensor is stated to reach
  double least_amplitude = 750;
  double step = 0.001;             // unit: m; 0: not quantised
};

// An event camera of the frame's size, after ESIM; formulas: sensors/event_camera.h.
struct EventCameraSpec {
  bool on = false;                // false: no events
  double threshold_up = 0.2;      // change of ln(luminance) that makes an event; above 0
  double threshold_down = 0.2;    // likewise when it grows darker
  double threshold_noise = 0.03;  // standard deviation from pixel to pixel; same unit
  double refractory = 1e-4;       // after an event a pixel is blind so long; unit: s
  double background_hz = 0.1;     // events of noise, each pixel; range: 0 to 1000
  double most_motion = 1;         // between two images of the simulation; unit: pixel
  double dark = 1e-3;             // luminance added before the logarithm; unit: cd/m2; above 0
};

struct CameraSpec {
  Intrinsics intrinsics;  // of the colour image
  StreamSet channels;     // ground truth that is made
  double baseline = 0;  // of a stereo pair: the right camera's distance; 0: none; unit: m
  ShutterSpec shutter;  // when each row is exposed
  ExposureSpec exposure;         // how bright the image is
  OpticsSpec optics;             // what the lens does to the light
  ImageSensorSpec sensor;        // noise, converter, response
  DepthSensorSpec depth_sensor;  // in the place of the camera
  EventCameraSpec event_camera;  // in the place of the camera
  // Where it is on its carrier, which bears the lamp; not given: the camera bears the lamp itself.
  std::optional<Pose> rig_from_camera;
  int number = 0;          // among the cameras of the recording: each hides the steps of 8 bits by noise of its own
  std::uint64_t seed = 0;  // of all other noise
  int threads = 1;         // the result does not depend on it
};

}  // namespace rubble
