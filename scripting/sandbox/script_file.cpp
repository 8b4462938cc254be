#include "scripting/sandbox/script_file.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <set>

#include "kernel/base/hash.h"
#include "kernel/base/read_file.h"
#include "kernel/base/text.h"

namespace rubble {

static std::string section_of(const std::string& key) {
  return key.substr(0, key.find_first_of(".["));
}

// What else than a script users give: no Lua begins so.
static void check_is_script(const std::string& text, const std::string& path) {
  const std::size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  if (first == std::string::npos) return;
  const std::string expected = "a Lua script";
  if (text[first] == '<')
    throw InputError({path, 0, "", "is no Lua script", expected, "XML",
                      "a mission drives a robot of a URDF file: `robots = { { urdf = \"FILE\", position = { 0, 0, 1 } } }`"});
  if (text[first] == '{')
    throw InputError({path, 0, "", "is no Lua script", expected, "JSON", "`rubble remake` takes a run's manifest.json"});
  if (text.find('\0') != std::string::npos)
    throw InputError({path, 0, "", "is no Lua script", expected, "a file of bytes", "`rubble --help` says which command takes it"});
}

SourceFile read_script(const std::string& path) {
  std::error_code failed;
  if (!std::filesystem::exists(path, failed))
    throw InputError({path, 0, "", "no such file", "", "", ""});
  if (std::filesystem::is_directory(path, failed))
    throw InputError({path, 0, "", "is a folder", "a Lua script", "", ""});
  const std::string text = read_file(path, kLargestScript);
  check_is_script(text, path);
  check_utf8(text, path);
  return {path, text, sha256(text)};
}

void check_utf8(const std::string& text, const std::string& path) {
  const std::size_t at = find_invalid_utf8(text);
  if (at == std::string_view::npos) return;
  char byte[8];
  std::snprintf(byte, sizeof byte, "0x%02x", unsigned(static_cast<unsigned char>(text[at])));
  const auto line = 1 + std::count(text.begin(), text.begin() + std::ptrdiff_t(at), '\n');
  throw InputError({path, int(line), "", "is not UTF-8 text", "UTF-8",
                    "the byte " + std::string(byte), "save the script as UTF-8"});
}

Value run_script(LuaSandbox& sandbox, const SourceFile& script, const SourceMap& lines) {
  try {
    return sandbox.run(script.text, script.path);
  } catch (const InputError& error) {
    std::vector<Diagnostic> diagnostics = error.diagnostics();
    for (Diagnostic& d : diagnostics)
      if (d.line == 0) d.line = lines.line_of("");
    throw InputError(std::move(diagnostics));
  }
}

void locate(std::vector<Diagnostic>& mistakes, const std::string& path, const SourceMap& lines) {
  for (Diagnostic& d : mistakes) {
    if (!d.file.empty()) continue;
    d.file = path;
    d.line = lines.line_of(d.key);
  }
}

void add_duplicates(const SourceMap& lines, std::vector<Diagnostic>& mistakes) {
  for (const SourceMap::Duplicate& twice : lines.duplicates())
    mistakes.push_back({"", 0, twice.key, "written twice", "", "",
                        "first on line " + std::to_string(twice.first_line)});
}

void add_unrelated(const std::vector<Diagnostic>& found, std::vector<Diagnostic>& mistakes) {
  std::set<std::string> sections;
  for (const Diagnostic& d : mistakes) sections.insert(section_of(d.key));
  for (const Diagnostic& d : found)
    if (sections.count(section_of(d.key)) == 0) mistakes.push_back(d);
}

void throw_if_any(std::vector<Diagnostic> mistakes) {
  if (mistakes.empty()) return;
  std::vector<std::string> files;
  const auto rank = [&files](const std::string& file) {
    const auto at = std::find(files.begin(), files.end(), file);
    if (at == files.end()) files.push_back(file);
    return std::find(files.begin(), files.end(), file) - files.begin();
  };
  for (const Diagnostic& d : mistakes) rank(d.file);
  std::stable_sort(mistakes.begin(), mistakes.end(), [&](const Diagnostic& a, const Diagnostic& b) {
    return a.file == b.file ? a.line < b.line : rank(a.file) < rank(b.file);
  });
  throw InputError(std::move(mistakes));
}

}  // namespace rubble
