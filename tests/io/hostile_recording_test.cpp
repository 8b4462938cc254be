// Recordings that state sizes which they do not hold: a reader takes memory for what is there
// alone.
#include <gtest/gtest.h>

#include "io/base/atomic_file.h"
#include "io/base/little_endian.h"
#include "io/playback/recording_check.h"
#include "tests/base/peak_memory.h"
#include "tests/io/support.h"

namespace rubble {
namespace hostile_recording_test {

constexpr std::uint32_t kStated = 3'000'000'000;  // unit: byte
constexpr long kAllowed = 256 << 10;              // unit: KiB

void expect_refused_in_little_memory(const std::string& name, const std::string& bytes) {
  const test::ScratchFolder folder;
  const std::string path = folder / name;
  write_text_file(path, bytes);
  testing::forget_peak_memory();
  const long before = testing::peak_memory();
  ASSERT_GT(before, 0);
  const auto check = check_recording(path);
  EXPECT_LT(testing::peak_memory() - before, kAllowed);
  ASSERT_TRUE(check);
  ASSERT_TRUE(check->fault);
  EXPECT_NE(check->fault->what.find("is damaged"), std::string::npos) << check->fault->what;
}

void put_text(std::string& bytes, std::string_view text) {
  put(bytes, std::uint32_t(text.size()));
  bytes += text;
}

TEST(HostileRecording, McapChunkThatStatesThreeGigabytes) {
  std::string chunk;
  put(chunk, std::uint64_t(0)), put(chunk, std::uint64_t(0));  // times
  put(chunk, std::uint64_t(kStated));
  put(chunk, std::uint32_t(1));  // checksum
  put_text(chunk, "zstd");
  put(chunk, std::uint64_t(4));
  chunk += "nope";
  std::string bytes("\x89MCAP0\r\n", 8);
  bytes += '\x06';
  put(bytes, std::uint64_t(chunk.size()));
  expect_refused_in_little_memory("mission.mcap", bytes + chunk);
}

void put_field(std::string& header, std::string_view name, std::string_view value) {
  put_text(header, std::string(name) + "=" + std::string(value));
}

template <typename T>
std::string little_endian(T value) {
  std::string bytes;
  put(bytes, value);
  return bytes;
}

void put_record(std::string& bytes, const std::string& header, const std::string& data) {
  put_text(bytes, header);
  put_text(bytes, data);
}

TEST(HostileRecording, BagChunkThatStatesThreeGigabytes) {
  std::string first, chunk, bytes = "#ROSBAG V2.0\n";
  put_field(first, "op", "\x03");
  put_field(first, "index_pos", little_endian(std::uint64_t(1000)));
  put_record(bytes, first, "");
  put_field(chunk, "op", "\x05");
  put_field(chunk, "compression", "lz4");
  put_field(chunk, "size", little_endian(kStated));
  put_record(bytes, chunk, "nope");
  expect_refused_in_little_memory("mission.bag", bytes);
}

}  // namespace hostile_recording_test
}  // namespace rubble
