// What strangers name or write goes through one function each: files that are written or removed, folders, text on a
// terminal, names in HTML, XML and tables. This finds the sources that go another way.
#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace rubble {
namespace guarded_calls_test {

namespace fs = std::filesystem;

struct Rule {
  const char* what;                  // that goes through one function
  const char* instead;               // that function
  std::vector<std::string> calls;    // in a line of a source, comments left out: words, not parts of longer ones
  std::vector<std::string> fine;     // what makes such a line right
  std::vector<std::string> allowed;  // beginnings of paths
};

const std::vector<Rule>& rules() {
  static const std::string kDoor = "kernel/base/system/output_files.cpp";
  static const std::vector<Rule> all{
      {"a file is opened for writing", "AtomicFile, write_text_file, create_output_file or AppendedFile",
       {"ofstream", "fstream", "O_CREAT", "O_TRUNC", "O_APPEND", "fopen(", "mkstemp(", "resize_file(", "truncate(",
        "ftruncate(", "copy_file(", "create_symlink(", "symlink("},
       {"\"r", "#include"},
       {kDoor, "io/base/atomic_file_windows.cpp", "app/provenance/folder_lock.cpp"}},
      {"a folder is made", "make_output_folder, make_folder_below or make_private_folder",
       {"create_directories(", "create_directory(", "mkdir(", "mkdirat(", "mkdtemp("}, {}, {kDoor}},
      {"a file or folder is removed", "remove_plain_files, remove_output_file or remove_output_folder",
       {"fs::remove(", "fs::remove_all(", "filesystem::remove(", "filesystem::remove_all(", "unlink(", "unlinkat(",
        "rmdir(", "std::remove("},
       {"std::remove(path.begin", "std::remove(text.begin"},
       {kDoor, "io/base/remove_files.cpp", "io/base/atomic_file_windows.cpp"}},
      {"a file is renamed", "AtomicFile or FolderWriter", {"rename("}, {},
       {"io/base/atomic_file", "kernel/base/system/disk_cache.cpp", "app/batch/batch_folder.cpp"}},
      {"a file is read that may be a pipe without an end", "read_file, read_whole_file or FileCursor",
       {"ifstream", "fopen(", "O_RDONLY"}, {"\"w", "\"a", "\"/proc/", "\"/sys/", "\"/dev/null\"", "O_DIRECTORY"},
       {"kernel/base/read_file.cpp", "io/base/file_cursor", "kernel/base/read_file_windows.cpp", "kernel/base/hash.cpp", "kernel/base/system/",
        "app/provenance/compare.cpp"}},
      {"a library opens a file by its name", "read_file and the library's reader of bytes",
       {"imread(", "imreadmulti(", "VideoCapture(", "FileStorage(", "InputFile", "RgbaInputFile", "CFileGZInputStream",
        "CFileInputStream", "loadFromFile(", "loadFromTextFile(", "LoadFile(", "luaL_loadfile", "luaL_loadfilex", "luaL_dofile",
        "TIFFOpen(", "stbi_load(", "jpeg_stdio_src(", "png_init_io(", "png_image_begin_read_from_file", "io::File",
        "readBinary(", "ReadFile(", "gzopen(", "archive_read_open_filename(", "sqlite3_open", "mmap(", "initFileURDF"},
       {}, {"io/image/exr_file.cpp", "io/playback/rawlog_pictures.cpp", "io/mesh_formats/assimp_reader.cpp"}},
      {"something is printed", "print_out, print_err or print_json",
       {"printf(", "fprintf(", "vprintf(", "fputs(", "puts(", "putchar(", "perror(", "cout", "cerr", "clog", "stdout", "stderr"},
       {"fflush(stdout)", "fflush(stderr)"},
       {"app/support/print."}},
      {"a temporary file has a name that can be guessed", "make_private_folder", {"temp_directory_path("},
       {"make_private_folder"}, {}},
      {"a name is put into a table", "csv_text", {"\",\" + name", "\",\" + names[i]", ".name + \",\"", "\",\" + asset.name", "\",\" + image.name"},
       {"csv_text"}, {"io/datasets/euroc_recorder.cpp"}},
      {"a name is put into HTML or XML", "html_escape or xml_text",
       {">\" + name", ">\" + title", "=\\\"\" + name", "=\\\"\" + link.name", "=\\\"\" + joint.name", "=\\\"\" + piece.name", "<h1>\" + title"},
       {}, {"io/live/live_ros2.cpp"}},
  };
  return all;
}

bool is_word_at(const std::string& line, std::size_t at) {
  const auto inside = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  return at == 0 || !inside(line[at - 1]) || !inside(line[at]);
}

bool has(const std::string& line, const std::string& call) {
  for (std::size_t at = line.find(call); at != std::string::npos; at = line.find(call, at + 1)) {
    const std::size_t end = at + call.size();
    const bool longer = call.back() != '(' && end < line.size() && (std::isalnum(static_cast<unsigned char>(line[end])) || line[end] == '_');
    if (is_word_at(line, at) && !longer) return true;
  }
  return false;
}

bool begins(const std::string& text, const std::string& prefix) { return text.compare(0, prefix.size(), prefix) == 0; }

// "FILE:LINE ..." of each line that goes another way.
std::vector<std::string> find_bypasses(const std::string& file, int number, std::string line) {
  std::vector<std::string> found;
  if (const std::size_t comment = line.find("//"); comment != std::string::npos && line.find('"') > comment)
    line.resize(comment);
  for (const Rule& rule : rules()) {
    bool passed = false, called = false;
    for (const std::string& prefix : rule.allowed) passed = passed || begins(file, prefix);
    for (const std::string& call : rule.calls) called = called || has(line, call);
    for (const std::string& right : rule.fine) passed = passed || line.find(right) != std::string::npos;
    if (called && !passed)
      found.push_back(file + ":" + std::to_string(number) + ": " + rule.what + " by other means than " + rule.instead + ":" + line);
  }
  return found;
}

// Programs of the build alone, which read and write what the build names.
bool is_of_the_build(const std::string& file) {
  return begins(file, "assets/generator/") || begins(file, "scripting/reference/write_reference.cpp");
}

TEST(GuardedCalls, AreTheOnlyWay) {
  int lines = 0;
  for (const char* floor : {"kernel", "render", "io", "scripting", "app", "python", "assets"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(RUBBLE_SOURCE_DIR) / floor)) {
      const std::string file = fs::relative(entry.path(), RUBBLE_SOURCE_DIR).string();
      const std::string end = entry.path().extension().string();
      if ((end != ".h" && end != ".cpp") || is_of_the_build(file)) continue;
      std::ifstream in(entry.path());
      std::string line;
      for (int number = 1; std::getline(in, line); ++number, ++lines)
        for (const std::string& bypass : find_bypasses(file, number, line)) ADD_FAILURE() << bypass;
    }
  }
  EXPECT_GT(lines, 50000);
}

