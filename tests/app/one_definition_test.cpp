// The one-definition rule for classes: two of one name in one namespace share the code of their inline functions
// and of containers of them, whichever the linker takes. No compiler says so, for it sees one source at a time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace rubble {
namespace one_definition_test {

namespace fs = std::filesystem;

// Where what begins at i ends, if it is a comment, a literal or a line of the preprocessor; else i.
std::size_t end_of_other(const std::string& s, std::size_t i) {
  const auto after = [&](const std::string& mark, std::size_t from) {
    const std::size_t at = s.find(mark, from);
    return at == std::string::npos ? s.size() : at + mark.size();
  };
  const auto end_of_line = [&] {
    std::size_t end = s.find('\n', i);
    while (end != std::string::npos && end > 0 && s[end - 1] == '\\') end = s.find('\n', end + 1);
    return std::min(end, s.size());
  };
  if (s.compare(i, 2, "//") == 0) return end_of_line();
  if (s.compare(i, 2, "/*") == 0) return after("*/", i + 2);
  if (s.compare(i, 2, "R\"") == 0) {
    const std::size_t open = s.find('(', i);
    return open == std::string::npos ? s.size() : after(")" + s.substr(i + 2, open - i - 2) + "\"", open);
  }
  if (s[i] == '#' && s.find_last_not_of(" \t", i - 1) == s.rfind('\n', i)) return end_of_line();
  const bool digits = s[i] == '\'' && i > 0 && std::isxdigit(static_cast<unsigned char>(s[i - 1]));  // 1'000
  if ((s[i] != '"' && s[i] != '\'') || digits) return i;
  for (std::size_t k = i + 1; k < s.size(); ++k) {
    if (s[k] == '\\') ++k;
    else if (s[k] == s[i]) return k + 1;
  }
  return s.size();
}

std::string without_other(const std::string& source) {
  const std::string s = "\n" + source;
  std::string out;
  for (std::size_t i = 0; i < s.size();)
    if (const std::size_t end = end_of_other(s, i); end > i)
      i = end, out += ' ';
    else
      out += s[i++];
  return out;
}

bool is_any_of(const std::string& word, const std::vector<std::string>& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// Of what stands before a brace: the name of the namespace, or of the class without a qualifier, that it opens.
struct Opened {
  bool space = false;
  std::string name;
};

Opened what_opens(const std::string& head) {
  std::string spaced;  // words, "::" as a part of them, and every other character alone
  for (std::size_t i = 0; i < head.size(); ++i) {
    const bool word = std::isalnum(static_cast<unsigned char>(head[i])) || head[i] == '_';
    if (head.compare(i, 2, "::") == 0)
      spaced += "::", ++i;
    else
      spaced += word ? std::string(1, head[i]) : std::string(" ") + head[i] + " ";
  }
  std::istringstream in(spaced);
  std::vector<std::string> words{std::istream_iterator<std::string>(in), {}};
  for (const auto& [open, close] : {std::pair("alignas", ")"), std::pair("[", "]")})
    for (auto from = std::find(words.begin(), words.end(), open); from != words.end();
         from = std::find(words.begin(), words.end(), open)) {
      const auto to = std::find(from, words.end(), close);
      words.erase(from, to == words.end() ? to : to + 1);
    }
  words.erase(std::remove(words.begin(), words.end(), "]"), words.end());  // the second of an attribute
  for (std::size_t i = 0; i < words.size(); ++i)
    if (words[i] == "namespace") return {true, i + 1 < words.size() ? words[i + 1] : ""};
  // After the parameters of a template, whose words "class" are none.
  std::size_t first = 0, depth = 0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "(") return {};  // a function, or an attribute of something that is none of ours
    if (words[i] == "<") ++depth;
    if (words[i] == ">" && depth > 0 && --depth == 0 && first == 0 && words[0] == "template") first = i + 1;
  }
  if (first >= words.size() || !is_any_of(words[first], {"class", "struct", "union", "enum"})) return {};
  for (std::size_t i = first + 1; i < words.size(); ++i)
    if (!is_any_of(words[i], {"class", "struct"})) return {false, words[i].find("::") == std::string::npos ? words[i] : ""};
  return {};
}

// Classes, structures, enumerations and unions that a source defines in namespaces with a name: "rubble::World".
std::set<std::string> classes_of(const std::string& source) {
  const std::string text = without_other(source);
  std::vector<std::string> open;  // the name of a namespace; empty: a block that may hold no more of them
  std::set<std::string> found;
  std::size_t last = 0;
  for (std::size_t i = text.find_first_of("{};"); i != std::string::npos; i = text.find_first_of("{};", i + 1)) {
    if (text[i] == '}' && !open.empty()) open.pop_back();
    if (text[i] == '{') {
      const bool named = std::find(open.begin(), open.end(), "") == open.end();
      const Opened opened = named ? what_opens(text.substr(last, i - last)) : Opened{};
      std::string name;
      for (const std::string& part : open) name += part + "::";
      if (!opened.space && !opened.name.empty()) found.insert(name + opened.name);
      open.push_back(opened.space ? opened.name : "");
    }
    last = i + 1;
  }
  return found;
}

TEST(OneDefinition, FindsWhatASourceDefines) {
  const std::string source = R"cpp(
    // struct Comment { };
    #define RUBBLE_X struct Macro {
    namespace rubble {
    struct A { struct Within { int x; }; };
    class B;
    class B final : public A { void f() { struct Local {}; } };
    enum class Colour : int { red };
    template <typename T> struct Box { T value; };
    struct A::Part { int y; };
    struct alignas(16) Wide { float x[4]; };
    class [[nodiscard]] Marked { };
    const char* text = "struct Text {";
    inline A make() { return A{}; }
    namespace { struct Hidden {}; }
    namespace inner { union U { int i; float f; }; }
    }
  )cpp";
  EXPECT_EQ(classes_of(source), (std::set<std::string>{"rubble::A", "rubble::B", "rubble::Colour", "rubble::Box",
                                                       "rubble::Wide", "rubble::Marked", "rubble::inner::U"}));
}

TEST(OneDefinition, EveryClassHasANameOfItsOwn) {
  std::map<std::string, std::set<std::string>> files;  // by class
  for (const char* floor : {"kernel", "render", "io", "scripting", "assets", "app", "bench", "python"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(RUBBLE_SOURCE_DIR) / floor)) {
      if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
      std::ifstream in(entry.path());
      const std::string text{std::istreambuf_iterator<char>(in), {}};
      for (const std::string& name : classes_of(text))
        files[name].insert(fs::relative(entry.path(), RUBBLE_SOURCE_DIR).string());
    }
  EXPECT_GT(files.size(), 900u);
  // One of two that are never built together.
  files["rubble::SimbodyTree"].erase("kernel/multibody/no_simbody.cpp");
  files["rubble::Sha256"].erase("kernel/base/sha256_plain.cpp");
  for (const auto& [name, where] : files) {
    std::string list;
    for (const std::string& file : where) list += " " + file;
    EXPECT_LE(where.size(), 1u) << name << " is defined in" << list
                                << ": give one of them another name, or put it into an unnamed namespace";
  }
}

}  // namespace one_definition_test
}  // namespace rubble
