#include "scripting/packs/asset_pack.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "kernel/base/portable_math.h"
#include "kernel/base/system/file_sandbox.h"
#include "kernel/base/text.h"
#include "scripting/packs/pack_schema.h"
#include "scripting/sandbox/script_file.h"
#include "scripting/schema/override_text.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

constexpr double kWidestBall = 3.1;  // what a ball's limit may be at most; unit: rad

// The shortest turn of one unit vector into another.
Quat turn_between(const Vec3& from, const Vec3& to) {
  const double cosine = dot(from, to);
  if (cosine < -1 + 1e-9) return {0, 0, 1, 0};  // about Y: `from` is X or Z
  const Vec3 axis = cross(from, to);
  return normalized(Quat{1 + cosine, axis.x, axis.y, axis.z});
}

// Angles in radians, the joint's frame from its axis; which link it hangs on is left open.
AssetLink make_asset_link(const LinkTable& table) {
  constexpr double kRadians = portable::kPi / 180;
  const Vec3 rpy = table.rpy_deg * kRadians;
  AssetLink link;
  link.asset = table.asset;
  link.whole_from_link = {portable::quat_from_rpy(rpy.x, rpy.y, rpy.z), table.position};
  link.scale = table.scale;
  JointType& j = link.joint;
  j.kind = table.joint;
  const bool slides = j.kind == JointKind::slider;
  const Vec3 moves = slides ? Vec3{1, 0, 0} : Vec3{0, 0, 1};  // in the joint's frame
  j.assembly_from_joint = {turn_between(moves, normalized(table.joint_axis)),
                           table.joint_position};
  j.stiffness = table.stiffness;
  j.damping = table.damping;
  j.friction = table.friction;
  j.yield = table.yield.value_or(kNever);
  j.break_force = table.break_force.value_or(kNever);
  j.break_torque = table.break_torque.value_or(kNever);
  j.collide = table.collide;
  if (const auto& range = slides ? table.travel : table.limit_deg) {
    const double unit = slides ? 1 : kRadians;
    const bool one = (*range)[0] == (*range)[1];  // a single number
    j.lower = (one ? -std::abs((*range)[0]) : (*range)[0]) * unit;
    j.upper = (one ? std::abs((*range)[1]) : (*range)[1]) * unit;
  }
  if (j.kind == JointKind::ball) {
    j.lower = -kNever;
    if (j.upper < kNever) j.upper = std::min(j.upper, kWidestBall);
  }
  return link;
}

std::string asset_key(std::size_t i, const std::string& name) {
  return "assets[" + std::to_string(i + 1) + "]." + name;
}

Value run_data_script(const SourceFile& script, const std::string& entry, const SourceMap& lines) {
  LuaSandbox sandbox(0, entry);
  Value table = run_script(sandbox, script, lines);
  if (table.kind == Value::Kind::table) return table;
  throw InputError({script.path, lines.line_of(""), "", "the script does not return a table",
                    "return " + entry + " { ... }", describe(table), ""});
}

// Whole path of a file of the pack; notes a mistake when it is not there.
std::string find_file(const fs::path& folder, const std::string& name, const std::string& key,
                      std::vector<Diagnostic>& mistakes) {
  const fs::path path = (folder / name).lexically_normal();
  std::error_code failed;
  if (name.empty() || !fs::is_regular_file(path, failed))
    mistakes.push_back(
        {"", 0, key, "no such file", "a file in " + folder.string(), "\"" + name + "\"", ""});
  else if (auto refused = find_refusal(path.string(), {"", 0, key, "", "", "", ""}))
    mistakes.push_back(std::move(*refused));
  return path.string();
}

const Material* find_material(const std::vector<Material>& materials, const std::string& name) {
  for (const Material& material : materials)
    if (material.name == name) return &material;
  return nullptr;
}

Diagnostic unknown_material(const std::vector<Material>& materials, const std::string& name,
                            const std::string& key) {
  std::vector<std::string> names;
  std::string known;
  for (const Material& material : materials) {
    known += (names.empty() ? "one of " : ", ") + material.name;
    names.push_back(material.name);
  }
  const std::string near = nearest_name(name, names);
  return {"",
          0,
          key,
          "unknown material `" + name + "`",
          near.empty() ? known : "",
          "",
          near.empty() ? "" : "did you mean `" + near + "`?"};
}

