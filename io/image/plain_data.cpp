// BMP and the Netpbm formats: pictures without a codec.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <utility>

#include "io/image/data_picture.h"
#include "io/image/picture_decoder.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

// The next number of plain Netpbm text, in which # begins a comment; -1: there is none. digits: of a PBM 1, as its
// digits may stand without blanks.
long next_netpbm_number(std::string_view& bytes, int digits = 9) {
  while (!bytes.empty() && (bytes[0] == '#' || is_blank(bytes[0])))
    bytes.remove_prefix(bytes[0] == '#' ? std::min(bytes.find('\n'), bytes.size()) : 1);
  long value = -1;
  for (; !bytes.empty() && bytes[0] >= '0' && bytes[0] <= '9' && digits > 0; --digits) {
    value = 10 * std::max(value, 0L) + (bytes[0] - '0');
    bytes.remove_prefix(1);
  }
  return value;
}

class NetpbmFile {
 public:
  explicit NetpbmFile(std::string_view bytes) : kind_(bytes[1]), rest_(bytes.substr(2)) {}

  DataPicture read() {
    const long width = next_netpbm_number(rest_), height = next_netpbm_number(rest_);
    if (width < 1 || height < 1) refuse("no good header");
    check_data_size(std::uint64_t(width), std::uint64_t(height));
    out_.width = int(width), out_.height = int(height);
    if (kind_ == 'f' || kind_ == 'F') {
      read_floats();
      return std::move(out_);
    }
    const bool bits = kind_ == '1' || kind_ == '4', plain = kind_ <= '3';
    const long white = bits ? 1 : next_netpbm_number(rest_);
    if (white < 1 || white > 65535) refuse("no good header");
    out_.white = double(white);
    if (!plain && !rest_.empty()) rest_.remove_prefix(1);
    if (kind_ == '4') {
      read_bits();
    } else {
      read_levels(plain, bits, white);
    }
    return std::move(out_);
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    const char* name = kind_ == '1' || kind_ == '4' ? "PBM" : kind_ == '2' || kind_ == '5' ? "PGM" : kind_ == '3' || kind_ == '6' ? "PPM" : "PFM";
    throw RunError(std::string("is a damaged ") + name + ": " + why);
  }
  void need(std::size_t bytes) const {
    if (rest_.size() < bytes) refuse("the file ends too early");
  }
  std::size_t pixels() const { return std::size_t(out_.width) * std::size_t(out_.height); }
  void add(const float* channel, std::size_t channels) {
    if (channels == 1) return out_.values.push_back(channel[0]);
    out_.values.push_back(brightness_of(channel[0], channel[1], channel[2]));
    out_.colour = out_.colour || !(channel[0] == channel[1] && channel[1] == channel[2]);
  }

  // A bit of 1 is black.
  void read_bits() {
    const std::size_t row = (std::size_t(out_.width) + 7) / 8;
    need(row * std::size_t(out_.height));
    for (std::size_t y = 0; y < std::size_t(out_.height); ++y)
      for (std::size_t x = 0; x < std::size_t(out_.width); ++x)
        out_.values.push_back((static_cast<unsigned char>(rest_[y * row + x / 8]) >> (7 - x % 8) & 1) ? 0.0f : 1.0f);
  }

  void read_levels(bool plain, bool bits, long white) {
    const std::size_t channels = kind_ == '3' || kind_ == '6' ? 3 : 1, size = white > 255 ? 2 : 1;
    need((plain ? 1 : size) * channels * pixels());
    out_.values.reserve(pixels());
    const auto byte = [&](std::size_t k) { return long(static_cast<unsigned char>(rest_[k])); };
    std::array<float, 3> channel{};
    for (std::size_t i = 0; i < channels * pixels(); ++i) {
      const long value = plain ? next_netpbm_number(rest_, bits ? 1 : 9) : size == 2 ? 256 * byte(2 * i) + byte(2 * i + 1) : byte(i);
      if (value < 0 || value > white) refuse("not a whole image");
      channel[i % channels] = float(bits ? 1 - value : value);
      if (i % channels == channels - 1) add(channel.data(), channels);
    }
  }

