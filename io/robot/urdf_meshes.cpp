#include "io/robot/urdf_elements.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <vector>

namespace rubble {
namespace {

namespace fs = std::filesystem;

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// "%20" is a blank, as in every URI.
std::string percent_decoded(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool coded = text[i] == '%' && i + 2 < text.size() && hex_digit(text[i + 1]) >= 0 && hex_digit(text[i + 2]) >= 0;
    out += coded ? char(hex_digit(text[i + 1]) * 16 + hex_digit(text[i + 2])) : text[i];
    if (coded) i += 2;
  }
  return out;
}

bool starts_with(const std::string& text, const char* start) { return text.rfind(start, 0) == 0; }

std::string without_first_folder(const std::string& path) {
  const std::size_t slash = path.find('/');
  return slash == std::string::npos ? "" : path.substr(path.find_first_not_of('/', slash));
}

std::vector<std::string> folders_of(const char* variable) {
  std::vector<std::string> folders;
  const char* const value = std::getenv(variable);
  std::string rest = value ? value : "";
  while (!rest.empty()) {
    const std::size_t colon = rest.find(':');
    if (colon != 0) folders.push_back(rest.substr(0, colon));
    rest = colon == std::string::npos ? "" : rest.substr(colon + 1);
  }
  return folders;
}

class Search {
 public:
  explicit Search(const std::string& urdf_path) {
    fs::path folder = fs::absolute(fs::path(urdf_path)).lexically_normal().parent_path();
    for (; folder != folder.parent_path(); folder = folder.parent_path()) folders_.push_back(folder);
    folders_.push_back(folder);
  }

  // Nearest folder first, in each the names in their order.
  bool upwards(const std::vector<std::string>& names) {
    for (const fs::path& folder : folders_)
      for (const std::string& name : names)
        if (is_file(folder, name)) return true;
    return false;
  }

  bool is_file(const fs::path& folder, const std::string& name) {
    std::error_code failed;
    if (name.empty() || !fs::is_regular_file(folder / name, failed)) return false;
    found_ = (folder / name).lexically_normal().string();
    return true;
  }

  const std::string& found() const { return found_; }

 private:
  std::vector<fs::path> folders_;  // of the URDF file, up to the root
  std::string found_;
};

bool find_package_file(const std::string& path, Search& search) {
  const std::string below = without_first_folder(path);
  if (search.upwards({path, below})) return true;
  for (const std::string& folder : folders_of("ROS_PACKAGE_PATH"))
    if (search.is_file(folder, path) || search.is_file(fs::path(folder) / "src", path) ||
        (fs::path(folder).filename() == path.substr(0, path.find('/')) && search.is_file(folder, below)))
      return true;
  for (const std::string& folder : folders_of("AMENT_PREFIX_PATH"))
    if (search.is_file(fs::path(folder) / "share", path)) return true;
  return false;
}

bool find_absolute(const std::string& path, Search& search) {
  if (search.is_file("/", path)) return true;
  // The longest end of the path that lies near the URDF file.
  for (std::string end = path; !end.empty(); end = without_first_folder(end))
    if (search.upwards({end})) return true;
  return false;
}

bool find(std::string name, Search& search) {
  for (const char* scheme : {"package://", "model://"})
    if (starts_with(name, scheme)) return find_package_file(name.substr(std::string(scheme).size()), search);
  const bool uri = starts_with(name, "file:");
  if (uri) name.erase(0, 5);
  const std::size_t path = name.find_first_not_of('/');
  if (path == std::string::npos) return false;
  if (path == 0) return search.upwards({name, without_first_folder(name)});
  return find_absolute(name.substr(path), search);
}

}  // namespace

std::string find_urdf_mesh(const std::string& name, const std::string& urdf_path) {
  Search search(urdf_path);
  std::string slashes = name;
  std::replace(slashes.begin(), slashes.end(), '\\', '/');
  for (const std::string& tried : {name, percent_decoded(name), slashes})
    if (find(tried, search)) return search.found();
  return "";
}

}  // namespace rubble
