#include "kernel/base/system/file_sandbox.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "kernel/base/hash.h"
#include "kernel/base/read_file.h"
#include "kernel/base/system/output_files.h"

namespace rubble {
namespace file_sandbox_test {

namespace fs = std::filesystem;

// A folder `in` and beside it `out`, `in-not`, `own`, `cache` and `results`, each with a file.
class FileSandbox : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "rubble-sandbox-XXXXXX").string();
    root_ = fs::canonical(mkdtemp(name.data()));
    for (const char* folder : {"in", "in/below", "in-not", "out", "own", "cache", "results"}) {
      fs::create_directory(root_ / folder);
      std::ofstream(root_ / folder / "file") << folder;
    }
    fs::create_symlink("../out/file", root_ / "in/link");
    fs::create_symlink("../out", root_ / "in/folder");
    fs::create_symlink("below/file", root_ / "in/inner");
    fs::create_symlink(root_ / "in", root_ / "another_name");
  }
  void TearDown() override {
    leave_sandbox();
    fs::remove_all(root_);
  }
  std::string at(const std::string& name) const { return (root_ / name).string(); }
  void enter() { enter_sandbox(at("in"), {at("own")}, at("cache")); }

  fs::path root_;
};

TEST_F(FileSandbox, HoldsWhatIsReadBelowItsFolder) {
  EXPECT_EQ(read_file(at("out/file")), "out") << "there is none yet";
  EXPECT_EQ(sandbox_folder(), "");
  enter();
  EXPECT_EQ(sandbox_folder(), at("in"));
  for (const char* name : {"in/file", "in/below/file", "in/inner", "in/below/../file", "another_name/file", "own/file",
                           "cache/file", "out/../in/file", "in/./below//file"})
    EXPECT_NO_THROW(read_file(at(name))) << name;
  for (const char* name : {"out/file", "in/../out/file", "in/link", "in/folder/file", "in/below/../../out/file",
                           "in-not/file", "results/file", "out/no such file", "in/folder/../own/../out/file"}) {
    EXPECT_THROW(read_file(at(name)), RefusedFile) << name;
    EXPECT_THROW(check_readable_file(at(name)), RefusedFile) << name;
    EXPECT_THROW(sha256_of_file(at(name)), RefusedFile) << name;
  }
  leave_sandbox();
  EXPECT_EQ(read_file(at("in/link")), "out");
}

TEST_F(FileSandbox, RefusesWithThePlaceTheFolderAndWhatToDo) {
  enter();
  try {
    check_may_read(at("in/link"), {"m.lua", 3, "pile.terrain.file", "", "", "", ""});
    FAIL();
  } catch (const RefusedFile& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.rfind("m.lua:3: pile.terrain.file: the file lies outside the sandbox: expected a file below \"" + at("in") +
                             "\", found \"" + at("in/link") + "\", which is \"" + at("out/file") + "\" (copy it",
                         0),
              0u)
        << text;
    EXPECT_NE(text.find("--sandbox"), std::string::npos) << text;
  }
  EXPECT_EQ(find_refusal(at("out/file"))->file, at("out/file")) << "where nothing names it";
  EXPECT_FALSE(find_refusal(at("in/file")));
}

TEST_F(FileSandbox, TakesRelativePathsFromTheWorkingFolder) {
  const fs::path before = fs::current_path();
  fs::current_path(root_ / "in");
  enter_sandbox(".", {}, "");
  EXPECT_NO_THROW(read_file("below/file"));
  EXPECT_THROW(read_file("../out/file"), RefusedFile);
  fs::current_path(before);
  EXPECT_NO_THROW(read_file(at("in/file"))) << "it does not move with the working folder";
  EXPECT_THROW(enter_sandbox(at("in/file"), {}, ""), InputError);
  EXPECT_THROW(enter_sandbox(at("nowhere"), {}, ""), InputError);
  EXPECT_NO_THROW(enter_sandbox("/", {}, ""));
  EXPECT_NO_THROW(read_file(at("out/file")));
}

TEST_F(FileSandbox, LetsResultsBeRead) {
  allow_results(at("results"));  // before there is a sandbox: it changes nothing
  enter();
  EXPECT_THROW(read_file(at("results/file")), RefusedFile);
  allow_results(at("results") + "/");
  EXPECT_NO_THROW(read_file(at("results/file")));
  fs::create_symlink("../out/file", root_ / "results/link");
  EXPECT_THROW(read_file(at("results/link")), RefusedFile);
  EXPECT_NO_THROW(create_output_file(at("out/new"))) << "nothing said where to write";
}

TEST_F(FileSandbox, HoldsWhatARunWrites) {
  enter();
  allow_output(at("results"));
  EXPECT_NO_THROW(close(create_output_file(at("results/new"))));
  EXPECT_NO_THROW(close(create_output_file(at("cache/new"))));
  EXPECT_NO_THROW(make_folder_below(at("results"), "deeper"));
  EXPECT_NO_THROW(close(create_output_file(at("results/deeper/new"))));
  fs::create_directory_symlink(at("out"), at("results/elsewhere"));
  for (const char* name : {"out/new", "in/new", "own/new", "results/../in/new", "results/elsewhere/new"}) {
    EXPECT_THROW(create_output_file(at(name)), RefusedFile) << name;
    EXPECT_THROW(create_log_file(at(name)), RefusedFile) << name;
    EXPECT_THROW(AppendedFile{at(name)}, RefusedFile) << name;
    EXPECT_THROW(make_output_folder(at(name)), RefusedFile) << name;
    EXPECT_THROW(create_locked_folder(at(name)), RefusedFile) << name;
    EXPECT_FALSE(fs::exists(at(name))) << name;
  }
  EXPECT_THROW(make_folder_below(at("out"), "new"), RefusedFile);
  EXPECT_TRUE(fs::exists(at("out/file")));
}

}  // namespace file_sandbox_test
}  // namespace rubble
