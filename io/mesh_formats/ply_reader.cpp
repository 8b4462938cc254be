#include "io/mesh_formats/ply_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <sstream>

#include "io/base/atomic_file.h"
#include "io/base/little_endian.h"
#include "io/import/polygon.h"
#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/base/tables/text_table.h"

namespace rubble {
namespace {

// What a property of a vertex is.
constexpr int kPlace = 0, kNormal = 3, kColour = 6, kTexture = 9, kSlots = 11;
constexpr const char* kSlotNames[kSlots] = {"x", "y", "z", "nx", "ny", "nz", "red", "green", "blue", "s", "t"};
constexpr std::pair<const char*, int> kOtherNames[] = {
    {"r", 6},        {"g", 7},         {"b", 8},         {"diffuse_red", 6}, {"diffuse_green", 7}, {"diffuse_blue", 8},
    {"u", 9},        {"v", 10},        {"texture_u", 9}, {"texture_v", 10},  {"texture_s", 9},     {"texture_t", 10}};

struct Property {
  std::string name, type, count_type;  // count_type: of a list; else empty
  int slot = -1;                       // of a vertex; -1: passed over
  double largest = 1;                  // of a colour: the value of full light
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
      : path_(path), bytes_(read_whole_file(path)), rest_(skip_byte_order_mark(bytes_)) {
    const std::size_t end = rest_.find_first_of("\r\n");  // as the first line ends: CR, LF or CRLF
    if (end != std::string_view::npos && rest_[end] == '\r' && rest_.substr(end, 2) != "\r\n") line_end_ = '\r';
  }

  [[noreturn]] void refuse(const std::string& message, const std::string& expected,
                           const std::string& found) const {
    const bool by_line = !binary || in_header;
    const std::string key = by_line ? "" : "byte " + std::to_string(bytes_.size() - rest_.size());
    throw InputError({path_, by_line ? line_ : 0, key, message, expected, found, ""});
  }

  // Without its end; the file ends early where there is none.
  std::string line() {
    const std::size_t end = rest_.find(line_end_);
    if (rest_.empty()) refuse("the file ends early", "a line", "nothing");
    std::string text(rest_.substr(0, end));
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (!text.empty() && text.back() == '\r') text.pop_back();
    ++line_;
    return text;
  }

  double number(const std::string& type) { return binary ? read_binary(type) : read_word(); }

  // Corners and lengths of lists may be written as real numbers.
  double check_whole(double value, const char* expected) const {
    if (value != std::floor(value)) refuse("not a whole number", expected, (std::ostringstream() << value).str());
    return value;
  }

  // The length of a list.
  std::uint64_t list_size(const std::string& type) {
    const double size = check_whole(number(type), "the length of a list");
    if (!(size >= 0 && size <= double(bytes_.size())))
      refuse("no length of a list", "0 or more", (std::ostringstream() << size).str());
    return std::uint64_t(size);
  }

  std::uint64_t left() const { return rest_.size(); }  // unit: byte

  // Text has a line for each item: what a line has beyond its properties is no part of the next item. Text with fewer lines
  // than items is one list of numbers.
  void begin_items(std::uint64_t count) {
    const std::uint64_t ends = std::uint64_t(std::count(rest_.begin(), rest_.end(), line_end_));
    has_lines_ = !binary && ends + (rest_.empty() || rest_.back() == line_end_ ? 0 : 1) >= count;
  }
  void end_item() {
    if (!has_lines_ || word_ >= words_.size()) return;
    words_.clear(), word_ = 0;
    has_more_words = true;
  }

  bool binary = false, big_endian = false, in_header = true;
  bool has_more_words = false;  // a line had more numbers than its item has properties

 private:
  template <typename T>
  double read() {
    T value{};
    if (!take(rest_, value)) refuse("the file ends early", "a number", "nothing");
    if (big_endian) {
      char raw[sizeof value];
      std::memcpy(raw, &value, sizeof value);
      std::reverse(raw, raw + sizeof value);
      std::memcpy(&value, raw, sizeof value);
    }
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
    const std::string& word = words_[word_++];
    const std::string_view w = std::string_view(word).substr(word.size() > 1 && word[0] == '+' ? 1 : 0);
    double value = 0;
    const auto [end, failed] = std::from_chars(w.data(), w.data() + w.size(), value);
    if (failed != std::errc() || end != w.data() + w.size()) refuse("not a number", "a number", word);
    return value;
  }

