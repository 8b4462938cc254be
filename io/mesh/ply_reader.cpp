#include "io/mesh/ply_reader.h"

#include <charconv>
#include <cmath>
#include <sstream>

#include "io/base/atomic_file.h"
#include "io/base/little_endian.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

struct Property {
  std::string name, type, count_type;  // count_type: of a list; else empty
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

// The file, its place in it, and numbers of either encoding.
class PlyFile {
 public:
  explicit PlyFile(const std::string& path)
      : path_(path), bytes_(read_whole_file(path)), rest_(bytes_) {}

  [[noreturn]] void refuse(const std::string& message, const std::string& expected,
                           const std::string& found) const {
    const bool by_line = !binary || in_header;
    const std::string key = by_line ? "" : "byte " + std::to_string(bytes_.size() - rest_.size());
    throw InputError({path_, by_line ? line_ : 0, key, message, expected, found, ""});
  }

  // Without its end; the file ends early where there is none.
  std::string line() {
    const std::size_t end = rest_.find('\n');
    if (rest_.empty()) refuse("the file ends early", "a line", "nothing");
    std::string text(rest_.substr(0, end));
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (!text.empty() && text.back() == '\r') text.pop_back();
    ++line_;
    return text;
  }

  double number(const std::string& type) { return binary ? read_binary(type) : read_word(); }

  // The length of a list.
  std::uint64_t list_size(const std::string& type) {
    const double size = number(type);
    if (!(size >= 0 && size <= double(bytes_.size())))
      refuse("no length of a list", "0 or more", (std::ostringstream() << size).str());
    return std::uint64_t(size);
  }

  std::uint64_t left() const { return rest_.size(); }  // unit: byte

  bool binary = false, in_header = true;

 private:
  template <typename T>
  double read() {
    T value{};
    if (!take(rest_, value)) refuse("the file ends early", "a number", "nothing");
    return double(value);
  }

  double read_binary(const std::string& type) {
    if (type == "float" || type == "float32") return read<float>();
    if (type == "double" || type == "float64") return read<double>();
    if (type == "uchar" || type == "uint8") return read<std::uint8_t>();
    if (type == "char" || type == "int8") return read<std::int8_t>();
    if (type == "ushort" || type == "uint16") return read<std::uint16_t>();
    if (type == "short" || type == "int16") return read<std::int16_t>();
    if (type == "uint" || type == "uint32") return read<std::uint32_t>();
    return read<std::int32_t>();  // the header lets no other pass
  }

  double read_word() {
    while (words_.size() <= word_) {
      std::istringstream text(line());
      words_.clear(), word_ = 0;
      for (std::string w; text >> w;) words_.push_back(w);
    }
    const std::string& w = words_[word_++];
    double value = 0;
    const auto [end, failed] = std::from_chars(w.data(), w.data() + w.size(), value);
    if (failed != std::errc() || end != w.data() + w.size()) refuse("not a number", "a number", w);
    return value;
  }

