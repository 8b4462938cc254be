#include "kernel/base/read_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "kernel/base/error.h"

namespace rubble {
namespace read_file_test {

class ReadFile : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "rubble-read-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  static std::string error_of(const std::string& path, std::uint64_t limit = ~std::uint64_t{0}) {
    try {
      read_file(path, limit);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  std::filesystem::path folder_;
};

TEST_F(ReadFile, GivesTheBytes) {
  const std::string bytes(700000, 'x');
  std::ofstream(path("a")) << bytes;
  EXPECT_EQ(read_file(path("a")), bytes);
  std::ofstream(path("empty")).flush();
  EXPECT_EQ(read_file(path("empty")), "");
  EXPECT_EQ(error_of(path("a"), 1 << 18), path("a") + ": is too large: expected at most 0 MiB");
  EXPECT_NE(error_of(path("none")).find("cannot be opened"), std::string::npos);
  EXPECT_EQ(error_of(folder_.string()), folder_.string() + ": is a folder");
}

// Each of these was read for ever.
TEST_F(ReadFile, EndsWhereThereIsNoEnd) {
  EXPECT_NE(error_of("/dev/zero").find("is a device"), std::string::npos);
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_NE(error_of(path("pipe")).find("a pipe that nobody writes to"), std::string::npos);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
}

TEST_F(ReadFile, WaitsForAWriterThatIsThere) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  std::thread writer([this] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    std::ofstream out(path("pipe"));
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    out << "late ";
    out.flush();
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    out << "but whole";
  });
  EXPECT_EQ(read_file(path("pipe")), "late but whole");
  writer.join();
}

}  // namespace read_file_test
}  // namespace rubble
