#include "io/base/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "kernel/base/error.h"
#include "tests/io/support.h"

namespace rubble {
namespace atomic_file_test {

using test::read_text;
using test::ScratchFolder;

std::string message_of(const InputError& error) { return error.diagnostics().front().text(); }

TEST(AtomicFile, HasItsNameOnlyAfterCommit) {
  ScratchFolder folder;
  AtomicFile file(folder / "a.bin");
  file.write("hello");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.bin.part"});
  file.commit();
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.bin"});
  EXPECT_EQ(read_text(folder / "a.bin"), "hello");
}

TEST(AtomicFile, WithoutCommitNothingIsLeftAndTheOldFileStays) {
  ScratchFolder folder;
  write_text_file(folder / "a.bin", "old");
  {
    AtomicFile file(folder / "a.bin");
    file.write("new");
  }
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.bin"});
  EXPECT_EQ(read_text(folder / "a.bin"), "old");
}

TEST(AtomicFile, OverwritesWhatWasWrittenAndCountsBytes) {
  ScratchFolder folder;
  AtomicFile file(folder / "a.bin");
  const std::string large(1 << 20, 'x');
  file.write("0123456789");
  file.write(large);
  file.overwrite(3, "abc");
  file.write("end");
  EXPECT_EQ(file.size(), 10 + large.size() + 3);
  file.commit();
  EXPECT_EQ(read_text(folder / "a.bin"), "012abc6789" + large + "end");
}

TEST(AtomicFile, SaysWhichFileAndWhy) {
  ScratchFolder folder;
  try {
    AtomicFile file(folder / "missing/a.bin");
    FAIL() << "a folder that does not exist was accepted";
  } catch (const RunError& error) {
    EXPECT_NE(std::string(error.what()).find("missing/a.bin"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("No such file"), std::string::npos) << error.what();
  }
}

// What a stranger's folder has under the names of a file and of its temporary one.
TEST(AtomicFile, ReplacesLinksAndPipesAndLeavesWhatTheyLeadTo) {
  ScratchFolder folder;
  write_text_file(folder / "mine", "precious");
  std::filesystem::create_symlink(folder / "mine", folder / "a.part");
  std::filesystem::create_symlink(folder / "mine", folder / "a");
  ASSERT_EQ(mkfifo((folder / "b.part").c_str(), 0666), 0);
  ASSERT_EQ(mkfifo((folder / "b").c_str(), 0666), 0);
  for (const char* name : {"a", "b"}) {
    write_text_file(folder / name, "ours");
    EXPECT_TRUE(std::filesystem::is_regular_file(std::filesystem::symlink_status(folder / name))) << name;
    EXPECT_EQ(read_text(folder / name), "ours");
  }
  EXPECT_EQ(read_text(folder / "mine"), "precious");
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"a", "b", "mine"}));
}

TEST(AtomicFile, ASecondWriterIsRefusedAndTheFirstOneFinishes) {
  ScratchFolder folder;
  AtomicFile first(folder / "a");
  first.write("first");
  EXPECT_THROW(AtomicFile(folder / "a"), RunError);
  first.commit();
  EXPECT_EQ(read_text(folder / "a"), "first");
  write_text_file(folder / "a", "second");
  EXPECT_EQ(read_text(folder / "a"), "second");
}

TEST(AtomicFile, DoesNotFinishWithSomebodyElsesFile) {
  ScratchFolder folder;
  AtomicFile file(folder / "a");
  file.write("ours");
  std::filesystem::remove(folder / "a.part");
  std::ofstream(folder / "a.part") << "another's";
  EXPECT_THROW(file.commit(), RunError);
  EXPECT_FALSE(test::exists(folder / "a"));
}

TEST(OutputFolder, IsCreatedWithItsParents) {
  ScratchFolder folder;
  prepare_output_folder(folder / "a/b", false, {});
  EXPECT_TRUE(std::filesystem::is_directory(folder / "a/b"));
}

TEST(OutputFolder, RefusesANonEmptyOneWithoutForce) {
  ScratchFolder folder;
  write_text_file(folder / "notes.txt", "mine");
  try {
    prepare_output_folder(folder.path(), false, {"pile.stl"});
    FAIL() << "a folder that is not empty was accepted";
  } catch (const InputError& error) {
    EXPECT_NE(message_of(error).find("not empty"), std::string::npos) << message_of(error);
    EXPECT_NE(message_of(error).find("--force"), std::string::npos) << message_of(error);
  }
}

TEST(OutputFolder, ForceRemovesOurFilesAndNoOthers) {
  ScratchFolder folder;
  for (const char* name : {"pile.stl", "mission.bag.part", "notes.txt"}) {
    write_text_file(folder / name, "x");
  }
  std::filesystem::create_directory(folder / "mission.rawlog");  // a user's folder of that name
  prepare_output_folder(folder.path(), true, {"pile.stl", "mission.bag", "mission.rawlog"});
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"mission.rawlog", "notes.txt"}));
}

TEST(OutputFolder, RefusesAFile) {
  ScratchFolder folder;
  write_text_file(folder / "taken", "x");
  EXPECT_THROW(prepare_output_folder(folder / "taken", true, {}), InputError);
  EXPECT_EQ(read_text(folder / "taken"), "x");
}

TEST(ReadWholeFile, NamesAMissingFile) {
  try {
    read_whole_file("/nonexistent/file");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(message_of(error).find("/nonexistent/file"), std::string::npos);
  }
}

}  // namespace atomic_file_test
}  // namespace rubble
