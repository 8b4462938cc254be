// The documents as a site: every link leads somewhere, and mkdocs makes pages of them.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>

#include "tests/app/program.h"

namespace rubble::testing {
namespace site_test {

namespace fs = std::filesystem;
const std::string kRoot = RUBBLE_SOURCE_DIR;

int run(const std::string& command) {
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

// The picture of the README, by its name in docs/pictures.
std::string picture_of_readme() {
  const std::string readme = read_file(kRoot + "/README.md"), begin = "](docs/pictures/";
  const std::size_t at = readme.find(begin);
  EXPECT_NE(at, std::string::npos) << "README.md has no picture";
  return at == std::string::npos ? "" : readme.substr(at + begin.size(), readme.find(')', at) - at - begin.size());
}

TEST(Site, EveryLinkLeadsSomewhere) {
  const ScratchFolder scratch;
  EXPECT_EQ(run("'" + kRoot + "/tools/make_site.py' " + (scratch / "site") + " 2>" + (scratch / "err")), 0)
      << read_file(scratch / "err");
  EXPECT_TRUE(fs::exists(scratch / "site/reference/missions.md"));
  const std::string picture = picture_of_readme();
  EXPECT_TRUE(fs::exists(scratch / ("site/pictures/" + picture)));
  EXPECT_NE(read_file(scratch / "site/index.md").find("](pictures/" + picture + ")"), std::string::npos);
  // mkdocs takes a list right below a sentence for its next words.
  EXPECT_NE(read_file(scratch / "site/reference/formats.md").find("all formats:\n\n- **Stamps.**"), std::string::npos);
  // Readers see what a table was measured from.
  EXPECT_NE(read_file(scratch / "site/explanation/sfm.md").find("*Measured at commit "), std::string::npos);
  const std::string nav = read_file(kRoot + "/mkdocs.yml");
  for (const auto& page : fs::recursive_directory_iterator(scratch / "site")) {
    if (page.path().extension() != ".md") continue;
    const std::string name = fs::relative(page.path(), scratch / "site").string();
    EXPECT_NE(nav.find(": " + name), std::string::npos)
        << name << " has no place in the nav of mkdocs.yml";
  }
}

// The control: what leads nowhere is named.
TEST(Site, NamesLinksThatLeadNowhere) {
  const ScratchFolder scratch;
  for (const char* folder : {"tools", "assets", "docs/reference"}) fs::create_directories(scratch / folder);
  for (const char* file : {"tools/make_site.py", "tools/stale_tables.py", "tools/site.css"}) fs::copy_file(kRoot + "/" + file, scratch / file);
  write_file(scratch / "README.md", "# A\n[one](docs/reference/lua.md#keys) [two](docs/none.md)\n\n    [code](nowhere.md)\n");
  write_file(scratch / "CHANGELOG.md", "# C\n");
  write_file(scratch / "assets/README.md", "# B\n[back](../README.md#a) [out](https://example.org)\n");
  write_file(scratch / "docs/reference/lua.md", "# Lua\n\n## Keys\n\n[gone](#no-such-heading)\n");
  EXPECT_EQ(run((scratch / "tools/make_site.py") + " " + (scratch / "site") + " 2>" + (scratch / "err")), 1);
  EXPECT_EQ(read_file(scratch / "err"), "README.md: docs/none.md leads nowhere\n"
                                        "docs/reference/lua.md: #no-such-heading: no such heading in docs/reference/lua.md\n");
}

// Without the quotation marks between which a literal goes on in the next line.
void add_joined(const std::string& source, std::string& text) {
  for (std::size_t at = 0; at < source.size(); ++at) {
    const std::size_t next = source[at] == '"' ? source.find_first_not_of(" \t\n", at + 1) : std::string::npos;
    const bool goes_on = next != std::string::npos && next > at + 1 && source[next] == '"';
    if (goes_on) at = next;
    else text += source[at];
  }
}

// The sources of the program.
std::string program_text() {
  std::string text;
  for (const char* folder : {"app", "io", "kernel", "render", "scripting"})
    for (const auto& file : fs::recursive_directory_iterator(kRoot + "/" + folder))
      if (file.path().extension() == ".cpp") add_joined(read_file(file.path()), text);
  return text;
}

TEST(Faq, QuotesMessagesThatTheProgramHas) {
  const std::string program = program_text();
  EXPECT_EQ(program.find("a message that nobody wrote, " "ever"), std::string::npos) << "the control";
  std::istringstream page(read_file(kRoot + "/docs/how_to/faq.md"));
  int quoted = 0;
  for (std::string line; std::getline(page, line);) {
    if (line.rfind("### `", 0) != 0) continue;
    std::string message = line.substr(5);
    if (message.back() == '`') message.pop_back();
    ++quoted;
    EXPECT_NE(program.find(message), std::string::npos) << "docs/how_to/faq.md quotes what the program does not say: " << message;
  }
  EXPECT_GE(quoted, 15);
}

// What a page loads (scripts, styles, pictures), if it is not in the site.
std::set<std::string> missing_in(const fs::path& site) {
  const std::regex loads("(?:<script[^>]* src|<img[^>]* src|<link[^>]* rel=\"(?:stylesheet|icon)\"[^>]* href|"
                         "<link[^>]* href)=\"([^\"#?]+)");
  std::set<std::string> missing;
  for (const auto& page : fs::directory_iterator(site)) {
    if (page.path().extension() != ".html") continue;
    const std::string text = read_file(page.path().string());
    for (std::sregex_iterator at(text.begin(), text.end(), loads), end; at != end; ++at)
      if (const std::string file = (*at)[1]; !fs::exists(site / file) && !fs::exists(site.string() + file))
        missing.insert(page.path().filename().string() + ": " + file);
  }
  return missing;
}

TEST(NightlySite, MkdocsMakesIt) {
  if (run("command -v mkdocs >/dev/null") != 0) GTEST_SKIP() << "mkdocs is not installed";
  const ScratchFolder scratch;
  ASSERT_EQ(run("'" + kRoot + "/tools/make_site.py' " + (scratch / "build/site_source")), 0);
  fs::copy_file(kRoot + "/mkdocs.yml", scratch / "mkdocs.yml");
  ASSERT_EQ(run("cd " + scratch.path().string() + " && mkdocs build --strict >log 2>&1"), 0)
      << read_file(scratch / "log");
  EXPECT_NE(read_file(scratch / "build/site/reference/missions.html").find("collapse.lean_to"), std::string::npos);
  EXPECT_TRUE(fs::exists(scratch / "build/site/search/search_index.json"));
  // Complete without a network; a control that what is not there is found.
  EXPECT_EQ(missing_in(scratch / "build/site"), std::set<std::string>{});
  const std::string picture = picture_of_readme();
  fs::remove(scratch / ("build/site/pictures/" + picture));
  EXPECT_EQ(missing_in(scratch / "build/site"), std::set<std::string>{"index.html: pictures/" + picture});
}

}  // namespace site_test
}  // namespace rubble::testing
