// The Debian package: free of complaints, and enough for a bare machine. Takes minutes.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "tests/app/program.h"

namespace rubble::testing {
namespace {

namespace fs = std::filesystem;

bool has_program(const std::string& name) {
  return std::system(("command -v " + name + " >/dev/null 2>&1").c_str()) == 0;
}

TEST(NightlyPackage, IsCleanAndMakesADatasetOnABareMachine) {
  const ScratchFolder scratch;
  const std::string build = fs::path(RUBBLE_PROGRAM).parent_path().string();
  const std::string log = scratch / "log";
  ASSERT_EQ(std::system(("cpack --config '" + build + "/CPackConfig.cmake' -B '" + scratch / "made" +
                         "' >'" + log + "' 2>&1").c_str()), 0) << read_file(log);
  std::string package;
  for (const auto& file : fs::directory_iterator(scratch / "made"))
    if (file.path().extension() == ".deb") package = file.path().string();
  ASSERT_FALSE(package.empty()) << read_file(log);
  if (!has_program("lintian")) GTEST_SKIP() << "lintian is not installed";
  std::system(("lintian --allow-root --fail-on error,warning '" + package + "' >'" + log + "' 2>&1; "
               "echo exit $? >>'" + log + "'").c_str());
  EXPECT_EQ(read_file(log), "exit 0\n");
  if (geteuid() != 0 || !has_program("debootstrap")) GTEST_SKIP() << "needs root and debootstrap";
  const int status = std::system(("'" RUBBLE_SOURCE_DIR "/tools/package/test_package.sh' '" + package + "' '" +
                                  scratch / "bare" + "' small.lua >'" + log + "' 2>&1").c_str());
  EXPECT_EQ(status, 0) << read_file(log);
  EXPECT_NE(read_file(log).find("the dataset took"), std::string::npos) << read_file(log);
}

}  // namespace
}  // namespace rubble::testing
