#include "io/image/jpeg_file.h"

#include <cstdio>  // jpeglib.h needs it

#include <jpeglib.h>

#include <csetjmp>
#include <cstdlib>

#include "kernel/base/error.h"

namespace rubble {
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