  // Rows from the bottom. The sign of the scale tells the order of bytes; its size has no meaning for heights.
  void read_floats() {
    while (!rest_.empty() && is_blank(rest_[0])) rest_.remove_prefix(1);
    const std::string_view word = rest_.substr(0, std::min(rest_.find('\n'), std::size_t(40)));
    if (word.size() >= rest_.size() || rest_[word.size()] != '\n') refuse("no good header");
    const bool little = word.substr(0, 1) == "-";
    rest_.remove_prefix(word.size() + 1);
    const std::size_t channels = kind_ == 'F' ? 3 : 1, width = std::size_t(out_.width);
    need(4 * channels * pixels());
    out_.values.reserve(pixels());
    for (std::size_t y = std::size_t(out_.height); y-- > 0;)
      for (std::size_t x = 0; x < width; ++x) {
        std::array<float, 3> channel{};
        for (std::size_t c = 0; c < channels; ++c) channel[c] = float_at(4 * ((y * width + x) * channels + c), little);
        add(channel.data(), channels);
      }
  }
  float float_at(std::size_t at, bool little) const {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 4; ++k)
      bits |= std::uint32_t(static_cast<unsigned char>(rest_[at + k])) << (8 * (little ? k : 3 - k));
    float value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return std::isfinite(value) ? value : std::numeric_limits<float>::quiet_NaN();
  }

  char kind_;
  std::string_view rest_;
  DataPicture out_;
};

// Of 1, 4 or 8 bits with a palette, 16, 24 or 32 bits a pixel; runs of 4 or 8 bits.
class BmpFile {
 public:
  explicit BmpFile(std::string_view bytes) : bytes_(bytes) {}

  DataPicture read() {
    read_header();
    read_masks();
    read_palette();
    if (start_ > bytes_.size()) refuse("the file ends too early");
    image_.rgba.resize(4 * std::size_t(image_.width) * std::size_t(image_.height));
    compression_ == kRuns8 || compression_ == kRuns4 ? read_runs() : read_rows();
    if (masks_[3]) ignore_empty_alpha();
    return data_from_colours(image_);
  }

 private:
  static constexpr std::uint32_t kNone = 0, kRuns8 = 1, kRuns4 = 2, kMasks = 3, kMasksWithAlpha = 6;