class PackBuilder {
 public:
  PackBuilder(const fs::path& folder, const std::vector<Material>& materials,
              const SourceMap& lines, const PackTable& table, std::vector<Diagnostic>& mistakes)
      : folder_(folder), materials_(materials), lines_(lines), mistakes_(mistakes) {
    for (const AssetTable& asset : table.assets)
      if (asset.links.empty()) pieces_.insert(asset.name);
  }

  Asset make_asset(std::size_t i, const AssetTable& from) {
    Asset asset;
    asset.name = from.name;
    asset.line = lines_.line_of("assets[" + std::to_string(i + 1) + "]");
    asset.metres_per_unit = metres_per(from.units);
    asset.up = from.up;
    asset.scale = from.scale;
    asset.spread = from.spread;
    asset.weight = from.weight;
    asset.tags = from.tags;
    asset.decompose = from.parts.empty() && from.word == 1;
    asset.surface_appearance = from.surface_appearance;
    asset.look = from.look;
    asset.look_given = !from.look.empty();
    check_name(i, from.name);
    if (from.links.empty()) {
      find_files(i, from, asset);
      choose_material(i, from, asset);
    } else {
      asset.links = make_links(i, from);
    }
    return asset;
  }

 private:
  void check_name(std::size_t i, const std::string& name) {
    if (const std::string fault = find_name_fault(name); !fault.empty())
      mistakes_.push_back({"", 0, asset_key(i, "name"), "the name " + fault, kNameRule, "\"" + name + "\"",
                           "names of assets become names of files and labels"});
    if (!names_.insert(name).second)
      mistakes_.push_back({"", 0, asset_key(i, "name"), "two assets have the name `" + name + "`",
                           "", "", "rename one of them"});
  }

  void find_files(std::size_t i, const AssetTable& from, Asset& asset) {
    if (from.mesh.empty())
      mistakes_.push_back(
          {"", 0, asset_key(i, "mesh"), "no mesh", "at least one file, or links", "none", ""});
    for (const std::string& name : from.mesh)
      asset.meshes.push_back(find_file(folder_, name, asset_key(i, "mesh"), mistakes_));
    if (!from.parts.empty())
      asset.parts = find_file(folder_, from.parts, asset_key(i, "collision.parts"), mistakes_);
  }

  // What a link names: a piece with a mesh, and a link before it.
  std::vector<AssetLink> make_links(std::size_t i, const AssetTable& from) {
    std::vector<AssetLink> links;
    std::vector<std::string> names;
    const auto complain = [&](std::size_t k, const char* member, const std::string& message,
                              const std::string& expected, const std::string& found) {
      const std::string key = "links[" + std::to_string(k + 1) + "]." + member;
      mistakes_.push_back({"", 0, asset_key(i, key), message, expected, found, ""});
    };
    if (!from.mesh.empty()) {
      mistakes_.push_back({"", 0, asset_key(i, "mesh"), "an asset has a mesh or links, not both", "",
                           "", "give the mesh to an asset of its own and name that in a link"});
    }
    if (from.links.size() < 2 || from.links.size() > kMaxLinks) {
      mistakes_.push_back({"", 0, asset_key(i, "links"), "wrong number of links",
                           "2 to " + std::to_string(kMaxLinks), std::to_string(from.links.size()),
                           ""});
    }
    for (std::size_t k = 0; k < from.links.size(); ++k) {
      const LinkTable& table = from.links[k];
      const std::string name = table.name.empty() ? table.asset : table.name;
      if (std::find(names.begin(), names.end(), name) != names.end()) {
        complain(k, "name", "two links have the name `" + name + "`", "", "");
      }
      if (pieces_.count(table.asset) == 0) {
        complain(k, "asset", "no such piece", "an asset of this pack that has a mesh",
                 "\"" + table.asset + "\"");
      }
      AssetLink link = make_asset_link(table);
      const auto on = std::find(names.begin(), names.end(), table.on);
      if (k == 0 && !table.on.empty()) {
        complain(k, "on", "the first link hangs on nothing", "", "");
      } else if (k > 0 && on == names.end()) {
        complain(k, "on", "a link hangs on one that is listed before it", list_of(names),
                 table.on.empty() ? "nothing" : "\"" + table.on + "\"");
      } else if (k > 0) {
        link.on = link.joint.parent = int(on - names.begin());
        link.joint.child = int(k);
      }
      if (!(norm(table.joint_axis) > 0)) complain(k, "joint_axis", "no direction", "", "");
      if (link.joint.lower > 0 || link.joint.upper < 0) {
        complain(k, table.joint == JointKind::slider ? "travel" : "limit_deg",
                 "the designed pose is out of reach", "least <= 0 <= most", "");
      }
      names.push_back(name);
      links.push_back(link);
    }
    return links;
  }

