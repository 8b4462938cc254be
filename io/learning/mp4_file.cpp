#include "io/learning/mp4_file.h"

#include <utility>

namespace rubble {
namespace {

constexpr std::uint32_t kTicks = 90000;  // a second
constexpr std::size_t kBoxHead = 8;      // unit: byte

std::string big_endian(std::uint64_t value, int bytes) {
  std::string out;
  for (int i = bytes - 1; i >= 0; --i) out += char(value >> (8 * i) & 255);
  return out;
}
std::string u16(std::uint64_t value) { return big_endian(value, 2); }
std::string u32(std::uint64_t value) { return big_endian(value, 4); }

std::string box(const char* type, const std::string& content) { return u32(kBoxHead + content.size()) + type + content; }
// With version 0 and flags.
std::string full_box(const char* type, const std::string& content, std::uint32_t flags = 0) {
  return box(type, u32(flags) + content);
}

std::string matrix() {
  std::string out;
  for (const std::uint32_t v : {0x10000u, 0u, 0u, 0u, 0x10000u, 0u, 0u, 0u, 0x40000000u}) out += u32(v);
  return out;
}

// JPEG is the object type 0x6c of MPEG-4's systems.
std::string jpeg_descriptor() {
  const auto descriptor = [](int tag, const std::string& content) { return std::string(1, char(tag)) + char(content.size()) + content; };
  const std::string config = descriptor(4, std::string("\x6c\x11", 2) + std::string(11, '\0'));
  return full_box("esds", descriptor(3, std::string(3, '\0') + config + descriptor(6, "\x02")));
}

}  // namespace

std::string Mp4Video::head() { return box("ftyp", "isom" + u32(512) + "isomiso2mp41"); }

std::string Mp4Video::part(std::string_view jpeg) { return box("mdat", std::string(jpeg)); }

void Mp4Video::note(std::size_t part_size, std::int64_t stamp_ns) {
  begins_.push_back(end_ + kBoxHead);
  sizes_.push_back(part_size - kBoxHead);
  end_ += part_size;
  times_.push_back((stamp_ns / 1000 * kTicks + 500000) / 1000000);
}

std::string Mp4Video::tail() const {
  const auto count = begins_.size();
  std::vector<std::pair<std::uint32_t, std::uint32_t>> lasting;  // pictures in a row, and ticks of each
  const std::int64_t usual = count > 1 ? times_[1] - times_[0] : std::int64_t(kTicks);
  std::int64_t duration = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto ticks = std::uint32_t(i + 1 < count ? times_[i + 1] - times_[i] : usual);
    duration += ticks;
    if (!lasting.empty() && lasting.back().second == ticks)
      ++lasting.back().first;
    else
      lasting.emplace_back(1, ticks);
  }
  std::string stts = u32(lasting.size()), stsz = u32(0) + u32(count), co64 = u32(count);
  for (const auto& [pictures, ticks] : lasting) stts += u32(pictures) + u32(ticks);
  for (std::size_t i = 0; i < count; ++i) stsz += u32(sizes_[i]), co64 += big_endian(begins_[i], 8);
  const std::string picture = std::string(6, '\0') + u16(1) + std::string(16, '\0') + u16(std::uint64_t(width_)) +
                              u16(std::uint64_t(height_)) + u32(0x480000) + u32(0x480000) + u32(0) + u16(1) +
                              std::string(32, '\0') + u16(24) + u16(0xffff) + jpeg_descriptor();
  const std::string table = full_box("stsd", u32(1) + box("mp4v", picture)) + full_box("stts", stts) +
                            full_box("stsc", u32(1) + u32(1) + u32(1) + u32(1)) + full_box("stsz", stsz) + full_box("co64", co64);
  const std::string information = full_box("vmhd", std::string(8, '\0'), 1) +
                                  box("dinf", full_box("dref", u32(1) + full_box("url ", "", 1))) + box("stbl", table);
  const std::string media = full_box("mdhd", u32(0) + u32(0) + u32(kTicks) + u32(std::uint64_t(duration)) + u16(0x55c4) + u16(0)) +
                            full_box("hdlr", u32(0) + "vide" + std::string(12, '\0') + std::string("rubble\0", 7)) +
                            box("minf", information);
  const std::string track = full_box("tkhd", u32(0) + u32(0) + u32(1) + u32(0) + u32(std::uint64_t(duration)) + std::string(16, '\0') +
                                                 matrix() + u32(std::uint64_t(width_) << 16) + u32(std::uint64_t(height_) << 16), 3) +
                            box("mdia", media);
  const std::string movie = full_box("mvhd", u32(0) + u32(0) + u32(kTicks) + u32(std::uint64_t(duration)) + u32(0x10000) + u16(0x100) +
                                                 std::string(10, '\0') + matrix() + std::string(24, '\0') + u32(2)) +
                            box("trak", track);
  return box("moov", movie);
}

}  // namespace rubble
