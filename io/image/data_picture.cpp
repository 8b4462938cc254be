#include "io/image/data_picture.h"

#include <algorithm>

#include "io/image/picture_decoder.h"
#include "io/image/png_pixels.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

using namespace std::string_view_literals;

float brightness_of(float r, float g, float b) {
  return r == g && g == b ? r : 0.2126f * r + 0.7152f * g + 0.0722f * b;
}

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

DataPicture data_from_jpeg(std::string_view bytes) {
  const RgbaImage image = decode_picture(bytes);
  DataPicture out;
  out.width = image.width, out.height = image.height, out.white = 255;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    const std::uint8_t* p = &image.rgba[i];
    out.values.push_back(brightness_of(p[0], p[1], p[2]));
    out.colour = out.colour || p[0] != p[1] || p[1] != p[2];
  }
  return out;
}

// The next number of a PGM's header, in which # begins a comment; -1: there is none.
long next_pgm_number(std::string_view& bytes) {
  while (!bytes.empty() && (bytes[0] == '#' || bytes[0] == ' ' || (bytes[0] >= '\t' && bytes[0] <= '\r')))
    bytes.remove_prefix(bytes[0] == '#' ? std::min(bytes.find('\n'), bytes.size()) : 1);
  long value = -1;
  while (!bytes.empty() && bytes[0] >= '0' && bytes[0] <= '9' && value < 100'000'000) {
    value = 10 * std::max(value, 0L) + (bytes[0] - '0');
    bytes.remove_prefix(1);
  }
  return value;
}

DataPicture data_from_pgm(std::string_view bytes) {
  const bool plain = bytes[1] == '2';
  bytes.remove_prefix(2);
  const long width = next_pgm_number(bytes), height = next_pgm_number(bytes), white = next_pgm_number(bytes);
  if (width < 1 || height < 1 || white < 1 || white > 65535) throw RunError("is a damaged PGM: no good header");
  check_picture_size(std::uint64_t(width), std::uint64_t(height));
  DataPicture out;
  out.width = int(width), out.height = int(height), out.white = double(white);
  const std::size_t count = std::size_t(width) * std::size_t(height), size = white > 255 ? 2 : 1;
  if (!plain && !bytes.empty()) bytes.remove_prefix(1);
  if (bytes.size() < (plain ? 1 : size) * count) throw RunError("is a damaged PGM: the file ends too early");
  out.values.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto byte = [&](std::size_t k) { return long(static_cast<unsigned char>(bytes[k])); };
    const long value = plain ? next_pgm_number(bytes) : size == 2 ? 256 * byte(2 * i) + byte(2 * i + 1) : byte(i);
    if (value < 0 || value > white) throw RunError("is a damaged PGM: not a whole image");
    out.values.push_back(float(value));
  }
  return out;
}

}  // namespace

std::string picture_kind(std::string_view bytes) {
  const std::pair<std::string_view, const char*> kinds[] = {
      {"\x89PNG\r\n\x1a\n", "PNG"},         {"\xff\xd8\xff", "JPEG"},
      {"II*\0"sv, "TIFF"},                  {"MM\0*"sv, "TIFF"},
      {"II+\0"sv, "TIFF"},                  {"MM\0+"sv, "TIFF"},
      {"P5", "PGM"},                        {"P2", "PGM"},
      {"P6", "PPM"},                        {"P3", "PPM"},
      {"Pf\n", "PFM"},                      {"BM", "BMP"},
      {"GIF8", "GIF"},                      {"\x76\x2f\x31\x01", "OpenEXR"},
      {"#?RADIANCE", "Radiance HDR"},       {"\0\0\0\x0cjP  "sv, "JPEG 2000"},
      {"\xff\x4f\xff\x51", "JPEG 2000"},    {"CDF\x01", "NetCDF"},
      {"CDF\x02", "NetCDF"},                {"\x89HDF\r\n\x1a\n", "HDF5 or NetCDF"},
      {"PK\x03\x04", "ZIP archive, not a"}, {"8BPS", "Photoshop"},
      {"\x1f\x8b", "gzip archive, not a"},  {"DDS ", "DDS"}};
  if (bytes.substr(0, 4) == "RIFF" && bytes.size() >= 12 && bytes.substr(8, 4) == "WEBP") return "WebP";
  for (const auto& [magic, kind] : kinds)
    if (bytes.substr(0, magic.size()) == magic) {
      const bool letters = magic.size() == 2;  // "P5", "BM": text may begin so, too
      const bool space = bytes.size() > 2 && (bytes[2] == ' ' || bytes[2] == '#' || (bytes[2] >= '\t' && bytes[2] <= '\r'));
      if (magic[0] == 'P' && letters && !space) continue;
      if (magic == "BM" && (bytes.size() < 14 || bytes.substr(6, 4) != "\0\0\0\0"sv)) continue;
      return kind;
    }
  return "";
}

DataPicture decode_data_picture(std::string_view bytes) {
  const std::string kind = picture_kind(bytes);
  if (kind == "PNG") return data_from_png(bytes);
  if (kind == "JPEG") return data_from_jpeg(bytes);
  if (kind == "TIFF") return decode_tiff_data(bytes);
  if (kind == "PGM") return data_from_pgm(bytes);
  if (kind == "OpenEXR") return decode_exr_data(bytes);
  throw RunError(kind.empty() ? "is no picture; PNG, JPEG, TIFF, PGM and OpenEXR are read"
                              : "is a " + kind + " picture; PNG, JPEG, TIFF, PGM and OpenEXR are read");
}

}  // namespace rubble
