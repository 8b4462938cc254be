// From light to stored numbers: vignette, mosaic, fixed pattern, shot and read noise, saturation,
// converter, response, losses of a JPEG.
//
// A pixel that gets the share x of saturation holds x * W electrons on average, W = full_well * 100 /
// speed. Shot noise makes that a Poisson number, the amplifier adds normal noise of read_noise
// electrons, and the converter counts in steps of W / (2^bits - 1) electrons (EMVA Standard 1288,
// release 4.0). So the variance, in electrons, is mean + read_noise^2 + step^2 / 12: the photon
// transfer curve.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "render/camera/view_rays.h"
#include "render/scene/camera_spec.h"
#include "render/sensors/exposure_control.h"

namespace rubble {

class FixedPattern;

class ImageSensor {
 public:
  ImageSensor(const CameraSpec& spec, const LensDirections& directions);
  ~ImageSensor();

  // Converter counts, three a pixel, of a mosaic as demosaiced. light: kcd/m2. Noise follows from the seed, the frame's number
  // and the eye (0: left or only one, 1: right).
  std::vector<std::uint16_t> count(const std::vector<float>& light,
                                   const ExposureSettings& settings, int frame, int eye) const;
  std::vector<std::uint8_t> develop(const std::vector<std::uint16_t>& counts) const;

  int most() const { return most_; }  // the highest count
  // Mean share of saturation of what the lens sees: counts as measured, or light times `factor`.
  double mean_of(const std::vector<std::uint16_t>& counts) const;
  double mean_of(const std::vector<float>& light, double factor) const;

 private:
  bool has_mosaic() const { return spec_.sensor.mosaic != Mosaic::none; }

  CameraSpec spec_;
  int most_;
  std::vector<float> fall_off_;         // vignette, one a pixel; 0: the lens sees nothing
  std::vector<std::uint8_t> response_;  // by count
  std::array<std::unique_ptr<FixedPattern>, 2> patterns_;  // of each eye; null: none
};

}  // namespace rubble
