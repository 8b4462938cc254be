#include "io/mesh_formats/scene_reader.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "io/base/text_scan.h"
#include "kernel/base/read_file.h"
#include "kernel/base/text.h"

namespace rubble {
namespace {

constexpr std::size_t kStlHeader = 84, kStlFacet = 50;  // unit: byte
constexpr std::uint16_t kColoured = 0x8000;
constexpr float kUncoloured = 0.6f;  // of facets without a colour in a file with colours

template <typename T>
T number_from(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

Vec3f read_vector(const char* at) { return {number_from<float>(at), number_from<float>(at + 4), number_from<float>(at + 8)}; }

// Five bits each; which end is red depends on the program.
Vec3f facet_colour(std::uint16_t bits, bool magics) {
  const auto share = [bits](int shift) { return float(bits >> shift & 31) / 31; };
  return magics ? Vec3f(share(0), share(5), share(10)) : Vec3f(share(10), share(5), share(0));
}

void add_facet(ImportedMesh& mesh, const Vec3f& normal, const std::array<Vec3, 3>& corners) {
  const auto first = std::uint32_t(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), corners.begin(), corners.end());
  mesh.normals.insert(mesh.normals.end(), 3, normal);
  mesh.triangles.push_back({first, first + 1, first + 2});
}

void read_binary(const std::string& path, std::string_view bytes, ImportedScene& scene) {
  const auto count = std::uint64_t(number_from<std::uint32_t>(bytes.data() + 80));
  if (bytes.size() < kStlHeader + kStlFacet * count && is_utf16(bytes)) refuse_mesh(path, "is UTF-16 text: save it as UTF-8");
  if (bytes.size() < kStlHeader + kStlFacet * count)
    refuse_mesh(path, "the STL file ends early: " + std::to_string(count) + " facets take " +
                          std::to_string(kStlHeader + kStlFacet * count) + " bytes, and it has " + std::to_string(bytes.size()));
  const bool magics = bytes.substr(0, 80).find("COLOR=") != std::string_view::npos;
  const std::size_t beyond = bytes.size() - std::size_t(kStlHeader + kStlFacet * count);
  if (beyond >= kStlFacet)
    scene.note(std::to_string(beyond) + " bytes behind the " + std::to_string(count) +
               " facets that the file states are left out: is the count right?");
  ImportedMesh& mesh = mesh_for(scene, 0, 0);
  for (std::uint64_t i = 0; i < count; ++i) {
    const char* at = bytes.data() + kStlHeader + kStlFacet * i;
    const Vec3f normal = read_vector(at);
    add_facet(mesh, normal, {Vec3(read_vector(at + 12)), Vec3(read_vector(at + 24)), Vec3(read_vector(at + 36))});
    const auto attribute = number_from<std::uint16_t>(at + 48);
    // The flag means "has a colour of its own" to VisCAM, and the opposite to Magics.
    const bool coloured = attribute != 0 && ((attribute & kColoured) != 0) != magics;
    if (coloured && mesh.colours.empty()) mesh.colours.assign(mesh.positions.size() - 3, {kUncoloured, kUncoloured, kUncoloured});
    if (coloured)
      mesh.colours.insert(mesh.colours.end(), 3, facet_colour(attribute, magics));
    else if (!mesh.colours.empty())
      mesh.colours.insert(mesh.colours.end(), 3, {kUncoloured, kUncoloured, kUncoloured});
  }
}

// What some programs put behind the last line of a text.
constexpr std::string_view kPadding("\0\x1a \t\r\n", 6);

bool is_comment(std::string_view line) { return take_word(line).substr(0, 1) == "#"; }

class TextReader {
 public:
  TextReader(const std::string& path, std::string_view text, ImportedScene& scene)
      : path_(path), lines_(text.substr(0, text.find_last_not_of(kPadding) + 1), false), scene_(scene) {}

  void read() {
    while (lines_.next()) {
      std::string_view rest = lines_.line();
      if (is_comment(rest)) continue;
      for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) take(lower(word), rest);
    }
    if (corner_ > 0) refuse("a facet of less than three corners");
    if (in_facet_) refuse("the STL file ends early: within a facet");
    if (open_) scene_.note("`endsolid` is missing: the file may be cut off");
  }

