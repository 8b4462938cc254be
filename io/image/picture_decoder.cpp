#include "io/image/picture_decoder.h"

#include <csetjmp>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <jpeglib.h>
#include <png.h>
#include <string>

#include "kernel/base/error.h"

namespace rubble {

void check_picture_size(std::uint64_t width, std::uint64_t height) {
  if (width == 0 || height == 0) throw RunError("has no pixels");
  if (width > kLargestPicture || height > kLargestPicture)
    throw RunError("has " + std::to_string(width) + " x " + std::to_string(height) + " pixels; at most " +
                   std::to_string(kLargestPicture) + " a side are read");
}

namespace {

// Values as they are stored: glTF tells renderers to ignore what an image says of its colour space (gAMA, cHRM, iCCP).
RgbaImage decode_png(std::string_view bytes) {
  const PngPixels png = read_png_pixels(bytes);
  RgbaImage out{png.width, png.height, {}};
  const std::size_t channels = std::size_t(png.channels);
  const auto rounded = [&png](std::uint16_t v) {
    return png.bits == 16 ? std::uint8_t((std::uint32_t(v) * 255 + 32767) / 65535) : std::uint8_t(v);
  };
  out.rgba.reserve(png.values.size() / channels * 4);
  for (std::size_t i = 0; i < png.values.size(); i += channels) {
    const std::uint16_t* p = &png.values[i];
    for (std::size_t k = 0; k < 3; ++k) out.rgba.push_back(rounded(p[channels >= 3 ? k : 0]));
    out.rgba.push_back(channels % 2 == 0 ? rounded(p[channels - 1]) : std::uint8_t(255));
  }
  return out;
}

struct JpegErrors {
  jpeg_error_mgr manager;
  std::jmp_buf leave;
  char message[JMSG_LENGTH_MAX];
};

void leave_by_jump(j_common_ptr jpeg) {
  auto* errors = reinterpret_cast<JpegErrors*>(jpeg->err);
  jpeg->err->format_message(jpeg, errors->message);
  std::longjmp(errors->leave, 1);
}

void say_nothing(j_common_ptr) {}

// libjpeg leaves by longjmp, which skips destructors: these functions own nothing.
bool read_header(jpeg_decompress_struct& jpeg, JpegErrors& errors, std::string_view bytes) {
  if (setjmp(errors.leave)) return false;
  jpeg_create_decompress(&jpeg);
  jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&jpeg, TRUE);
  return true;
}

bool read_rows(jpeg_decompress_struct& jpeg, JpegErrors& errors, std::uint8_t* rgb) {
  if (setjmp(errors.leave)) return false;
  jpeg.out_color_space = JCS_RGB;
  jpeg_start_decompress(&jpeg);
  const std::size_t row = std::size_t(jpeg.output_width) * 3;
  while (jpeg.output_scanline < jpeg.output_height) {
    JSAMPROW at = rgb + jpeg.output_scanline * row;
    jpeg_read_scanlines(&jpeg, &at, 1);
  }
  jpeg_finish_decompress(&jpeg);
  return true;
}

RgbaImage decode_jpeg(std::string_view bytes) {
  struct Reading {
    jpeg_decompress_struct jpeg{};
    ~Reading() { jpeg_destroy_decompress(&jpeg); }
  } reading;
  JpegErrors errors{};
  reading.jpeg.err = jpeg_std_error(&errors.manager);
  errors.manager.error_exit = leave_by_jump;
  errors.manager.output_message = say_nothing;
  const auto refuse = [&] { throw RunError(std::string("is a damaged JPEG: ") + errors.message); };
  if (!read_header(reading.jpeg, errors, bytes)) refuse();
  check_picture_size(reading.jpeg.image_width, reading.jpeg.image_height);
  if (reading.jpeg.num_components > 3) throw RunError("is a JPEG of four inks; RGB and grey are read");
  const int width = int(reading.jpeg.image_width), height = int(reading.jpeg.image_height);
  std::vector<std::uint8_t> rgb(std::size_t(width) * std::size_t(height) * 3);
  if (!read_rows(reading.jpeg, errors, rgb.data())) refuse();
  RgbaImage out{width, height, {}};
  out.rgba.reserve(rgb.size() / 3 * 4);
  for (std::size_t i = 0; i < rgb.size(); i += 3)
    out.rgba.insert(out.rgba.end(), {rgb[i], rgb[i + 1], rgb[i + 2], 255});
  return out;
}

bool begins_with(std::string_view bytes, std::string_view magic) {
  return bytes.substr(0, magic.size()) == magic;
}

}  // namespace

