#include "io/mesh_formats/scene_reader.h"

#include <cmath>
#include <map>

#include "io/mesh_formats/mtl_reader.h"
#include "io/import/polygon.h"
#include "io/base/text_scan.h"
#include "kernel/base/read_file.h"
#include "kernel/base/text.h"

namespace rubble {
namespace {

constexpr const char* kVertex = "vertex";
constexpr std::size_t kMostCorners = std::size_t(1) << 20;  // of one face

class ObjReader {
 public:
  explicit ObjReader(const std::string& path)
      : path_(path), text_(read_file(path)), lines_(text_), materials_(path, scene_) {}

  ImportedScene read() {
    while (lines_.next()) {
      std::string_view rest = lines_.line();
      const std::string_view keyword = take_word(rest);
      if (!keyword.empty() && keyword[0] != '#') read_line(keyword, rest);
    }
    drop_partial_attributes();
    materials_.define_missing(!vertex_colours_.empty());
    return std::move(scene_);
  }

 private:
  // Indices of a corner; -1: none.
  struct Corner {
    std::int64_t position = -1, place = -1, normal = -1;
  };

  void read_line(std::string_view keyword, std::string_view rest) {
    if (keyword == "v") {
      read_vertex(rest);
    } else if (keyword == "vt") {
      const std::array<double, 3> at = read_numbers<3>(rest, 1);
      places_.push_back({float(at[0]), float(at[1])});
    } else if (keyword == "vn") {
      const std::array<double, 3> n = read_numbers<3>(rest, 3);
      normals_.push_back({float(n[0]), float(n[1]), float(n[2])});
    } else if (keyword == "f" || keyword == "fo") {
      read_face(rest);
    } else if (keyword == "o" || keyword == "g") {
      begin_object(keyword == "g", std::string(trimmed(rest)));
    } else if (keyword == "usemtl") {
      material_ = materials_.find(std::string(trimmed(rest)));
    } else if (keyword == "mtllib") {
      materials_.read_libraries(rest);
    } else if (keyword == "l" || keyword == "p") {
      note_once(std::string(keyword == "l" ? "lines" : "points") + " beside its faces are left out");
    } else if (keyword == "curv" || keyword == "curv2" || keyword == "surf") {
      note_once("curves and surfaces of free form are left out: export them as triangles");
    } else if (keyword == "vp" || keyword == "deg" || keyword == "cstype" || keyword == "s" || keyword == "parm" ||
               keyword == "end" || keyword == "trim" || keyword == "hole" || keyword == "scrv" || keyword == "mg" ||
               keyword == "bmat" || keyword == "step" || keyword == "con" || keyword == "sp" || keyword == "lod" ||
               keyword == "bevel" || keyword == "c_interp" || keyword == "d_interp" || keyword == "shadow_obj" ||
               keyword == "trace_obj" || keyword == "ctech" || keyword == "stech" || keyword == "usemap" || keyword == "maplib") {
      return;
    } else {
      note_once("unknown keyword \"" + printable(keyword) + "\" is left out");
    }
  }

  void note_once(const std::string& what) {
    if (noted_.emplace(what, lines_.number()).second)
      scene_.note(what + " (first in line " + std::to_string(lines_.number()) + ")");
  }

  [[noreturn]] void refuse(const std::string& message) const { refuse_mesh(path_, message, "", lines_.number()); }

  // Up to N numbers, at least so many.
  template <std::size_t N>
  std::array<double, N> read_numbers(std::string_view rest, std::size_t least, std::size_t* count = nullptr) {
    std::array<double, N> values{};
    std::size_t n = 0;
    for (std::string_view word = take_word(rest); !word.empty() && word[0] != '#' && n < N; word = take_word(rest)) {
      const std::optional<double> value = read_real(word);
      if (!value) refuse("expected a number, found \"" + printable(word) + "\"");
      values[n++] = *value;
    }
    if (n < least) refuse("expected " + std::to_string(least) + " numbers, found " + std::to_string(n));
    if (count) *count = n;
    return values;
  }

  // x y z, x y z w, or x y z r g b.
  void read_vertex(std::string_view rest) {
    std::size_t count = 0;
    const std::array<double, 7> v = read_numbers<7>(rest, 3, &count);
    Vec3 position(v[0], v[1], v[2]);
    if (count == 4 && v[3] != 1 && v[3] != 0) position = position * (1 / v[3]);
    if (count >= 6) {
      const std::size_t first = count == 6 ? 3 : 4;
      vertex_colours_.resize(positions_.size(), {1, 1, 1});
      vertex_colours_.push_back({float(v[first]), float(v[first + 1]), float(v[first + 2])});
    }
    positions_.push_back(position);
  }