 private:
  static std::string lower(std::string_view word) {
    std::string out(word);
    for (char& c : out) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
    return out;
  }

  void take(const std::string& word, std::string_view& rest) {
    if (word == "solid" || word == "endsolid") {
      object_ += word == "solid", open_ = word == "solid";
      rest = {};  // a name
    } else if (word == "normal") {
      for (int i = 0; i < 3; ++i) normal_[i] = float(direction(rest));
    } else if (word == "vertex") {
      for (int i = 0; i < 3; ++i) corners_[std::size_t(corner_)][i] = number(rest);
      if (in_facet_ && full_) refuse("a facet of more than three corners: export the mesh as triangles");
      if (++corner_ == 3) add_facet(mesh_for(scene_, 0, object_), normal_, corners_), corner_ = 0, full_ = true;
    } else if (word == "endfacet" || word == "endloop") {
      if (corner_ > 0) refuse("a facet of less than three corners");
      if (word == "endfacet") in_facet_ = false;
    } else if (word == "facet") {
      if (corner_ > 0) refuse("a facet of less than three corners");
      normal_ = {}, in_facet_ = true, full_ = false;
    } else if (word == "loop") {
      full_ = false;
    } else if (word != "outer") {
      refuse("unknown word \"" + printable(word) + "\"; STL has facet, normal, outer loop, vertex, endloop, endfacet");
    }
  }

  // Windows writes "-1.#IND" for what is no number: the face has the normal of its corners then.
  double direction(std::string_view& rest) {
    std::string_view after = rest;
    const std::string word = lower(take_word(after));
    if (word.find(".#") == std::string::npos && word.find("nan(") == std::string::npos) return number(rest);
    rest = after;
    return std::numeric_limits<double>::quiet_NaN();
  }

  double number(std::string_view& rest) {
    const std::string_view word = take_word(rest);
    const std::optional<double> value = read_real(word);
    if (!value) refuse("expected a number, found \"" + printable(word) + "\"");
    return *value;
  }

  [[noreturn]] void refuse(const std::string& message) const { refuse_mesh(path_, message, "", lines_.number()); }

  const std::string& path_;
  LineScanner lines_;
  ImportedScene& scene_;
  int object_ = 0, corner_ = 0;
  bool open_ = false, in_facet_ = false, full_ = false;  // full: the loop has its three corners
  Vec3f normal_;
  std::array<Vec3, 3> corners_;
};

bool is_binary(std::string_view bytes) {
  if (bytes.size() < kStlHeader) return false;
  const std::uint64_t size = kStlHeader + kStlFacet * std::uint64_t(number_from<std::uint32_t>(bytes.data() + 80));
  if (bytes.size() == size) return true;
  std::string_view text = skip_byte_order_mark(bytes.substr(0, 512));
  LineScanner lines(text, false);
  while (lines.next() && (trimmed(lines.line()).empty() || is_comment(lines.line()))) continue;
  text = lines.line();
  const std::string_view word = take_word(text);
  if (word != "solid" && word != "SOLID" && word != "Solid") return true;
  return bytes.substr(0, bytes.find_last_not_of(kPadding) + 1).substr(0, 512).find('\0') != std::string_view::npos;
}

}  // namespace

ImportedScene read_stl(const std::string& path) {
  const std::string bytes = read_file(path);
  ImportedScene scene;
  scene.materials.emplace_back();
  scene.materials.back().name = kDefaultMaterial;
  if (is_binary(bytes))
    read_binary(path, bytes, scene);
  else
    TextReader(path, bytes, scene).read();
  // Programs that know no normals write zeros.
  for (ImportedMesh& mesh : scene.meshes)
    if (std::all_of(mesh.normals.begin(), mesh.normals.end(), [](const Vec3f& n) { return n == Vec3f(0, 0, 0); }))
      mesh.normals.clear();
  return scene;
}

}  // namespace rubble
