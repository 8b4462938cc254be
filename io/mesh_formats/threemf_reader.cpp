#include "io/mesh_formats/scene_reader.h"

#include <algorithm>
#include <map>

#include "io/base/compressed_file.h"
#include "io/base/srgb.h"
#include "io/base/text_scan.h"
#include "kernel/base/read_file.h"
#include "kernel/base/text.h"

namespace rubble {
namespace {

constexpr std::uint64_t kLargestPart = std::uint64_t(1) << 30;  // unit: byte
constexpr int kDeepestComponent = 100;
constexpr std::size_t kMostItems = 100000;
constexpr char kSpaces[] = "http://schemas.microsoft.com/3dmanufacturing/";
constexpr std::string_view kKnownSpaces[] = {"core/", "material/", "production/"};

// Points are rows: (x y z 1) times a matrix of four rows.
struct RowMatrix {
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, shift;

  Vec3 operator*(const Vec3& p) const { return x * p.x + y * p.y + z * p.z + shift; }
  Vec3 turn(const Vec3& p) const { return x * p.x + y * p.y + z * p.z; }
  RowMatrix operator*(const RowMatrix& b) const { return {turn(b.x), turn(b.y), turn(b.z), *this * b.shift}; }
  bool mirrors() const { return dot(x, cross(y, z)) < 0; }
};

struct Component {
  std::string part, object;  // part: the file in the package
  RowMatrix place;
};

struct PackageObject {
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<int> materials;  // by triangle; -1: none
  std::vector<Component> components;
  bool is_shape = true;  // no support, and no other helper of printing
};

class ThreemfReader {
 public:
  explicit ThreemfReader(const std::string& path) : path_(path), archive_(read_file(path)), entries_(list_zip(archive_)) {
    if (entries_.empty()) refuse_mesh(path, "is no 3MF file: expected a ZIP archive");
  }

  ImportedScene read() {
    read_part(find_root());
    for (const Component& item : items_) add(item, {}, 0);
    if (items_.empty()) refuse_mesh(path_, "holds no triangles: its <build> has no item");
    return std::move(scene_);
  }

 private:
  static std::string without_slash(const std::string& name) { return !name.empty() && name[0] == '/' ? name.substr(1) : name; }

  std::optional<std::string> read_entry(const std::string& name) const {
    for (const ZipEntry& entry : entries_)
      if (entry.name == name) return read_zip_entry(archive_, entry, kLargestPart);
    return std::nullopt;
  }

  // The part that the package names as its model.
  std::string find_root() const {
    const std::optional<std::string> relations = read_entry("_rels/.rels");
    if (relations) {
      XmlScanner xml(*relations);
      while (xml.next())
        if (xml.name() == "Relationship" && xml.attribute("Type").find("/3dmodel") != std::string::npos)
          return without_slash(xml.attribute("Target"));
    }
    return "3D/3dmodel.model";
  }

  [[noreturn]] void refuse(const std::string& part, const XmlScanner& xml, const std::string& message) const {
    refuse_mesh(path_, printable(part) + ":" + std::to_string(xml.line()) + ": " + message);
  }

  double number(const std::string& part, const XmlScanner& xml, std::string_view name) const {
    const std::string text = xml.attribute(name);
    const std::optional<double> value = read_real(trimmed(text));
    if (!value) refuse(part, xml, "<" + printable(xml.name()) + "> needs a number as " + std::string(name) + ", found \"" + printable(text) + "\"");
    return *value;
  }

  RowMatrix transform(const std::string& part, const XmlScanner& xml) const {
    const std::string text = xml.attribute("transform");
    if (text.empty()) return {};
    double m[12] = {};
    const std::vector<std::string_view> words = split_words(text);
    for (std::size_t i = 0; i < 12; ++i) {
      const std::optional<double> value = i < words.size() ? read_real(words[i]) : std::nullopt;
      if (!value) refuse(part, xml, "a transform needs 12 numbers, found \"" + printable(text) + "\"");
      m[i] = *value;
    }
    return {{m[0], m[1], m[2]}, {m[3], m[4], m[5]}, {m[6], m[7], m[8]}, {m[9], m[10], m[11]}};
  }

