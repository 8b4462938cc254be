#include "io/image/png_pixels.h"

#include <png.h>

#include <csetjmp>
#include <cstring>
#include <string>

#include "io/image/picture_decoder.h"
#include "kernel/base/error.h"

namespace rubble {
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