  static std::string list_of(const std::vector<std::string>& names) {
    std::string text = "one of ";
    for (std::size_t i = 0; i < names.size(); ++i) text += (i ? ", " : "") + names[i];
    return text;
  }

  void choose_material(std::size_t i, const AssetTable& from, Asset& asset) {
    asset.material = from.material;
    const Material* material = find_material(materials_, from.material);
    if (!material)
      return mistakes_.push_back(
          unknown_material(materials_, from.material, asset_key(i, "material")));
    if (asset.look.empty()) asset.look = material->look;
    asset.density = from.density.value_or(material->density);
    asset.friction = from.friction.value_or(material->friction);
  }

  const fs::path& folder_;
  const std::vector<Material>& materials_;
  const SourceMap& lines_;
  std::vector<Diagnostic>& mistakes_;
  std::set<std::string> names_, pieces_;
};

// An asset that was not read whole would only give mistakes that follow from the first.
bool was_read(std::size_t i, const std::vector<Diagnostic>& mistakes) {
  const std::string prefix = "assets[" + std::to_string(i + 1) + "]";
  for (const Diagnostic& d : mistakes)
    if (d.key.rfind(prefix, 0) == 0) return false;
  return true;
}

// Each at the asset that states it. All assets of the table are there.
void note_idle_keys(std::vector<Diagnostic> idle, const std::string& file, const SourceMap& lines, AssetPack& pack) {
  locate(idle, file, lines);
  for (std::size_t i = 0; i < pack.assets.size(); ++i)
    for (const Diagnostic& key : idle)
      if (is_within(key.key, "assets[" + std::to_string(i + 1) + "]")) pack.assets[i].idle_keys.push_back(key.text());
}

}  // namespace

AssetPack load_asset_pack(const std::string& folder, const std::vector<Material>& materials) {
  std::error_code failed;
  if (!fs::is_directory(folder, failed))
    throw InputError({folder, 0, "", "no such folder", "a folder with a pack.lua", "", ""});
  const fs::path root = fs::absolute(folder).lexically_normal();
  const SourceFile script = read_script((fs::path(folder) / "pack.lua").string());
  const SourceMap lines(script.text, "pack");

  PackTable table;
  std::vector<Diagnostic> mistakes;
  std::vector<std::string> stated;
  read_table(make_pack_schema(table), run_data_script(script, "pack", lines), mistakes, &stated);
  add_duplicates(lines, mistakes);
  AssetPack pack{table.name, root.string(), script.path, {}};
  const std::vector<Diagnostic> of_reading = mistakes;
  PackBuilder builder(root, materials, lines, table, mistakes);
  for (std::size_t i = 0; i < table.assets.size(); ++i)
    if (was_read(i, of_reading)) pack.assets.push_back(builder.make_asset(i, table.assets[i]));
  if (mistakes.empty() && table.assets.empty())
    mistakes.push_back({"", 0, "assets", "no assets", "at least one", "an empty list", ""});
  locate(mistakes, script.path, lines);
  throw_if_any(std::move(mistakes));
  note_idle_keys(find_idle_pack_keys(table, stated), script.path, lines, pack);
  return pack;
}

std::vector<Material> load_materials(const std::string& path) {
  const SourceFile script = read_script(path);
  const SourceMap lines(script.text, "materials");
  MaterialTable table;
  std::vector<Diagnostic> mistakes;
  Value wrapped = Value::make_table();
  wrapped.set("materials", run_data_script(script, "materials", lines));
  read_table(make_material_schema(table), wrapped, mistakes);
  for (const SourceMap::Duplicate& twice : lines.duplicates())
    mistakes.push_back({"", 0, "materials" + twice.key, "written twice", "", "",
                        "first on line " + std::to_string(twice.first_line)});
  std::set<std::string> names;
  for (std::size_t i = 0; i < table.materials.size(); ++i)
    if (!names.insert(table.materials[i].name).second)
      mistakes.push_back({"", 0, "materials[" + std::to_string(i + 1) + "].name",
                          "two materials have the name `" + table.materials[i].name + "`", "", "",
                          ""});
  for (Diagnostic& d : mistakes) {
    d.file = script.path;  // the script's own table is the list: "materials[2].name" is "[2].name"
    d.line = lines.line_of(d.key.substr(std::string("materials").size()));
  }
  throw_if_any(std::move(mistakes));
  return table.materials;
}

}  // namespace rubble
