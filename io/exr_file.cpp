// The only file of the library that includes OpenEXR. Not OpenCV's: see image_file.cpp.
#include "io/exr_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>

#include <exception>

#include "kernel/base/error.h"

namespace rubble {
namespace {

class StringStream : public Imf::OStream {
 public:
  explicit StringStream(std::string& bytes) : Imf::OStream("memory"), bytes_(bytes) {}

  void write(const char data[], int size) override {
    const auto count = static_cast<std::size_t>(size);
    if (position_ + count > bytes_.size()) bytes_.resize(position_ + count);
    bytes_.replace(position_, count, data, count);
    position_ += count;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }

 private:
  std::string& bytes_;
  std::size_t position_ = 0;
};

template <typename T>
std::string encode(int width, int height, const std::vector<std::string>& channels,
                   Imf::PixelType type, const std::vector<T>& values) {
  Imf::Header header(width, height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer pixels;
  const std::size_t step = channels.size() * sizeof(T);
  for (std::size_t c = 0; c < channels.size(); ++c) {
    header.channels().insert(channels[c], Imf::Channel(type));
    // The library only reads; its interface is the one for reading files, too.
    auto* base = reinterpret_cast<char*>(const_cast<T*>(values.data() + c));
    pixels.insert(channels[c],
                  Imf::Slice(type, base, step, step * static_cast<std::size_t>(width)));
  }
  std::string bytes;
  StringStream stream(bytes);
  try {
    Imf::OutputFile file(stream, header, 0);  // no threads of its own
    file.setFrameBuffer(pixels);
    file.writePixels(height);
  } catch (const std::exception& error) {
    throw RunError(std::string("cannot encode an EXR: ") + error.what());
  }
  return bytes;
}

}  // namespace

std::string encode_exr(int width, int height, const std::vector<std::string>& channels,
                       const std::vector<float>& values) {
  return encode(width, height, channels, Imf::FLOAT, values);
}

std::string encode_exr(int width, int height, const std::vector<std::string>& channels,
                       const std::vector<std::uint32_t>& values) {
  return encode(width, height, channels, Imf::UINT, values);
}

}  // namespace rubble