  [[noreturn]] static void refuse(const std::string& why) { throw RunError("is a damaged BMP: " + why); }
  std::uint32_t number(std::size_t at, std::size_t size) const {
    if (at > bytes_.size() || size > bytes_.size() - at) refuse("the file ends too early");
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < size; ++k) value |= std::uint32_t(static_cast<unsigned char>(bytes_[at + k])) << (8 * k);
    return value;
  }

  void read_header() {
    start_ = number(10, 4), header_ = number(14, 4);
    const bool old = header_ == 12;
    if (!old && (header_ < 40 || header_ > 1024)) refuse("no good header");
    const auto side = [&](std::size_t at) { return std::int64_t(std::int32_t(number(at, 4))); };  // below 0: from the top
    const std::int64_t width = old ? std::int64_t(number(18, 2)) : side(18), height = old ? std::int64_t(number(20, 2)) : side(22);
    from_top_ = height < 0;
    if (width < 0) refuse("no good header");
    check_data_size(std::uint64_t(width), std::uint64_t(std::abs(height)));
    image_.width = int(width), image_.height = int(std::abs(height));
    bits_ = number(old ? 24 : 28, 2), compression_ = old ? kNone : number(30, 4);
    if (compression_ == 4 || compression_ == 5)
      throw RunError(std::string("is a BMP with a ") + (compression_ == 4 ? "JPEG" : "PNG") + " inside; save it as that");
    const bool known = compression_ == kNone ? bits_ == 1 || bits_ == 4 || bits_ == 8 || bits_ == 16 || bits_ == 24 || bits_ == 32
                       : compression_ == kRuns8 ? bits_ == 8
                       : compression_ == kRuns4 ? bits_ == 4
                                                : (compression_ == kMasks || compression_ == kMasksWithAlpha) && (bits_ == 16 || bits_ == 32);
    if (!known) throw RunError("is a BMP of compression " + std::to_string(compression_) + " and " + std::to_string(bits_) +
                               " bits, which no program reads; save it anew");
  }

  void read_masks() {
    masks_ = bits_ == 16 ? std::array<std::uint32_t, 4>{0x7c00, 0x3e0, 0x1f, 0} : std::array<std::uint32_t, 4>{0xff0000, 0xff00, 0xff, 0};
    if (compression_ != kMasks && compression_ != kMasksWithAlpha) return;
    const std::size_t count = header_ >= 56 || compression_ == kMasksWithAlpha ? 4 : 3;
    for (std::size_t i = 0; i < count; ++i) masks_[i] = number(54 + 4 * i, 4);
    if (!masks_[0] || !masks_[1] || !masks_[2]) refuse("no good masks of colours");
  }

  void read_palette() {
    if (bits_ > 8) return;
    const std::size_t entry = header_ == 12 ? 3 : 4, used = header_ == 12 ? 0 : number(46, 4);
    const std::size_t count = used > 0 && used <= 256 ? used : std::size_t(1) << bits_;
    for (std::size_t i = 0, at = 14 + header_; i < count && at + entry <= start_; ++i, at += entry) {
      const std::uint32_t bgr = number(at, 3);
      palette_[i] = {std::uint8_t(bgr >> 16), std::uint8_t(bgr >> 8), std::uint8_t(bgr), 255};
    }
  }

  void set(std::int64_t x, std::int64_t y, const std::array<std::uint8_t, 4>& colour) {
    if (x >= image_.width || y >= image_.height) refuse("not a whole image");
    const std::int64_t row = from_top_ ? y : image_.height - 1 - y;
    std::copy(colour.begin(), colour.end(), image_.rgba.begin() + 4 * (row * image_.width + x));
  }

  // The bits of a mask as 8 bits.
  static std::uint8_t masked(std::uint32_t pixel, std::uint32_t mask) {
    if (mask == 0) return 255;
    const std::uint32_t low = mask & (0 - mask);
    const std::uint64_t value = (pixel & mask) / low, most = mask / low;
    return std::uint8_t((value * 255 + most / 2) / most);
  }

  void read_rows() {
    const std::size_t row = (std::size_t(image_.width) * bits_ + 31) / 32 * 4;
    if (bytes_.size() - start_ < row * std::size_t(image_.height)) refuse("the file ends too early");
    for (std::int64_t y = 0; y < image_.height; ++y)
      for (std::int64_t x = 0; x < image_.width; ++x) {
        const std::size_t bit = std::size_t(x) * bits_, at = start_ + std::size_t(y) * row + bit / 8;
        const std::uint32_t pixel = number(at, std::max<std::size_t>(bits_ / 8, 1));
        if (bits_ <= 8)
          set(x, y, palette_[pixel >> (8 - bits_ - bit % 8) & ((1u << bits_) - 1)]);
        else
          set(x, y, {masked(pixel, masks_[0]), masked(pixel, masks_[1]), masked(pixel, masks_[2]), masked(pixel, masks_[3])});
      }
  }

  // Some programs have the mask of a transparency that they do not fill.
  void ignore_empty_alpha() {
    for (std::size_t i = 3; i < image_.rgba.size(); i += 4)
      if (image_.rgba[i] != 0) return;
    for (std::size_t i = 3; i < image_.rgba.size(); i += 4) image_.rgba[i] = 255;
  }

  // The index in a byte: of 4 bits the upper half first.
  std::uint32_t index_of(std::uint32_t byte, std::uint32_t i) const {
    return bits_ == 8 ? byte : i % 2 == 0 ? byte >> 4 : byte & 15;
  }

  // Pairs of bytes: a run, or 0 and an order. What no run fills has the first colour.
  void read_runs() {
    for (std::int64_t y = 0; y < image_.height; ++y)
      for (std::int64_t x = 0; x < image_.width; ++x) set(x, y, palette_[0]);
    std::int64_t x = 0, y = 0;
    for (std::size_t at = start_; y < image_.height;) {
      const std::uint32_t count = number(at, 1), value = number(at + 1, 1);
      at += 2;
      if (count > 0) {
        for (std::uint32_t i = 0; i < count; ++i) set(x++, y, palette_[index_of(value, i)]);
      } else if (value == 0) {  // end of the line
        x = 0, ++y;
      } else if (value == 1) {  // end of the picture
        return;
      } else if (value == 2) {  // to another place
        x += number(at, 1), y += number(at + 1, 1), at += 2;
      } else {  // so many pixels as they are, on whole words
        const std::size_t size = bits_ == 8 ? value : (value + 1) / 2;
        for (std::uint32_t i = 0; i < value; ++i) set(x++, y, palette_[index_of(number(at + (bits_ == 8 ? i : i / 2), 1), i)]);
        at += (size + 1) / 2 * 2;
      }
    }
  }

  std::string_view bytes_;
  std::size_t start_ = 0, header_ = 0;  // of the pixels; size; unit: byte
  std::uint32_t bits_ = 0, compression_ = 0;
  bool from_top_ = false;
  std::array<std::uint32_t, 4> masks_{};
  std::array<std::array<std::uint8_t, 4>, 256> palette_{};  // black, transparent where the file has none
  RgbaImage image_;
};

}  // namespace

DataPicture decode_netpbm_data(std::string_view bytes) { return NetpbmFile(bytes).read(); }
DataPicture decode_bmp_data(std::string_view bytes) { return BmpFile(bytes).read(); }

}  // namespace rubble
