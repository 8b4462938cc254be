// Pictures whose pixels are numbers, such as heights: read as they are stored, without the conversions of
// colour pictures (picture_decoder.h).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rubble {

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

inline constexpr std::uint64_t kMostDataPixels = 64'000'000;  // of a picture that is read

// "PNG", "JPEG", "TIFF", "PGM", "OpenEXR"; also kinds that are not read: "BMP", "GIF", "WebP", "JPEG 2000"
// and others. Empty: it is no picture that is known.
std::string picture_kind(std::string_view bytes);

// PNG (8 and 16 bits), JPEG, TIFF (integers and floats of one or three channels), PGM and OpenEXR (as exr_file.cpp
// chooses channels). Of colours the
// brightness: 0.2126 R + 0.7152 G + 0.0722 B of the stored values. Transparent pixels are black. Throws
// RunError that says why it cannot be: "is a BMP picture; PNG, JPEG, TIFF, PGM and OpenEXR are read".
DataPicture decode_data_picture(std::string_view bytes);

// Of a TIFF, in a child process (kernel/base/system/isolated_worker.h). Throws RunError.
DataPicture decode_tiff_data(std::string_view bytes);
// Of an OpenEXR, likewise. Its values are real numbers.
DataPicture decode_exr_data(std::string_view bytes);

}  // namespace rubble
