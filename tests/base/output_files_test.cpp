// A folder may come from a stranger: what lies where our files are to be is never followed, waited for or lost.
#include "kernel/base/system/output_files.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "kernel/base/error.h"
#include "kernel/base/read_file.h"

namespace rubble {
namespace output_files_test {

namespace fs = std::filesystem;

class OutputFiles : public ::testing::Test {
 protected:
  OutputFiles() : folder_(make_private_folder(fs::temp_directory_path().string(), "output_files")) {
    std::ofstream(at("mine")) << "precious";
    fs::create_directory(at("out"));
    fs::create_directory(at("elsewhere"));
  }
  ~OutputFiles() override { fs::remove_all(folder_); }

  std::string at(const std::string& name) const { return folder_ + "/" + name; }
  static void write(const std::string& path, const std::string& text) {
    const int file = create_output_file(path);
    write_all(file, text, path);
    close(file);
  }
  std::string mine() const { return read_file(at("mine")); }

  std::string folder_;
};

TEST_F(OutputFiles, ReplaceLinksPipesAndSecondNamesAndLeaveWhatTheyLeadTo) {
  fs::create_symlink(at("mine"), at("out/link"));
  fs::create_symlink(at("nowhere"), at("out/broken"));
  fs::create_hard_link(at("mine"), at("out/hard"));
  ASSERT_EQ(mkfifo(at("out/pipe").c_str(), 0666), 0);
  for (const char* name : {"out/link", "out/broken", "out/hard", "out/pipe", "out/new"}) {
    write(at(name), "ours");
    EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(at(name)))) << name;
    EXPECT_EQ(read_file(at(name)), "ours") << name;
  }
  EXPECT_EQ(mine(), "precious");
  EXPECT_FALSE(fs::exists(at("nowhere")));
  EXPECT_THROW(create_output_file(at("elsewhere")), RunError) << "a folder";
}

TEST_F(OutputFiles, OneWriterAtATime) {
  const int first = create_output_file(at("out/a.part"));
  EXPECT_THROW(create_output_file(at("out/a.part")), RunError);
  EXPECT_TRUE(is_file_at(first, at("out/a.part"))) << "the first one's file is as it was";
  close(first);
  const int second = create_output_file(at("out/a.part"));  // what a writer left that died
  EXPECT_FALSE(is_file_at(second, at("mine")));
  close(second);
  const int folder = create_locked_folder(at("out/f.part"));
  std::ofstream(at("out/f.part/x")) << "x";
  EXPECT_THROW(create_locked_folder(at("out/f.part")), RunError);
  EXPECT_TRUE(fs::exists(at("out/f.part/x")));
  close(folder);
  close(create_locked_folder(at("out/f.part")));
  EXPECT_FALSE(fs::exists(at("out/f.part/x")));
}

TEST_F(OutputFiles, ALogIsTakenOverFromAWriterThatIsAboutToEnd) {
  const int before = create_log_file(at("out/log")), now = create_log_file(at("out/log"));
  write_all(before, "before", "log");
  write_all(now, "now", "log");
  close(before), close(now);
  EXPECT_EQ(read_file(at("out/log")), "now");
}

TEST_F(OutputFiles, ALockedFolderIsMadeInThePlaceOfALink) {
  std::ofstream(at("elsewhere/x")) << "x";
  fs::create_symlink(at("elsewhere"), at("out/f.part"));
  close(create_locked_folder(at("out/f.part")));
  EXPECT_TRUE(fs::is_directory(fs::symlink_status(at("out/f.part"))));
  EXPECT_TRUE(fs::exists(at("elsewhere/x")));
}

TEST_F(OutputFiles, AJournalIsAPlainFileOfOneName) {
  {
    AppendedFile journal(at("out/journal"));
    journal.append("one\n");
    journal.append("two\n");
    journal.cut(4);
    journal.append("three\n");
    EXPECT_EQ(journal.read_all(), "one\nthree\n");
  }
  EXPECT_EQ(AppendedFile(at("out/journal")).read_all(), "one\nthree\n");
  fs::create_symlink(at("mine"), at("out/link"));
  fs::create_hard_link(at("mine"), at("out/hard"));
  ASSERT_EQ(mkfifo(at("out/pipe").c_str(), 0666), 0);
  for (const char* name : {"out/link", "out/hard", "out/pipe", "elsewhere"})
    EXPECT_THROW(AppendedFile{at(name)}, InputError) << name;
  EXPECT_EQ(mine(), "precious");
}

TEST_F(OutputFiles, AFolderBelowAnotherIsNeverBehindALinkOrAbove) {
  EXPECT_EQ(make_folder_below(at("out"), "a/b"), at("out/a/b"));
  EXPECT_EQ(make_folder_below(at("out"), "a/b"), at("out/a/b")) << "it is there";
  EXPECT_TRUE(fs::is_directory(at("out/a/b")));
  fs::create_symlink(at("elsewhere"), at("out/link"));
  for (const char* name : {"link", "link/x", "..", "../elsewhere/x", "a/../../x", "/tmp", "a//b", "", "."})
    EXPECT_THROW(make_folder_below(at("out"), name), InputError) << name;
  std::ofstream(at("out/file")) << "x";
  EXPECT_THROW(make_folder_below(at("out"), "file"), InputError);
  EXPECT_TRUE(fs::is_empty(at("elsewhere")));
  fs::create_symlink(at("out"), at("mine_too"));  // the folder itself may be a link: the user named it
  EXPECT_NO_THROW(make_folder_below(at("mine_too"), "c"));
  EXPECT_NO_THROW(make_output_folder(at("mine_too/d/e")));
  EXPECT_THROW(make_output_folder(at("mine")), InputError);
}

TEST_F(OutputFiles, RemoveLinksAndNotWhatTheyLeadTo) {
  fs::create_symlink(at("mine"), at("out/link"));
  fs::create_symlink(at("elsewhere"), at("out/folder"));
  std::ofstream(at("elsewhere/x")) << "x";
  EXPECT_TRUE(remove_output_file(at("out/link")));
  EXPECT_FALSE(remove_output_file(at("out/link")));
  EXPECT_FALSE(remove_output_file(at("out")));
  remove_output_folder(at("out/folder"));
  EXPECT_FALSE(fs::exists(fs::symlink_status(at("out/folder"))));
  EXPECT_TRUE(fs::exists(at("elsewhere/x")));
  EXPECT_EQ(mine(), "precious");
}

TEST_F(OutputFiles, PrivateFoldersHaveNamesOfTheirOwn) {
  const std::string a = make_private_folder(at("out"), "work"), b = make_private_folder(at("out"), "work");
  EXPECT_NE(a, b);
  struct stat status {};
  ASSERT_EQ(stat(a.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 077u, 0u) << "others may not look in";
}

}  // namespace output_files_test
}  // namespace rubble
