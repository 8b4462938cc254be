// libpng by itself: OpenCV's codecs would start GDAL, with its threads' locks and its drivers.

#include "io/image/image_file.h"

#include <csetjmp>
#include <cstdio>  // jpeglib.h needs it
#include <cstdlib>
#include <cstring>
#include <jpeglib.h>
#include <png.h>
#include <string_view>

#include "io/base/atomic_file.h"
#include "io/image/isolated_picture.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

// libpng leaves by longjmp, which skips destructors: functions that it can leave own nothing.
struct Transfer {
  std::string bytes;        // written so far
  std::string_view source;  // still to be read
  std::string error;
};

void on_error(png_structp png, png_const_charp message) {
  static_cast<Transfer*>(png_get_error_ptr(png))->error = message;
  std::longjmp(png_jmpbuf(png), 1);
}
void on_warning(png_structp, png_const_charp) {}
void on_write(png_structp png, png_bytep data, std::size_t size) {
  static_cast<Transfer*>(png_get_io_ptr(png))->bytes.append(reinterpret_cast<char*>(data), size);
}
void on_flush(png_structp) {}
void on_read(png_structp png, png_bytep data, std::size_t size) {
  auto& source = static_cast<Transfer*>(png_get_io_ptr(png))->source;
  if (source.size() < size) png_error(png, "the file ends too early");
  std::memcpy(data, source.data(), size);
  source.remove_prefix(size);
}

struct Layout {
  int width, height, colour_type, bits;
  std::size_t row_bytes;
};

bool write_rows(png_structp png, png_infop info, const Layout& layout, const void* pixels,
                int level) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_compression_level(png, level);
  png_set_IHDR(png, info, static_cast<png_uint_32>(layout.width),
               static_cast<png_uint_32>(layout.height), layout.bits, layout.colour_type,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  if (layout.bits == 16) png_set_swap(png);  // PNG is big-endian
  for (int y = 0; y < layout.height; ++y) {
    png_write_row(
        png, static_cast<png_const_bytep>(pixels) + static_cast<std::size_t>(y) * layout.row_bytes);
  }
  png_write_end(png, info);
  return true;
}

std::string encode(const Layout& layout, const void* pixels, int level) {
  Transfer transfer;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &transfer, on_error, on_warning);
  if (!png) throw RunError("libpng cannot start");
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(png, &transfer, on_write, on_flush);
  const bool done = info && write_rows(png, info, layout, pixels, level);
  png_destroy_write_struct(&png, &info);
  if (!done) throw RunError("cannot encode a PNG: " + transfer.error);
  return std::move(transfer.bytes);
}

bool read_header(png_structp png, png_infop info, Layout& layout) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_read_info(png, info);
  layout = {static_cast<int>(png_get_image_width(png, info)),
            static_cast<int>(png_get_image_height(png, info)), png_get_color_type(png, info),
            png_get_bit_depth(png, info), png_get_rowbytes(png, info)};
  return true;
}

bool read_rows(png_structp png, const Layout& layout, void* pixels) {
  if (setjmp(png_jmpbuf(png))) return false;
  if (layout.bits == 16) png_set_swap(png);
  const int passes = png_set_interlace_handling(png);
  for (int pass = 0; pass < passes; ++pass) {
    for (int y = 0; y < layout.height; ++y) {
      png_read_row(png,
                   static_cast<png_bytep>(pixels) + static_cast<std::size_t>(y) * layout.row_bytes,
                   nullptr);
    }
  }
  png_read_end(png, nullptr);
  return true;
}

struct ReadHandles {
  png_structp png = nullptr;
  png_infop info = nullptr;
  ~ReadHandles() { png_destroy_read_struct(&png, &info, nullptr); }
};

class PngReader {
 public:
  explicit PngReader(const std::string& path) : path_(path), file_(read_whole_file(path)) {
    transfer_.source = file_;
    handles_.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &transfer_, on_error, on_warning);
    if (handles_.png) handles_.info = png_create_info_struct(handles_.png);
    if (!handles_.info) throw RunError("libpng cannot start");
    png_set_read_fn(handles_.png, &transfer_, on_read);
    if (!read_header(handles_.png, handles_.info, layout_))
      refuse("cannot be read as a PNG: " + transfer_.error);
  }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  const Layout& layout() const { return layout_; }

  void expect(int colour_type, int bits, const char* expected) const {
    if (layout_.colour_type == colour_type && layout_.bits == bits) return;
    refuse("has the wrong kind of pixels", expected);
  }
  void read(void* pixels) {
    if (!read_rows(handles_.png, layout_, pixels)) refuse("is a damaged PNG: " + transfer_.error);
  }

 private:
  [[noreturn]] void refuse(const std::string& message, const char* expected = "") const {
    Diagnostic diagnostic;
    diagnostic.file = path_;
    diagnostic.message = message;
    diagnostic.expected = expected;
    throw InputError(diagnostic);
  }

  std::string path_, file_;
  Transfer transfer_;
  Layout layout_{};
  ReadHandles handles_;  // of their own, so that a constructor that throws frees them
};

}  // namespace

