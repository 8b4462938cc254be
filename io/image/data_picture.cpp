#include "io/image/data_picture.h"

#include <webp/decode.h>

#include "io/image/picture_decoder.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

using namespace std::string_view_literals;

constexpr const char* kReadKinds = "PNG, JPEG, TIFF, OpenEXR, WebP, BMP, PGM, PPM, PBM and PFM are read";

DataPicture data_from_png(std::string_view bytes) {
  const PngPixels png = read_png_pixels(bytes);
  DataPicture out;
  out.width = png.width, out.height = png.height;
  out.white = png.bits == 16 ? 65535 : 255;
  const std::size_t channels = std::size_t(png.channels);
  out.values.reserve(png.values.size() / channels);
  for (std::size_t i = 0; i < png.values.size(); i += channels) {
    const std::uint16_t* p = &png.values[i];
    float value = p[0];
    if (channels >= 3) {
      value = brightness_of(p[0], p[1], p[2]);
      out.colour = out.colour || p[0] != p[1] || p[1] != p[2];
    }
    if (channels % 2 == 0) value *= float(p[channels - 1] / out.white);
    out.values.push_back(value);
  }
  return out;
}

}  // namespace

float brightness_of(float r, float g, float b) {
  return r == g && g == b ? r : 0.2126f * r + 0.7152f * g + 0.0722f * b;
}

void check_data_size(std::uint64_t width, std::uint64_t height) {
  check_picture_size(width, height);
  if (width * height > kMostDataPixels) throw RunError("has more than 64 million pixels");
}

DataPicture data_from_colours(const RgbaImage& image) {
  DataPicture out;
  out.width = image.width, out.height = image.height, out.white = 255;
  out.values.reserve(image.rgba.size() / 4);
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    const std::uint8_t* p = &image.rgba[i];
    const float value = brightness_of(p[0], p[1], p[2]);
    out.values.push_back(p[3] == 255 ? value : value * float(p[3]) / 255);
    out.colour = out.colour || p[0] != p[1] || p[1] != p[2];
  }
  return out;
}

namespace {

DataPicture data_from_webp(std::string_view bytes) {
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(data, bytes.size(), &features) != VP8_STATUS_OK) throw RunError("is a damaged WebP: no good header");
  if (features.has_animation) throw RunError("is a WebP with several pictures; save one of them");
  check_data_size(std::uint64_t(features.width), std::uint64_t(features.height));
  RgbaImage image{features.width, features.height, {}};
  image.rgba.resize(std::size_t(image.width) * std::size_t(image.height) * 4);
  if (!WebPDecodeRGBAInto(data, bytes.size(), image.rgba.data(), image.rgba.size(), 4 * image.width))
    throw RunError("is a damaged WebP: not a whole image");
  return data_from_colours(image);
}

}  // namespace

// "P5" and the width or a comment. Text may begin with these letters, too.
static bool begins_netpbm(std::string_view bytes) {
  const std::size_t at = bytes.find_first_not_of(" \t\n\v\f\r", 2);
  return at != std::string_view::npos && (bytes[at] == '#' || (at > 2 && bytes[at] >= '0' && bytes[at] <= '9'));
}

std::string picture_kind(std::string_view bytes) {
  const std::pair<std::string_view, const char*> kinds[] = {
      {"\x89PNG\r\n\x1a\n", "PNG"},         {"\xff\xd8\xff", "JPEG"},
      {"II*\0"sv, "TIFF"},                  {"MM\0*"sv, "TIFF"},
      {"II+\0"sv, "TIFF"},                  {"MM\0+"sv, "TIFF"},
      {"P5", "PGM"},                        {"P2", "PGM"},
      {"P6", "PPM"},                        {"P3", "PPM"},
      {"P4", "PBM"},                        {"P1", "PBM"},
      {"Pf", "PFM"},                        {"PF", "PFM"},
      {"P7\nWIDTH", "PAM"},                 {"BM", "BMP"},
      {"GIF8", "GIF"},                      {"\x76\x2f\x31\x01", "OpenEXR"},
      {"#?RADIANCE", "Radiance HDR"},       {"\0\0\0\x0cjP  "sv, "JPEG 2000"},
      {"\xff\x4f\xff\x51", "JPEG 2000"},    {"CDF\x01", "NetCDF"},
      {"CDF\x02", "NetCDF"},                {"\x89HDF\r\n\x1a\n", "HDF5 or NetCDF"},
      {"PK\x03\x04", "ZIP archive, not a"}, {"8BPS", "Photoshop"},
      {"\x1f\x8b", "gzip archive, not a"},  {"DDS ", "DDS"}};
  if (bytes.substr(0, 4) == "RIFF" && bytes.size() >= 12 && bytes.substr(8, 4) == "WEBP") return "WebP";
  for (const auto& [magic, kind] : kinds)
    if (bytes.substr(0, magic.size()) == magic) {
      if (magic[0] == 'P' && magic.size() == 2 && !begins_netpbm(bytes)) continue;
      if (magic == "BM" && (bytes.size() < 14 || bytes.substr(6, 4) != "\0\0\0\0"sv)) continue;
      return kind;
    }
  return "";
}

DataPicture decode_data_picture(std::string_view bytes) {
  const std::string kind = picture_kind(bytes);
  if (kind == "PNG") return data_from_png(bytes);
  if (kind == "JPEG") return data_from_colours(decode_picture(bytes));
  if (kind == "TIFF") return decode_tiff_data(bytes);
  if (kind == "OpenEXR") return decode_exr_data(bytes);
  if (kind == "WebP") return data_from_webp(bytes);
  if (kind == "BMP") return decode_bmp_data(bytes);
  if (kind == "PGM" || kind == "PPM" || kind == "PBM" || kind == "PFM") return decode_netpbm_data(bytes);
  throw RunError((kind.empty() ? "is no picture; " : "is a " + kind + " picture; ") + kReadKinds + (kind.empty() ? "" : ": convert it"));
}

}  // namespace rubble