// Sources that open files to read themselves ask first whether they may: kernel/base/system/file_sandbox.h.
TEST(GuardedCalls, WhoeverOpensAFileAsksTheSandbox) {
  for (const char* file :
       {"kernel/base/read_file.cpp", "kernel/base/read_file_windows.cpp", "kernel/base/hash.cpp", "io/base/file_cursor.cpp",
        "app/provenance/compare.cpp", "io/image/exr_file.cpp", "io/playback/rawlog_pictures.cpp",
        "io/mesh_formats/assimp_reader.cpp", "io/robot/xacro_tool.cpp"}) {
    std::ifstream in(fs::path(RUBBLE_SOURCE_DIR) / file);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    bool asks = false;
    for (const char* question : {"check_may_read(", "check_readable_file(", "find_refusal(", "sandbox_folder("})
      asks = asks || text.find(question) != std::string::npos;
    EXPECT_TRUE(asks) << file;
  }
  for (const char* way : {"create_output_file", "AppendedFile::AppendedFile", "make_output_folder", "make_folder_below", "create_locked_folder"}) {
    std::ifstream in(fs::path(RUBBLE_SOURCE_DIR) / "kernel/base/system/output_files.cpp");
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const std::size_t at = text.find(std::string(way) + "(const std::string&");
    ASSERT_NE(at, std::string::npos) << way;
    EXPECT_LT(text.find("check_may_write(", at) - at, 200u) << way;
  }
}

TEST(GuardedCalls, TheCheckSeesABypass) {
  for (const char* line :
       {"std::ofstream out(path);", "FILE* f = std::fopen(path.c_str(), \"wb\");", "open(path, O_WRONLY | O_CREAT, 0666);",
        "fs::create_directories(folder);", "mkdir(path.c_str(), 0777);", "std::filesystem::remove_all(folder, failed);",
        "::unlink(path.c_str());", "std::remove(path.c_str());", "std::rename(a, b);", "open(path, O_RDWR | O_APPEND);", "std::ifstream in(path);",
        "cv::imread(path);", "importer.ReadFile(path, 0);", "Imf::InputFile file(path.c_str());", "luaL_dofile(lua, path);",
        "std::printf(\"%s\", name);", "std::fprintf(stderr, \"x\");", "std::cerr << name;", "std::fputs(text, stdout);",
        "fs::temp_directory_path() / \"x\";", "text += \",\" + asset.name;", "\"<h1>\" + title;", "text += \" name=\\\"\" + link.name;"})
    EXPECT_EQ(find_bypasses("app/x.cpp", 1, line).size(), 1u) << line;
  for (const char* line :
       {"// std::ofstream is not used", "std::snprintf(text, sizeof text, \"%d\", i);", "path.erase(std::remove(path.begin(), path.end(), 'x'));",
        "pieces.remove_all();", "text += \",\" + csv_text(asset.name);", "\"<h1>\" + html_escape(title);"})
    EXPECT_EQ(find_bypasses("app/x.cpp", 1, line).size(), 0u) << line;
  EXPECT_EQ(find_bypasses("kernel/base/system/output_files.cpp", 1, "mkdir(path.c_str(), 0777);").size(), 0u);
}

}  // namespace guarded_calls_test
}  // namespace rubble