RgbImage import_rgb_png(const std::string& path) {
  PngReader reader(path);
  reader.expect(PNG_COLOR_TYPE_RGB, 8, "a PNG of 8-bit red, green and blue");
  RgbImage image{reader.layout().width, reader.layout().height, {}};
  image.rgb.resize(reader.layout().row_bytes * static_cast<std::size_t>(image.height));
  reader.read(image.rgb.data());
  return image;
}

DepthImage import_depth_png(const std::string& path) {
  PngReader reader(path);
  reader.expect(PNG_COLOR_TYPE_GRAY, 16, "a PNG of one 16-bit channel");
  DepthImage image{reader.layout().width, reader.layout().height, {}};
  image.values.resize(static_cast<std::size_t>(image.width) *
                      static_cast<std::size_t>(image.height));
  reader.read(image.values.data());
  return image;
}

GrayImage to_gray(const RgbImage& colour) {
  GrayImage image{colour.width, colour.height, std::vector<std::uint8_t>(colour.rgb.size() / 3)};
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    const unsigned sum = 299u * colour.rgb[3 * i] + 587u * colour.rgb[3 * i + 1] + 114u * colour.rgb[3 * i + 2];
    image.values[i] = static_cast<std::uint8_t>((sum + 500) / 1000);
  }
  return image;
}

std::string encode_png(const RgbImage& image, int level) {
  const auto row = 3 * static_cast<std::size_t>(image.width);
  return encode({image.width, image.height, PNG_COLOR_TYPE_RGB, 8, row}, image.rgb.data(), level);
}

std::string encode_png(const GrayImage& image, int level) {
  const auto row = static_cast<std::size_t>(image.width);
  return encode({image.width, image.height, PNG_COLOR_TYPE_GRAY, 8, row}, image.values.data(),
                level);
}

std::string encode_png(const DepthImage& image, int level) {
  const auto row = 2 * static_cast<std::size_t>(image.width);
  return encode({image.width, image.height, PNG_COLOR_TYPE_GRAY, 16, row}, image.values.data(),
                level);
}

void write_png(const std::string& path, const RgbImage& image, int level) {
  write_text_file(path, encode_png(image, level));
}

void write_png(const std::string& path, const DepthImage& image, int level) {
  write_text_file(path, encode_png(image, level));
}

namespace {

// libjpeg leaves by longjmp, which skips destructors: the function that it can leave owns nothing.
struct Encoder {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  std::jmp_buf on_error;
  char message[JMSG_LENGTH_MAX] = "";
  unsigned char* bytes = nullptr;
  unsigned long size = 0;

  ~Encoder() {
    jpeg_destroy_compress(&jpeg);
    std::free(bytes);
  }
};

void fail(j_common_ptr jpeg) {
  auto* encoder = static_cast<Encoder*>(jpeg->client_data);
  jpeg->err->format_message(jpeg, encoder->message);
  std::longjmp(encoder->on_error, 1);
}

bool compress(Encoder& encoder, int width, int height, const std::uint8_t* rgb, int quality) {
  jpeg_compress_struct& jpeg = encoder.jpeg;
  jpeg.err = jpeg_std_error(&encoder.errors);
  encoder.errors.error_exit = fail;
  jpeg.client_data = &encoder;
  if (setjmp(encoder.on_error)) return false;
  jpeg_create_compress(&jpeg);
  jpeg_mem_dest(&jpeg, &encoder.bytes, &encoder.size);
  jpeg.image_width = static_cast<JDIMENSION>(width);
  jpeg.image_height = static_cast<JDIMENSION>(height);
  jpeg.input_components = 3;
  jpeg.in_color_space = JCS_RGB;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, quality, TRUE);
  jpeg_start_compress(&jpeg, TRUE);
  while (jpeg.next_scanline < jpeg.image_height) {
    // libjpeg only reads the row; its interface is older than const.
    auto* row = const_cast<JSAMPLE*>(rgb + std::size_t{3} * jpeg.image_width * jpeg.next_scanline);
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  return true;
}

}  // namespace

std::string encode_jpeg(int width, int height, const std::uint8_t* rgb, int quality) {
  Encoder encoder;
  if (!compress(encoder, width, height, rgb, quality))
    throw RunError(std::string("cannot encode a JPEG: ") + encoder.message);
  return {reinterpret_cast<const char*>(encoder.bytes), encoder.size};
}

}  // namespace rubble
