// The documents as a site: every link leads somewhere, and mkdocs makes pages of them.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "tests/app/program.h"

namespace rubble::testing {
namespace {

namespace fs = std::filesystem;
const std::string kRoot = RUBBLE_SOURCE_DIR;

int run(const std::string& command) {
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

TEST(Site, EveryLinkLeadsSomewhere) {
  const ScratchFolder scratch;
  EXPECT_EQ(run("'" + kRoot + "/tools/make_site.py' " + (scratch / "site") + " 2>" + (scratch / "err")), 0)
      << read_file(scratch / "err");
  EXPECT_TRUE(fs::exists(scratch / "site/lua.md"));
  EXPECT_TRUE(fs::exists(scratch / "site/pictures/first_pile.png"));
  EXPECT_NE(read_file(scratch / "site/index.md").find("](pictures/first_pile.png)"), std::string::npos);
  const std::string nav = read_file(kRoot + "/mkdocs.yml");
  for (const auto& page : fs::directory_iterator(scratch / "site")) {
    if (page.path().extension() != ".md") continue;
    EXPECT_NE(nav.find(": " + page.path().filename().string()), std::string::npos)
        << page.path().filename() << " has no place in the nav of mkdocs.yml";
  }
}

// The control: what leads nowhere is named.
TEST(Site, NamesLinksThatLeadNowhere) {
  const ScratchFolder scratch;
  for (const char* folder : {"tools", "assets", "docs"}) fs::create_directories(scratch / folder);
  fs::copy_file(kRoot + "/tools/make_site.py", scratch / "tools/make_site.py");
  write_file(scratch / "README.md", "# A\n[one](docs/lua.md#keys) [two](docs/none.md)\n\n    [code](nowhere.md)\n");
  write_file(scratch / "CHANGELOG.md", "# C\n");
  write_file(scratch / "assets/README.md", "# B\n[back](../README.md#a) [out](https://example.org)\n");
  write_file(scratch / "docs/lua.md", "# Lua\n\n## Keys\n\n[gone](#no-such-heading)\n");
  EXPECT_EQ(run((scratch / "tools/make_site.py") + " " + (scratch / "site") + " 2>" + (scratch / "err")), 1);
  EXPECT_EQ(read_file(scratch / "err"), "README.md: docs/none.md leads nowhere\n"
                                        "docs/lua.md: #no-such-heading: no such heading in docs/lua.md\n");
}

TEST(NightlySite, MkdocsMakesIt) {
  if (run("command -v mkdocs >/dev/null") != 0) GTEST_SKIP() << "mkdocs is not installed";
  const ScratchFolder scratch;
  ASSERT_EQ(run("'" + kRoot + "/tools/make_site.py' " + (scratch / "build/site_source")), 0);
  fs::copy_file(kRoot + "/mkdocs.yml", scratch / "mkdocs.yml");
  ASSERT_EQ(run("cd " + scratch.path().string() + " && mkdocs build --strict >log 2>&1"), 0)
      << read_file(scratch / "log");
  EXPECT_NE(read_file(scratch / "build/site/lua.html").find("collapse.lean_to"), std::string::npos);
  EXPECT_TRUE(fs::exists(scratch / "build/site/search/search_index.json"));
}

}  // namespace
}  // namespace rubble::testing