  std::string path_, bytes_;
  std::string_view rest_;
  char line_end_ = '\n';
  int line_ = 0;
  std::vector<std::string> words_;
  std::size_t word_ = 0;
  bool has_lines_ = false;
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
  if (format != "ascii" && format != "binary_little_endian" && format != "binary_big_endian")
    file.refuse("unknown format", "ascii, binary_little_endian or binary_big_endian", format);
  file.binary = format != "ascii";
  file.big_endian = format == "binary_big_endian";
}

int slot_of(const Property& property) {
  if (!property.count_type.empty()) return -1;
  for (int i = 0; i < kSlots; ++i)
    if (property.name == kSlotNames[i]) return i;
  for (const auto& [name, slot] : kOtherNames)
    if (property.name == name) return slot;
  return -1;
}

// Bytes and shorts hold shares of their largest value.
double full_light(const std::string& type) {
  if (type == "uchar" || type == "uint8") return 255;
  if (type == "ushort" || type == "uint16") return 65535;
  return type == "float" || type == "float32" || type == "double" || type == "float64" ? 1 : 255;
}

void add_property(PlyFile& file, Element& element, std::istringstream& words) {
  Property property = read_property(file, words);
  if (element.name == "vertex") property.slot = slot_of(property);
  const auto is_same = [&](const Property& other) { return other.slot == property.slot; };
  if (std::any_of(element.properties.begin(), element.properties.end(), is_same) && property.slot >= kNormal) property.slot = -1;
  if (property.slot >= kColour && property.slot < kTexture) property.largest = full_light(property.type);
  element.properties.push_back(property);
}

std::vector<Element> read_header(PlyFile& file, PlyMesh& mesh) {
  if (trimmed(file.line()) != "ply") file.refuse("not a PLY file", "ply", "something else");
  std::vector<Element> elements;
  while (true) {
    std::istringstream words(file.line());
    std::string keyword;
    words >> keyword;
    if (keyword == "end_header") break;
    if (keyword == "comment") {
      std::string what;
      words >> what >> std::ws;
      if (what == "TextureFile") std::getline(words, mesh.image);
    }
    if (keyword == "format") read_format(file, words);
    if (keyword == "element") {
      Element element;
      words >> element.name >> std::ws;
      if (words.peek() == '-') {
        std::string count;
        words >> count;
        file.refuse("no count of " + element.name, "0 or more", count);
      }
      if (!(words >> element.count)) file.refuse("not an element", "element NAME COUNT", element.name);
      elements.push_back(element);
    }
    if (keyword != "property") continue;
    if (elements.empty()) file.refuse("a property of nothing", "an element before it", "none");
    add_property(file, elements.back(), words);
  }
  file.in_header = false;
  return elements;
}

bool has_slots(const Element& element, int first, int count) {
  for (int slot = first; slot < first + count; ++slot)
    if (std::none_of(element.properties.begin(), element.properties.end(),
                     [slot](const Property& property) { return property.slot == slot; }))
      return false;
  return true;
}

void read_vertices(PlyFile& file, const Element& element, PlyMesh& mesh) {
  const bool normals = has_slots(element, kNormal, 3), colours = has_slots(element, kColour, 3);
  const bool places = has_slots(element, kTexture, 2);
  for (std::uint64_t i = 0; i < element.count; ++i) {
    double values[kSlots] = {};
    for (const Property& property : element.properties) {
      std::uint64_t count = 1;
      if (!property.count_type.empty()) count = file.list_size(property.count_type);
      for (std::uint64_t k = 0; k < count; ++k) {
        const double value = file.number(property.type);
        if (property.slot < 0) continue;
        if (property.slot < kNormal && !std::isfinite(value)) file.refuse("not finite", property.name, plain_text(value));
        values[property.slot] = value / property.largest;
      }
    }
    file.end_item();
    const auto vector = [&values](int at) { return Vec3(values[at], values[at + 1], values[at + 2]); };
    mesh.positions.push_back(vector(kPlace));
    if (normals) mesh.normals.push_back(Vec3f(vector(kNormal)));
    if (colours) mesh.colours.push_back(Vec3f(vector(kColour)));
    if (places) mesh.places.push_back({float(values[kTexture]), float(values[kTexture + 1])});
  }
}

[[noreturn]] void refuse_no_vertex(const PlyFile& file) { file.refuse("holds no vertex", "points or a mesh", "none"); }

std::uint32_t check_corner(PlyFile& file, const PlyMesh& mesh, double value) {
  if (mesh.positions.empty()) refuse_no_vertex(file);
  if (!(value >= 0 && value < double(mesh.positions.size())))
    file.refuse("no such corner", "0 to " + std::to_string(mesh.positions.size() - 1), (std::ostringstream() << value).str());
  return std::uint32_t(value);
}

void add_polygon(PlyMesh& mesh, const std::vector<std::uint32_t>& corners) {
  if (corners.size() < 3) return void(++mesh.short_faces);
  if (corners.size() == 3) return mesh.triangles.push_back({corners[0], corners[1], corners[2]});
  std::vector<Vec3> outline;
  for (const std::uint32_t i : corners) outline.push_back(mesh.positions[i]);
  for (const auto& t : triangulate(outline)) mesh.triangles.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
}

// Every second triangle of a strip is turned; a negative corner ends a strip.
void add_strips(PlyFile& file, PlyMesh& mesh, const std::vector<double>& values) {
  std::vector<std::uint32_t> strip;
  for (const double value : values) {
    if (value < 0) {
      strip.clear();
      continue;
    }
    strip.push_back(check_corner(file, mesh, value));
    const std::size_t n = strip.size();
    if (n >= 3 && n % 2 == 1) mesh.triangles.push_back({strip[n - 3], strip[n - 2], strip[n - 1]});
    if (n >= 3 && n % 2 == 0) mesh.triangles.push_back({strip[n - 2], strip[n - 3], strip[n - 1]});
  }
}

void read_face(PlyFile& file, const Element& element, PlyMesh& mesh) {
  for (const Property& property : element.properties) {
    const bool list = !property.count_type.empty();
    const bool corners_here = list && (property.name == "vertex_indices" || property.name == "vertex_index");
    const std::uint64_t count = list ? file.list_size(property.count_type) : 1;
    std::vector<double> values;
    for (std::uint64_t i = 0; i < count; ++i) {
      const double value = file.number(property.type);
      if (corners_here) values.push_back(file.check_whole(value, "the number of a vertex, from 0"));
    }
    if (!corners_here) continue;
    if (element.name == "tristrips") {
      add_strips(file, mesh, values);
      continue;
    }
    std::vector<std::uint32_t> corners;
    for (const double value : values) corners.push_back(check_corner(file, mesh, value));
    add_polygon(mesh, corners);
  }
}

// What of the faces is not read.
void note_of_faces(const Element& element, PlyMesh& mesh) {
  for (const Property& property : element.properties) {
    if (property.name == "red" || property.name == "r") mesh.notes.push_back("colours of faces are not drawn; colours of vertices are");
    if (property.name == "texcoord") mesh.notes.push_back("texture coordinates of faces are not drawn; those of vertices are");
  }
}

// What of a file is read: faces before the vertices take two readings.
enum class Part { all, vertices, faces };

bool has_faces(const Element& element) { return element.name == "face" || element.name == "tristrips"; }

bool has_faces_first(const std::vector<Element>& elements) {
  const auto first = std::find_if(elements.begin(), elements.end(), [](const Element& e) { return e.name == "vertex" || has_faces(e); });
  return first != elements.end() && has_faces(*first);
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
void read_items(PlyFile& file, const Element& element, Part part, PlyMesh& mesh) {
  if (element.properties.empty()) return;
  if (element.count > file.left())
    file.refuse("the file ends early", std::to_string(element.count) + " of " + element.name,
                std::to_string(file.left()) + " bytes");
  file.begin_items(element.count);
  if (element.name == "vertex" && part != Part::faces) return read_vertices(file, element, mesh);
  const bool faces = has_faces(element) && part != Part::vertices;
  if (element.name == "face" && faces) note_of_faces(element, mesh);
  if (element.name == "edge" && element.count > 0 && part != Part::faces) mesh.notes.push_back("lines beside its faces are left out");
  for (std::uint64_t i = 0; i < element.count; ++i) {
    if (faces)
      read_face(file, element, mesh);
    else
      pass_over(file, element);
    file.end_item();
  }
}

void read_faces(const std::string& path, PlyMesh& mesh) {
  PlyFile file(path);
  PlyMesh header;
  for (const Element& element : read_header(file, header)) read_items(file, element, Part::faces, mesh);
}

void check_vertex(PlyFile& file, const Element& element) {
  for (const char* axis : {"x", "y", "z"}) {
    const int slot = axis[0] - 'x';
    if (!has_slots(element, slot, 1))
      file.refuse("a vertex without a place", "properties x, y and z", "no " + std::string(axis));
  }
}

}  // namespace

PlyMesh load_ply(const std::string& path) {
  PlyFile file(path);
  PlyMesh mesh;
  const std::vector<Element> elements = read_header(file, mesh);
  const bool faces_first = has_faces_first(elements);
  for (const Element& element : elements) {
    if (element.name == "vertex") check_vertex(file, element);
    read_items(file, element, faces_first ? Part::vertices : Part::all, mesh);
  }
  if (faces_first) read_faces(path, mesh);
  if (mesh.positions.empty()) refuse_no_vertex(file);
  if (mesh.short_faces > 0)
    mesh.notes.push_back("faces of less than three corners are left out: " + std::to_string(mesh.short_faces));
  if (file.has_more_words) mesh.notes.push_back("numbers beyond the properties of its header are left out");
  return mesh;
}

ImportedScene read_ply_scene(const std::string& path) {
  PlyMesh ply = load_ply(path);
  if (ply.triangles.empty())
    refuse_mesh(path, "holds no triangles: it is a cloud of " + std::to_string(ply.positions.size()) + " points",
                "make a surface of it first; `rubble eval map` reads clouds");
  ImportedScene scene;
  scene.notes = ply.notes;
  scene.materials.emplace_back();
  scene.materials.back().name = kDefaultMaterial;
  if (!ply.image.empty() && !ply.places.empty()) {
    scene.images.push_back({ply.image, nullptr, ""});
    scene.materials.back().albedo.image = 0;
  }
  ImportedMesh& mesh = mesh_for(scene, 0, 0);
  mesh.positions = std::move(ply.positions);
  mesh.normals = std::move(ply.normals);
  mesh.colours = std::move(ply.colours);
  if (!ply.places.empty()) mesh.uv_sets = {std::move(ply.places)};
  mesh.triangles = std::move(ply.triangles);
  return scene;
}

}  // namespace rubble
