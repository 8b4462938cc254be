// The only file of the library that includes OpenEXR. Not OpenCV's: see image_file.cpp.
#include "io/image/exr_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <utility>

#include "io/image/data_picture.h"
#include "io/image/isolated_picture.h"
#include "kernel/base/error.h"
#include "kernel/base/read_file.h"
#include "kernel/base/system/isolated_worker.h"

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
  const ForkHold hold;  // OpenEXR has locks
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

}  // namespace

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

namespace {

class BytesStream : public Imf::IStream {
 public:
  explicit BytesStream(std::string_view bytes) : Imf::IStream("picture"), bytes_(bytes) {}

  bool read(char data[], int size) override {
    const auto count = static_cast<std::size_t>(size);
    if (position_ > bytes_.size() || count > bytes_.size() - position_) throw std::runtime_error("the file ends too early");
    std::copy_n(bytes_.data() + position_, count, data);
    position_ += count;
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = position; }

 private:
  std::string_view bytes_;
  std::size_t position_ = 0;
};

// The channels whose values are the picture's: Y, the only one, or R, G and B.
std::vector<std::string> choose_data_channels(const Imf::ChannelList& channels) {
  if (channels.findChannel("Y")) return {"Y"};
  std::vector<std::string> names;
  std::string all;
  for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
    names.emplace_back(channel.name());
    all += (all.empty() ? "" : ", ") + names.back();
  }
  if (names.size() == 1) return names;
  if (channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B")) return {"R", "G", "B"};
  throw std::runtime_error("expected a channel Y, one channel, or R, G and B, found " + all);
}

// Interleaved values of those channels.
struct ExrData {
  int width = 0, height = 0;
  std::vector<float> values;
};

ExrData import_exr_data(std::string_view bytes) {
  try {
    BytesStream stream(bytes);
    Imf::InputFile file(stream, 0);
    const auto window = file.header().dataWindow();
    const std::int64_t width = std::int64_t(window.max.x) - window.min.x + 1, height = std::int64_t(window.max.y) - window.min.y + 1;
    if (width < 1 || height < 1 || width > std::int64_t(kMostDataPixels) || height > std::int64_t(kMostDataPixels) / width)
      throw std::runtime_error("it has more than 64 million pixels");
    ExrData data{int(width), int(height), {}};
    const auto count = std::size_t(width * height);
    const std::vector<std::string> channels = choose_data_channels(file.header().channels());
    data.values.resize(channels.size() * count);
    Imf::FrameBuffer pixels;
    const std::size_t step = channels.size() * sizeof(float);
    for (std::size_t c = 0; c < channels.size(); ++c)
      pixels.insert(channels[c], Imf::Slice::Make(Imf::FLOAT, data.values.data() + c, window, step, step * std::size_t(data.width)));
    file.setFrameBuffer(pixels);
    file.readPixels(window.min.y, window.max.y);
    return data;
  } catch (const std::exception& error) {
    throw InputError({"", 0, "", std::string("is a damaged OpenEXR picture, or one that is not read: ") + error.what(), "", "", ""});
  }
}

}  // namespace

DataPicture decode_exr_data(std::string_view bytes) {
  ExrData data;
  try {
    const auto import = [&] { return pack_picture(import_exr_data(bytes), &ExrData::values); };
    data = unpack_picture(run_isolated("the picture", "picture", import), &ExrData::values);
  } catch (const InputError& error) {
    throw RunError(error.diagnostics().front().message);
  }
  DataPicture out;
  out.width = data.width, out.height = data.height;
  if (data.values.size() == std::size_t(data.width) * std::size_t(data.height)) {
    out.values = std::move(data.values);
    return out;
  }
  for (std::size_t i = 0; i + 2 < data.values.size(); i += 3) {
    const float r = data.values[i], g = data.values[i + 1], b = data.values[i + 2];
    out.values.push_back(r == g && g == b ? r : 0.2126f * r + 0.7152f * g + 0.0722f * b);
    out.colour = out.colour || !(r == g && g == b);
  }
  return out;
}

}  // namespace rubble