  std::string path_, bytes_;
  std::string_view rest_;
  int line_ = 0;
  std::vector<std::string> words_;
  std::size_t word_ = 0;
};

bool is_type(const std::string& type) {
  for (const char* known :
       {"char", "uchar", "short", "ushort", "int", "uint", "float", "double", "int8", "uint8",
        "int16", "uint16", "int32", "uint32", "float32", "float64"})
    if (type == known) return true;
  return false;
}

Property read_property(PlyFile& file, std::istringstream& words) {
  Property property;
  words >> property.type;
  if (property.type == "list") words >> property.count_type >> property.type;
  words >> property.name;
  if (property.name.empty() || !is_type(property.type) ||
      (!property.count_type.empty() && !is_type(property.count_type)))
    file.refuse("not a property", "property [list TYPE] TYPE NAME", property.type);
  return property;
}

void read_format(PlyFile& file, std::istringstream& words) {
  std::string format;
  words >> format;
  if (format != "ascii" && format != "binary_little_endian")
    file.refuse("unknown format", "ascii or binary_little_endian", format);
  file.binary = format != "ascii";
}

std::vector<Element> read_header(PlyFile& file) {
  if (file.line() != "ply") file.refuse("not a PLY file", "ply", "something else");
  std::vector<Element> elements;
  while (true) {
    std::istringstream words(file.line());
    std::string keyword;
    words >> keyword;
    if (keyword == "end_header") break;
    if (keyword == "format") read_format(file, words);
    if (keyword == "element") {
      Element element;
      if (!(words >> element.name >> element.count))
        file.refuse("not an element", "element NAME COUNT", element.name);
      elements.push_back(element);
    }
    if (keyword != "property") continue;
    if (elements.empty()) file.refuse("a property of nothing", "an element before it", "none");
    elements.back().properties.push_back(read_property(file, words));
  }
  file.in_header = false;
  return elements;
}

void read_vertex(PlyFile& file, const Element& element, PlyMesh& mesh) {
  Vec3 position;
  for (const Property& property : element.properties) {
    std::uint64_t count = 1;
    if (!property.count_type.empty()) count = file.list_size(property.count_type);
    for (std::uint64_t i = 0; i < count; ++i) {
      const double value = file.number(property.type);
      const int axis = property.name.size() == 1 ? property.name[0] - 'x' : -1;
      if (axis < 0 || axis > 2) continue;
      if (!std::isfinite(value)) file.refuse("not finite", property.name, std::to_string(value));
      position[axis] = value;
    }
  }
  mesh.positions.push_back(position);
}

void read_face(PlyFile& file, const Element& element, PlyMesh& mesh) {
  for (const Property& property : element.properties) {
    const bool list = !property.count_type.empty();
    const bool corners_here = property.name == "vertex_indices" || property.name == "vertex_index";
    const std::uint64_t count = list ? file.list_size(property.count_type) : 1;
    std::vector<std::uint32_t> corners;
    for (std::uint64_t i = 0; i < count; ++i) {
      const double value = file.number(property.type);
      if (!corners_here) continue;
      if (!(value >= 0 && value < double(mesh.positions.size())))
        file.refuse("no such corner", "0 to " + std::to_string(mesh.positions.size() - 1),
                    (std::ostringstream() << value).str());
      corners.push_back(std::uint32_t(value));
    }
    for (std::size_t i = 2; i < corners.size(); ++i)
      mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
  }
}

void pass_over(PlyFile& file, const Element& element) {
  for (const Property& property : element.properties) {
    std::uint64_t count = 1;
    if (!property.count_type.empty()) count = file.list_size(property.count_type);
    for (std::uint64_t i = 0; i < count; ++i) file.number(property.type);
  }
}

// Every item takes a byte at least for each of its properties: what a file says of itself must not
// take more time or memory than the file has bytes. One of an element without properties takes none.
void read_items(PlyFile& file, const Element& element, PlyMesh& mesh) {
  if (element.properties.empty()) return;
  if (element.count > file.left())
    file.refuse("the file ends early", std::to_string(element.count) + " of " + element.name,
                std::to_string(file.left()) + " bytes");
  for (std::uint64_t i = 0; i < element.count; ++i) {
    if (element.name == "vertex")
      read_vertex(file, element, mesh);
    else if (element.name == "face")
      read_face(file, element, mesh);
    else
      pass_over(file, element);
  }
}

void check_vertex(PlyFile& file, const Element& element) {
  for (const char* axis : {"x", "y", "z"}) {
    bool found = false;
    for (const Property& property : element.properties) found |= property.name == axis;
    if (!found)
      file.refuse("a vertex without a place", "properties x, y and z", "no " + std::string(axis));
  }
}

}  // namespace

PlyMesh load_ply(const std::string& path) {
  PlyFile file(path);
  PlyMesh mesh;
  for (const Element& element : read_header(file)) {
    if (element.name == "vertex") check_vertex(file, element);
    read_items(file, element, mesh);
  }
  if (mesh.positions.empty()) file.refuse("holds no vertex", "points or a mesh", "none");
  return mesh;
}

}  // namespace rubble