RgbaImage decode_picture(std::string_view bytes) {
  if (begins_with(bytes, "\x89PNG\r\n\x1a\n")) return decode_png(bytes);
  if (begins_with(bytes, "\xff\xd8\xff")) return decode_jpeg(bytes);
  throw RunError("is neither PNG nor JPEG");
}

namespace {

struct PngSource {
  std::string_view left;
  char error[256] = "";
};

void stop_png(png_structp png, png_const_charp message) {
  auto* source = static_cast<PngSource*>(png_get_error_ptr(png));
  std::strncpy(source->error, message, sizeof source->error - 1);
  std::longjmp(png_jmpbuf(png), 1);
}
void ignore_png_warning(png_structp, png_const_charp) {}
void take_png_bytes(png_structp png, png_bytep data, std::size_t size) {
  auto& left = static_cast<PngSource*>(png_get_io_ptr(png))->left;
  if (left.size() < size) png_error(png, "the file ends too early");
  std::memcpy(data, left.data(), size);
  left.remove_prefix(size);
}

// libpng leaves by longjmp, which skips destructors: these functions own nothing.
bool read_png_header(png_structp png, png_infop info) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_read_info(png, info);
  png_set_expand(png);  // palettes, fewer than 8 bits, transparency
  return true;
}

bool start_png_rows(png_structp png, png_infop info) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  return true;
}

bool read_png_rows(png_structp png, png_bytepp rows) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_read_image(png, rows);
  return true;
}

}  // namespace

PngPixels read_png_pixels(std::string_view bytes) {
  PngSource source;
  source.left = bytes;
  struct Handles {
    png_structp png = nullptr;
    png_infop info = nullptr;
    ~Handles() { png_destroy_read_struct(&png, &info, nullptr); }
  } handles;
  handles.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, stop_png, ignore_png_warning);
  if (handles.png) handles.info = png_create_info_struct(handles.png);
  if (!handles.info) throw RunError("libpng cannot start");
  png_set_read_fn(handles.png, &source, take_png_bytes);
  const auto check = [&](bool fine) {
    if (!fine) throw RunError(std::string("is a damaged PNG: ") + source.error);
  };
  check(read_png_header(handles.png, handles.info));
  PngPixels out;
  check_picture_size(png_get_image_width(handles.png, handles.info), png_get_image_height(handles.png, handles.info));
  check(start_png_rows(handles.png, handles.info));
  out.width = int(png_get_image_width(handles.png, handles.info));
  out.height = int(png_get_image_height(handles.png, handles.info));
  out.channels = png_get_channels(handles.png, handles.info);
  out.bits = png_get_bit_depth(handles.png, handles.info);
  const std::size_t row = png_get_rowbytes(handles.png, handles.info), count = std::size_t(out.height);
  std::vector<png_byte> stored(row * count);
  std::vector<png_bytep> rows;
  for (std::size_t y = 0; y < count; ++y) rows.push_back(stored.data() + y * row);
  check(read_png_rows(handles.png, rows.data()));
  out.values.resize(std::size_t(out.width) * count * std::size_t(out.channels));
  for (std::size_t i = 0; i < out.values.size(); ++i)  // 16 bits are big-endian
    out.values[i] = out.bits == 16 ? std::uint16_t(stored[2 * i] << 8 | stored[2 * i + 1]) : stored[i];
  return out;
}

}  // namespace rubble