  void check_extensions(const std::string& part, const XmlScanner& xml) {
    const std::string required = xml.attribute("requiredextensions");
    for (const std::string_view prefix : split_words(required)) {
      const std::string space = xml.attribute("xmlns:" + std::string(prefix));
      const bool known = std::any_of(std::begin(kKnownSpaces), std::end(kKnownSpaces), [&](std::string_view kind) {
        return space.compare(0, sizeof kSpaces - 1 + kind.size(), kSpaces + std::string(kind)) == 0;
      });
      if (!known)
        refuse_mesh(path_, printable(part) + ": requires the 3MF extension \"" + printable(prefix) + "\" (" + printable(space) +
                               "), which is not known", "export plain 3MF, STL or glTF");
    }
    const std::string unit = xml.attribute("unit");
    if (!unit.empty() && unit != "millimeter") scene_.note("its unit is " + printable(unit) + ": set `units` accordingly");
  }

  // Reads objects and materials of a part once; items of the build count in the root alone.
  void read_part(const std::string& part) {
    if (!parts_.emplace(part, true).second) return;
    const bool is_root = parts_.size() == 1;
    const std::optional<std::string> text = read_entry(part);
    if (!text) refuse_mesh(path_, "the part " + printable(part) + " is missing in the package, or damaged");
    XmlScanner xml(*text);
    PackageObject* object = nullptr;
    std::string group, object_material, object_index;
    while (xml.next()) {
      std::string_view name = xml.name();
      name.remove_prefix(name.find(':') == std::string_view::npos ? 0 : name.find(':') + 1);
      if (xml.closes()) {
        if (name == "object") object = nullptr;
        continue;
      }
      if (name == "model") check_extensions(part, xml);
      if (name == "basematerials" || name == "colorgroup") group = part + "#" + xml.attribute("id");
      if (name == "base") add_material(group, xml.attribute("displaycolor"), xml.attribute("name"));
      if (name == "color") add_material(group, xml.attribute("color"), "");
      if (name == "texture2dgroup") scene_.note("images of 3MF files are not drawn");
      if (name == "compositematerials" || name == "multiproperties")
        scene_.note("the mixed colours of its <" + std::string(name) + "> are not drawn");
      if (name.size() > 17 && name.substr(name.size() - 17) == "displayproperties")
        scene_.note("its <" + std::string(name) + ">, which say how surfaces shine, are left out");
      if (name == "beamlattice" || name == "slicestack") scene_.note("the <" + printable(xml.name()) + "> is left out: its triangles are read");
      if (name == "object") {
        object = &objects_[part + "#" + xml.attribute("id")];
        const std::string type = xml.attribute("type");
        object->is_shape = type.empty() || type == "model" || type == "solidsupport" || type == "surface";
        object_material = part + "#" + xml.attribute("pid"), object_index = xml.attribute("pindex");
      }
      if (name == "vertex" && object)
        object->positions.push_back({number(part, xml, "x"), number(part, xml, "y"), number(part, xml, "z")});
      if (name == "triangle" && object) add_triangle(part, xml, object_material, object_index, *object);
      if (name == "component" && object) object->components.push_back(read_component(part, xml));
      if (name == "item" && is_root) items_.push_back(read_component(part, xml));
    }
  }

  Component read_component(const std::string& part, const XmlScanner& xml) const {
    Component component{part, xml.attribute("objectid"), transform(part, xml)};
    for (const auto& [name, value] : xml.attributes())
      if (name.size() > 5 && name.substr(name.size() - 5) == ":path") component.part = without_slash(xml.attribute(name));
    return component;
  }

