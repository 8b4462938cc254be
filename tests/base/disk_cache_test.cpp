#include "kernel/base/system/disk_cache.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/base/environment.h"

namespace rubble {
namespace disk_cache_test {

namespace fs = std::filesystem;
using testing::Environment;

class DiskCacheTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("rubble_cache_" + std::to_string(getpid()) + "_" +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::vector<fs::path> files() const {
    std::vector<fs::path> out;
    for (const auto& entry : fs::recursive_directory_iterator(folder_))
      if (entry.is_regular_file()) out.push_back(entry.path());
    return out;
  }

  fs::path folder_;
};

std::string key_of(int number) { return CacheKey("test", 1).add(number).hex(); }

TEST_F(DiskCacheTest, GivesBackWhatWasStored) {
  const std::string bytes("a\0b\xff", 4);
  const DiskCache cache(folder_.string());
  EXPECT_FALSE(cache.find("thing", key_of(1)));
  EXPECT_TRUE(cache.store("thing", key_of(1), bytes));
  EXPECT_EQ(DiskCache(folder_.string()).find("thing", key_of(1)), bytes);
  EXPECT_FALSE(cache.find("thing", key_of(2)));
  EXPECT_FALSE(cache.find("other", key_of(1)));
  EXPECT_TRUE(cache.store("thing", key_of(2), ""));
  EXPECT_EQ(cache.find("thing", key_of(2)), "");
}

// Small values, arrays and parts of arrays, some larger than what is collected before it is written.
TEST_F(DiskCacheTest, AnEntryThatIsWrittenInPartsIsThatOfItsBytes) {
  const auto write = [](CacheWriter& to) {
    for (int i = 0; i < 30000; ++i) to.put(i);
    const std::vector<double> values(20000, 0.25);
    to.put(values), to.put('x'), to.put_values(values.data(), 3), to.put(std::vector<int>{});
  };
  CacheWriter whole;
  write(whole);
  const DiskCache cache(folder_.string());
  ASSERT_TRUE(cache.store("thing", key_of(1), write));
  EXPECT_EQ(cache.find("thing", key_of(1)), whole.bytes());
  EXPECT_FALSE(DiskCache(folder_.string(), 100000).store("thing", key_of(2), write));  // larger than the bound
  EXPECT_EQ(files().size(), 1u);
  EXPECT_FALSE(DiskCache().store("thing", key_of(1), write));
}

TEST_F(DiskCacheTest, ADamagedEntryIsAbsentWhateverByteIsWrong) {
  const DiskCache cache(folder_.string());
  ASSERT_TRUE(cache.store("thing", key_of(1), "some bytes"));
  const fs::path path = files().at(0);
  const auto size = std::streamoff(fs::file_size(path));
  for (std::streamoff at = 0; at < size; ++at) {
    ASSERT_TRUE(cache.store("thing", key_of(1), "some bytes"));
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(at);
    const char old = char(file.get());
    file.seekp(at);
    file.put(char(old ^ 0x10));
    file.close();
    EXPECT_FALSE(cache.find("thing", key_of(1))) << "byte " << at;
    EXPECT_FALSE(fs::exists(path));
  }
}

TEST_F(DiskCacheTest, AShortOrRenamedEntryIsAbsent) {
  const DiskCache cache(folder_.string());
  for (const std::uintmax_t left : {0, 7, 31, 40}) {
    ASSERT_TRUE(cache.store("thing", key_of(1), "some bytes"));
    fs::resize_file(files().at(0), left);
    EXPECT_FALSE(cache.find("thing", key_of(1))) << left;
  }
  ASSERT_TRUE(cache.store("thing", key_of(1), "some bytes"));
  fs::rename(files().at(0), folder_ / "thing" / (key_of(2) + ".cache"));
  EXPECT_FALSE(cache.find("thing", key_of(2)));
}

TEST_F(DiskCacheTest, StaysWithinItsBoundAndKeepsWhatWasUsedLast) {
  const DiskCache cache(folder_.string(), 10000);
  const std::string bytes(2000, 'x');
  const auto age = [&](int number, int hours) {
    fs::last_write_time(folder_ / "thing" / (key_of(number) + ".cache"),
                        fs::file_time_type::clock::now() - std::chrono::hours(hours));
  };
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(cache.store("thing", key_of(i), bytes));
  for (int i = 0; i < 4; ++i) age(i, 10 - i);
  EXPECT_TRUE(cache.find("thing", key_of(0)));  // the oldest, but now used
  ASSERT_TRUE(cache.store("thing", key_of(4), bytes));
  std::uintmax_t total = 0;
  for (const fs::path& path : files()) total += fs::file_size(path);
  EXPECT_LE(total, 10000u);
  EXPECT_TRUE(cache.find("thing", key_of(0)));
  EXPECT_FALSE(cache.find("thing", key_of(1)));
  EXPECT_TRUE(cache.find("thing", key_of(4)));
  EXPECT_FALSE(cache.store("thing", key_of(9), std::string(20000, 'x')));  // larger than the bound
}

// The folder may be one that is used for other things, too.
TEST_F(DiskCacheTest, LeavesTheFilesOfOthersAlone) {
  const std::string hex(64, 'a');
  const std::vector<std::string> others{"mine.part", "downloads/data.tar.part", "downloads/model.cache", "thing/notes.cache",
                                        "thing/" + hex + ".cache", "thing/" + hex + ".part", "thing/deep/" + hex + ".cache",
                                        "thing/" + hex + ".cache.1.x.part"};
  for (const std::string& name : others) {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << std::string(5000, 'o');
    fs::last_write_time(folder_ / name, fs::file_time_type::clock::now() - std::chrono::hours(1000));
  }
  fs::create_directories(folder_ / "elsewhere");
  fs::create_directory_symlink(folder_ / "elsewhere", folder_ / "linked");
  const std::string left = "thing/" + key_of(7) + ".cache.123.4.part";  // of a process that was killed
  std::ofstream(folder_ / left) << "";
  fs::last_write_time(folder_ / left, fs::file_time_type::clock::now() - std::chrono::hours(1000));
  const DiskCache cache(folder_.string(), 10000);
  for (int i = 0; i < 6; ++i) ASSERT_TRUE(cache.store("thing", key_of(i), std::string(2000, 'x')));
  for (const std::string& name : others) EXPECT_EQ(fs::file_size(folder_ / name), 5000u) << name;
  EXPECT_TRUE(cache.find("thing", key_of(5)));
  EXPECT_FALSE(fs::exists(folder_ / left));
  EXPECT_FALSE(cache.store("linked", key_of(1), "x")) << "a link is no folder of ours";
  EXPECT_TRUE(fs::is_empty(folder_ / "elsewhere"));
}

TEST_F(DiskCacheTest, DoesWithoutAFolderThatCannotBeWritten) {
  EXPECT_FALSE(DiskCache().store("thing", key_of(1), "x"));
  EXPECT_FALSE(DiskCache().find("thing", key_of(1)));
  std::ofstream(folder_.string()) << "a file in the way";
  const DiskCache cache(folder_.string());
  EXPECT_FALSE(cache.store("thing", key_of(1), "x"));
  EXPECT_FALSE(cache.find("thing", key_of(1)));
}

TEST_F(DiskCacheTest, WritersAtTheSameTimeLeaveAWholeEntry) {
  const std::string bytes(200000, 'y');
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&] {
      const DiskCache cache(folder_.string());
      for (int i = 0; i < 10; ++i) EXPECT_TRUE(cache.store("thing", key_of(1), bytes));
    });
  for (int i = 0; i < 50; ++i) {
    const auto found = DiskCache(folder_.string()).find("thing", key_of(1));
    if (found) {
      EXPECT_EQ(*found, bytes);
    }
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(DiskCache(folder_.string()).find("thing", key_of(1)), bytes);
  EXPECT_EQ(files().size(), 1u);
}

TEST(CacheKey, DependsOnMakerVersionAndEveryPart) {
  const std::string base = CacheKey("a", 1).add(2.0).add_text("bc").hex();
  EXPECT_EQ(base, CacheKey("a", 1).add(2.0).add_text("bc").hex());
  EXPECT_NE(base, CacheKey("b", 1).add(2.0).add_text("bc").hex());
  EXPECT_NE(base, CacheKey("a", 2).add(2.0).add_text("bc").hex());
  EXPECT_NE(base, CacheKey("a", 1).add(2.5).add_text("bc").hex());
  EXPECT_NE(CacheKey("a", 1).add_text("b").add_text("c").hex(), CacheKey("a", 1).add_text("bc").add_text("").hex());
}

TEST(CacheReader, SaysWhenBytesAreMissingOrLeftOver) {
  CacheWriter writer;
  writer.put(7);
  writer.put(std::vector<float>{1, 2, 3});
  int number = 0;
  std::vector<float> values;
  CacheReader good(writer.bytes());
  good.get(number), good.get(values);
  EXPECT_TRUE(good.whole());
  EXPECT_EQ(number, 7);
  EXPECT_EQ(values, (std::vector<float>{1, 2, 3}));
  CacheReader left_over(writer.bytes());
  left_over.get(number);
  EXPECT_FALSE(left_over.whole());
  for (std::size_t size = 0; size < writer.bytes().size(); ++size) {
    CacheReader cut(std::string_view(writer.bytes()).substr(0, size));
    cut.get(number), cut.get(values);
    EXPECT_FALSE(cut.whole()) << size;
  }
}

TEST(UsualFolder, FollowsTheEnvironmentInOrder) {
  const Environment home("HOME", "/home/me");
  const Environment none("RUBBLE_CACHE", std::nullopt), unset("XDG_CACHE_HOME", std::nullopt);
  EXPECT_EQ(DiskCache::usual_folder(), "/home/me/.cache/rubble");
  const Environment relative("XDG_CACHE_HOME", "here");
  EXPECT_EQ(DiskCache::usual_folder(), "/home/me/.cache/rubble");
  const Environment shared("XDG_CACHE_HOME", "/var/cache/me");
  EXPECT_EQ(DiskCache::usual_folder(), "/var/cache/me/rubble");
  const Environment own("RUBBLE_CACHE", "/fast/disk");
  EXPECT_EQ(DiskCache::usual_folder(), "/fast/disk");
  const Environment off("RUBBLE_CACHE", "off");
  EXPECT_EQ(DiskCache::usual_folder(), "");
}

}  // namespace disk_cache_test
}  // namespace rubble
