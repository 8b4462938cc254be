#include "io/base/remove_files.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "io/base/folder_writer.h"
#include "kernel/base/error.h"
#include "tests/io/support.h"

namespace rubble {
namespace remove_files_test {

namespace fs = std::filesystem;
using test::ScratchFolder;

class RemoveFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"in/a", "in/sub/b", "in/sub/deep/c", "out/x", "in/kept"}) write(name);
  }
  void write(const std::string& name) {
    fs::create_directories(fs::path(at(name)).parent_path());
    std::ofstream(at(name)) << name;
  }
  std::string at(const std::string& name) const { return folder_ / name; }
  bool there(const std::string& name) const { return fs::exists(fs::symlink_status(at(name))); }

  ScratchFolder folder_;
};

TEST_F(RemoveFiles, RemovesPlainFilesAndThenEmptyFolders) {
  const std::vector<std::string> names{"a", "sub/b", "sub/deep/c", "none", "none/at/all"};
  remove_plain_files(at("in"), names);
  EXPECT_FALSE(there("in/a"));
  EXPECT_FALSE(there("in/sub/b"));
  EXPECT_FALSE(there("in/sub/deep/c"));
  EXPECT_TRUE(there("in/kept"));
  remove_empty_parents(at("in"), names);
  EXPECT_FALSE(there("in/sub"));
  EXPECT_TRUE(there("in"));
}

TEST_F(RemoveFiles, NeverOutside) {
  const std::string absolute = at("out/x");
  remove_plain_files(at("in"), {"../out/x", "sub/../../out/x", absolute, "./../out/x", "sub//b",
                                "sub/./b", "", ".", "..", "a/", std::string("a\0b", 3)});
  EXPECT_TRUE(there("out/x"));
  EXPECT_TRUE(there("in/a"));
  EXPECT_TRUE(there("in/sub/b")) << "names as nobody writes them are not ours";
}

TEST_F(RemoveFiles, NeverThroughALink) {
  fs::create_directory_symlink(at("out"), at("in/link"));
  fs::create_symlink(at("out/x"), at("in/file_link"));
  fs::create_directory_symlink(at("in/sub"), at("in/inner"));
  remove_plain_files(at("in"), {"link/x", "file_link", "inner/b", "link"});
  EXPECT_TRUE(there("out/x"));
  EXPECT_TRUE(there("in/file_link")) << "a link is no plain file";
  EXPECT_TRUE(there("in/sub/b")) << "not even one inside the folder";
  fs::remove(at("out/x"));
  remove_empty_parents(at("in"), {"link/x"});
  EXPECT_TRUE(there("out"));
  EXPECT_TRUE(there("in/link"));
  EXPECT_TRUE(list_plain_files(at("in"), "link").empty());
  EXPECT_EQ(list_plain_files(at("in"), "sub"), (std::vector<std::string>{"sub/b", "sub/deep/c"}));
}

TEST_F(RemoveFiles, NeverWhatIsNoFile) {
  ASSERT_EQ(mkfifo(at("in/pipe").c_str(), 0600), 0);
  remove_plain_files(at("in"), {"pipe", "sub"});
  EXPECT_TRUE(there("in/pipe"));
  EXPECT_TRUE(there("in/sub/b"));
}

// A folder of recordings that cannot be made whole leaves nothing behind.
TEST_F(RemoveFiles, OfAFolderThatCannotBeMade) {
  const std::string too_long(300, 'x');
  EXPECT_THROW(FolderWriter(at("tum"), {"rgb", too_long}, 1), RunError);
  EXPECT_FALSE(there("tum.part"));
  EXPECT_FALSE(there("tum"));
}

// One without a file is not there: nobody would remove it.
TEST_F(RemoveFiles, FoldersOfARecordingHaveFiles) {
  FolderWriter files(at("tum"), {"rgb", "depth", "deep/er", "deep/full"}, 1);
  files.write("rgb/0.png", "a");
  files.write("deep/full/1.png", "b");
  files.finish();
  EXPECT_TRUE(there("tum/rgb/0.png"));
  EXPECT_TRUE(there("tum/deep/full/1.png"));
  EXPECT_FALSE(there("tum/depth"));
  EXPECT_FALSE(there("tum/deep/er"));
}

}  // namespace remove_files_test
}  // namespace rubble