  void add_triangle(const std::string& part, const XmlScanner& xml, const std::string& group, const std::string& index,
                    PackageObject& object) {
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string name = "v" + std::to_string(k + 1), text = xml.attribute(name);
      const std::optional<std::int64_t> corner = read_integer(text);
      if (!corner || *corner < 0 || *corner >= std::int64_t(object.positions.size()))
        refuse(part, xml, "a triangle names the vertex \"" + printable(text) + "\", and there are " + std::to_string(object.positions.size()));
      triangle[k] = std::uint32_t(*corner);
    }
    object.triangles.push_back(triangle);
    const std::string pid = xml.attribute("pid"), first = xml.attribute("p1");
    const auto own = materials_.find((pid.empty() ? group : part + "#" + pid) + "#" + (first.empty() ? index : first));
    object.materials.push_back(own == materials_.end() ? -1 : own->second);
    for (const auto& [attribute, value] : xml.attributes()) {
      const std::string_view name = attribute;
      if (name == "paint_color" || (name.size() > 17 && name.substr(name.size() - 17) == ":mmu_segmentation"))
        scene_.note("colours that a slicer painted on triangles are not drawn");
    }
    for (const char* other : {"p2", "p3"})
      if (!xml.attribute(other).empty() && xml.attribute(other) != first) scene_.note("colours that vary over a triangle are drawn as that of its first corner");
  }

  static bool is_colour(const std::string& text) {
    return (text.size() == 7 || text.size() == 9) && text[0] == '#' &&
           text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
  }

  // "#RRGGBB" or "#RRGGBBAA", sRGB.
  void add_material(const std::string& group, const std::string& colour, const std::string& name) {
    const int number = counts_[group]++;
    ImportedMaterial material;
    if (!is_colour(colour)) scene_.note("the colour \"" + printable(colour) + "\" is none: expected #RRGGBB or #RRGGBBAA");
    material.name = name.empty() ? colour : name;
    const auto byte = [&colour](std::size_t at) {
      const std::size_t high = std::string("0123456789abcdef").find(char(std::tolower(colour[at]))),
                        low = std::string("0123456789abcdef").find(char(std::tolower(colour[at + 1])));
      return double(high * 16 + low);
    };
    if (is_colour(colour))
      for (int i = 0; i < 3; ++i) material.colour[i] = float(linear_from_srgb(byte(1 + 2 * std::size_t(i)) / 255));
    if (is_colour(colour) && colour.size() == 9) material.opacity = float(byte(7) / 255);
    materials_[group + "#" + std::to_string(number)] = int(scene_.materials.size());
    scene_.materials.push_back(std::move(material));
  }

  void add(const Component& component, const RowMatrix& outer, int depth) {
    read_part(component.part);
    const auto found = objects_.find(component.part + "#" + component.object);
    if (found == objects_.end()) refuse_mesh(path_, printable(component.part) + ": there is no object \"" + printable(component.object) + "\"");
    if (depth > kDeepestComponent || ++placed_ > kMostItems) refuse_mesh(path_, "its components are nested without end, or are too many");
    const PackageObject& object = found->second;
    if (!object.is_shape) return scene_.note("supports and other helpers of printing are left out");
    const RowMatrix place = outer * component.place;
    if (!object.triangles.empty()) add_mesh(object, place);
    for (const Component& inner : object.components) add(inner, place, depth + 1);
  }

  void add_mesh(const PackageObject& object, const RowMatrix& place) {
    ++object_;
    for (std::size_t t = 0; t < object.triangles.size(); ++t) {
      ImportedMesh& mesh = mesh_for(scene_, object.materials[t] < 0 ? default_material() : object.materials[t], object_);
      if (mesh.positions.empty())
        for (const Vec3& p : object.positions) mesh.positions.push_back(place * p);
      const auto& v = object.triangles[t];
      mesh.triangles.push_back(place.mirrors() ? std::array<std::uint32_t, 3>{v[2], v[1], v[0]} : v);
    }
  }

  int default_material() {
    const auto [found, is_new] = materials_.try_emplace("default", int(scene_.materials.size()));
    if (is_new) scene_.materials.emplace_back().name = kDefaultMaterial;
    return found->second;
  }

  const std::string& path_;
  std::string archive_;
  std::vector<ZipEntry> entries_;
  ImportedScene scene_;
  std::map<std::string, bool> parts_;             // that are read
  std::map<std::string, PackageObject> objects_;  // by part and id
  std::map<std::string, int> materials_, counts_;
  std::vector<Component> items_;
  std::size_t placed_ = 0;
  int object_ = 0;
};

}  // namespace

ImportedScene read_3mf(const std::string& path) { return ThreemfReader(path).read(); }

}  // namespace rubble
