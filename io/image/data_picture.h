// Pictures whose pixels are numbers, such as heights: read as they are stored, without the conversions of
// colour pictures (picture_decoder.h).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rubble {

struct RgbaImage;

// Where a GeoTIFF's pixels lie, in the coordinates of its map.
struct PictureGround {
  double pixel_x = 0, pixel_y = 0;  // size of a pixel; unit: m, or degree
  double left = 0, top = 0;         // outer corner of the first pixel; unit: as above
  bool degrees = false;             // longitude and latitude
};

struct DataPicture {
  int width = 0, height = 0;       // unit: pixel
  std::vector<float> values;       // rows from the top; NaN: the file has no value there
  double white = 0;                // of grey levels, the largest that their bits hold; 0: signed or real numbers
  std::optional<PictureGround> ground{};  // of a GeoTIFF
  bool colour = false;             // the pixels have colours; values are their brightness
};

// Of a picture that is read.
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
inline constexpr std::uint64_t kMostDataPixels = 1 << 20;  // or most of the time goes there
#else
inline constexpr std::uint64_t kMostDataPixels = 64'000'000;
#endif

// "PNG", "BMP", ...; also kinds that are not read: "GIF", "JPEG 2000" and others. Empty: it is no picture that is
// known.
std::string picture_kind(std::string_view bytes);

// PNG (8 and 16 bits), JPEG, TIFF (integers and floats of one or three channels), OpenEXR (as exr_file.cpp chooses
// channels), WebP, BMP, and the Netpbm formats PGM, PPM, PBM and PFM. Of colours the brightness: 0.2126 R + 0.7152 G +
// 0.0722 B of the stored values. Transparent pixels are black. Throws RunError that says why it cannot be: "is a GIF
// picture; PNG, JPEG, TIFF, OpenEXR, WebP, BMP, PGM, PPM, PBM and PFM are read: convert it".
DataPicture decode_data_picture(std::string_view bytes);

// Of a TIFF, in a child process (kernel/base/system/isolated_worker.h). Throws RunError.
DataPicture decode_tiff_data(std::string_view bytes);
// Of an OpenEXR, likewise. Its values are real numbers.
DataPicture decode_exr_data(std::string_view bytes);
// Of pictures without compression, or with BMP's runs. Those of a PFM are real numbers.
DataPicture decode_bmp_data(std::string_view bytes);
DataPicture decode_netpbm_data(std::string_view bytes);

// For the decoders. A few bytes of a run may stand for a picture of any size: checked before it is made. Throws RunError.
void check_data_size(std::uint64_t width, std::uint64_t height);
float brightness_of(float r, float g, float b);
DataPicture data_from_colours(const RgbaImage& image);

}  // namespace rubble