  // `o` goes back to an object of its name; `g` begins a new one.
  void begin_object(bool group, const std::string& name) {
    if (group && name == group_) return;
    if (group) group_ = name;
    const auto found = objects_.find(name);
    if (!group && found != objects_.end()) {
      object_ = found->second;
      return;
    }
    object_ = ++last_object_;
    objects_.emplace(name, object_);
  }

  std::int64_t read_index(std::string_view text, std::size_t count, const char* what) {
    if (text.empty()) return -1;
    const std::optional<std::int64_t> index = read_integer(text);
    if (!index) refuse("expected the number of a " + std::string(what) + ", found \"" + printable(text) + "\"");
    const std::int64_t at = *index > 0 ? *index - 1 : std::int64_t(count) + *index;
    if (*index != 0 && at >= 0 && at < std::int64_t(count)) return at;
    if (what == kVertex)
      refuse("a face names vertex " + std::to_string(*index) + ", and there are " + std::to_string(count));
    note_once("corners without the " + std::string(what) + " that they name have none");
    return -1;
  }

  Corner read_corner(std::string_view word) {
    Corner corner;
    std::size_t slash = word.find('/');
    corner.position = read_index(word.substr(0, slash), positions_.size(), kVertex);
    if (corner.position < 0) refuse("a corner without a vertex: \"" + printable(word) + "\"");
    if (slash == std::string_view::npos) return corner;
    word.remove_prefix(slash + 1);
    slash = word.find('/');
    corner.place = read_index(word.substr(0, slash), places_.size(), "texture coordinate");
    if (slash != std::string_view::npos) corner.normal = read_index(word.substr(slash + 1), normals_.size(), "normal");
    return corner;
  }

  void read_face(std::string_view rest) {
    std::vector<Corner> corners;
    for (std::string_view word = take_word(rest); !word.empty() && word[0] != '#'; word = take_word(rest)) {
      if (corners.size() == kMostCorners) refuse("a face of more than a million corners");
      corners.push_back(read_corner(word));
    }
    if (corners.size() < 3) return note_once("faces of less than three corners are left out");
    std::vector<Vec3> outline;
    for (const Corner& corner : corners) outline.push_back(positions_[std::size_t(corner.position)]);
    ImportedMesh& mesh = mesh_for(scene_, material_ < 0 ? default_material() : material_, object_);
    const auto first = std::uint32_t(mesh.positions.size());
    for (const Corner& corner : corners) add_corner(mesh, corner);
    for (const auto& t : triangulate(outline)) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }

  void add_corner(ImportedMesh& mesh, const Corner& corner) {
    const std::size_t before = mesh.positions.size();
    mesh.positions.push_back(positions_[std::size_t(corner.position)]);
    if (corner.normal >= 0) {
      mesh.normals.resize(before);  // zeros: those of the faces
      mesh.normals.push_back(normals_[std::size_t(corner.normal)]);
    }
    if (corner.place >= 0) {
      if (mesh.uv_sets.empty()) mesh.uv_sets.emplace_back();
      mesh.uv_sets[0].resize(before);
      mesh.uv_sets[0].push_back(places_[std::size_t(corner.place)]);
    }
    if (vertex_colours_.empty()) return;
    mesh.colours.resize(before, {1, 1, 1});
    const auto at = std::size_t(corner.position);
    mesh.colours.push_back(at < vertex_colours_.size() ? vertex_colours_[at] : Vec3f(1, 1, 1));
  }

  // Corners at the end of a mesh may lack what others have.
  void drop_partial_attributes() {
    for (ImportedMesh& mesh : scene_.meshes) {
      if (!mesh.normals.empty()) mesh.normals.resize(mesh.positions.size());
      if (!mesh.colours.empty()) mesh.colours.resize(mesh.positions.size(), {1, 1, 1});
      if (!mesh.uv_sets.empty()) mesh.uv_sets[0].resize(mesh.positions.size());
    }
  }

  int default_material() {
    if (default_ < 0) default_ = materials_.find(kDefaultMaterial);
    return default_;
  }

  const std::string& path_;
  std::string text_;
  LineScanner lines_;
  ImportedScene scene_;
  MtlReader materials_;
  std::vector<Vec3> positions_;
  std::vector<Vec3f> normals_, vertex_colours_;
  std::vector<std::array<float, 2>> places_;
  std::map<std::string, int> objects_, noted_;  // noted: line of the first
  std::string group_;
  int object_ = 0, last_object_ = 0, material_ = -1, default_ = -1;
};

}  // namespace

ImportedScene read_obj(const std::string& path) { return ObjReader(path).read(); }

}  // namespace rubble
