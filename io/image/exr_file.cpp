// The only file of the library that includes OpenEXR. Not OpenCV's: see image_file.cpp.
#include "io/image/exr_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>

#include <exception>

#include "io/image/isolated_picture.h"
#include "kernel/base/error.h"
#include "kernel/base/read_file.h"

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

}  // namespace

std::string encode_exr(int width, int height, const std::vector<std::string>& channels,
                       const std::vector<float>& values) {
  Imf::Header header(width, height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer pixels;
  const std::size_t step = channels.size() * sizeof(float);
  for (std::size_t c = 0; c < channels.size(); ++c) {
    header.channels().insert(channels[c], Imf::Channel(Imf::FLOAT));
    // The library only reads; its interface is the one for reading files, too.
    auto* base = reinterpret_cast<char*>(const_cast<float*>(values.data() + c));
    pixels.insert(channels[c],
                  Imf::Slice(Imf::FLOAT, base, step, step * static_cast<std::size_t>(width)));
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

namespace {

// One channel after another, into every channels.size()-th value.
void read_channel(Imf::InputFile& file, const std::string& name, int width, int height,
                  std::size_t first, std::size_t step, std::vector<double>& values) {
  std::vector<float> plane(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  Imf::FrameBuffer pixels;
  pixels.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(plane.data()), sizeof(float),
                                 sizeof(float) * static_cast<std::size_t>(width)));
  file.setFrameBuffer(pixels);
  file.readPixels(0, height - 1);
  for (std::size_t i = 0; i < plane.size(); ++i)
    values[first + i * step] = static_cast<double>(plane[i]);
}

ExrImage import_exr(const std::string& path, const std::vector<std::string>& channels) {
  check_readable_file(path);
  try {
    Imf::InputFile file(path.c_str(), 0);
    const auto window = file.header().dataWindow();
    if (window.min.x != 0 || window.min.y != 0) throw std::runtime_error("not ours");
    if ((std::int64_t(window.max.x) + 1) * (std::int64_t(window.max.y) + 1) > kMostPixels)
      throw std::runtime_error("it has more than 268 million pixels");
    ExrImage image{window.max.x + 1, window.max.y + 1, {}};
    image.values.resize(channels.size() * static_cast<std::size_t>(image.width) *
                        static_cast<std::size_t>(image.height));
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const Imf::Channel* channel = file.header().channels().findChannel(channels[c]);
      if (!channel) throw std::runtime_error("it has no channel " + channels[c]);
      read_channel(file, channels[c], image.width, image.height, c, channels.size(), image.values);
    }
    return image;
  } catch (const std::exception& error) {
    throw InputError(
        {path, 0, "", std::string("cannot be read as an EXR: ") + error.what(), "", "", ""});
  }
}

}  // namespace

ExrImage read_exr(const std::string& path, const std::vector<std::string>& channels) {
  return read_isolated_picture(path, &ExrImage::values, [&] { return import_exr(path, channels); });
}

}  // namespace rubble
