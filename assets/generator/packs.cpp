#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <initializer_list>

#include "assets/generator/asset.h"
#include "assets/generator/car.h"
#include "assets/generator/pieces.h"
#include "assets/generator/polytope.h"
#include "kernel/base/error.h"

namespace rubble::generator {
namespace {

using Family = std::vector<Recipe> (*)();

Pack gather(const std::string& name, std::initializer_list<Family> families) {
  Pack pack{name, {}, {}};
  for (const Family family : families) {
    for (Recipe& recipe : family()) pack.recipes.push_back(std::move(recipe));
  }
  return pack;
}

std::vector<Recipe> cars() {
  return {make_car({"car_roof", 0.34, 0.3, 0.05, 0.05, 0.03, 0.025, 4, false}),
          make_car({"car_front", 0.06, 0.8, 0.0, 0.42, 0.0, 0.02, 4, true}),
          make_car({"car_side", 0.16, -0.2, -0.16, 0.0, 0.34, 0.03, 3, false}),
          make_car({"car_flat", 0.50, 0.0, 0.10, 0.18, 0.10, 0.04, 2, false})};
}

}  // namespace

std::vector<std::string> pack_names() {
  return {"concrete", "residential", "parking", "bridge", "victims"};
}

Pack make_pack(const std::string& name) {
  if (name == "concrete") {
    Pack pack = gather(name, {masonry_pieces, chunk_pieces, slab_pieces, frame_pieces, hollow_pieces,
                              concrete_fragments, rebar_pieces, facade_pieces});
    pack.articulated = articulated_concrete();
    return pack;
  }
  if (name == "residential") {
    Pack pack = gather(
        name, {timber_pieces, drywall_pieces, joinery_pieces, furniture_pieces, door_frames});
    pack.articulated = articulated_residential();
    return pack;
  }
  if (name == "parking") {
    Pack pack = gather(name, {cars, parking_concrete, guard_pieces, open_cars});
    pack.articulated = articulated_parking();
    return pack;
  }
  if (name == "bridge") return gather(name, {bridge_concrete, bridge_steel});
  if (name == "victims") return gather(name, {victim_pieces});
  throw RunError("there is no bundled pack " + name);
}

namespace {

// Fixed-point text without a trailing point, through integers: the same on every machine.
void put_number(std::string& text, double value, int decimals) {
  double scale = 1;
  for (int i = 0; i < decimals; ++i) scale *= 10;
  auto units = static_cast<std::int64_t>(std::floor(std::fabs(value) * scale + 0.5));
  std::string digits = std::to_string(units);
  if (static_cast<int>(digits.size()) <= decimals) {
    digits.insert(0, static_cast<std::size_t>(decimals) + 1 - digits.size(), '0');
  }
  digits.insert(digits.size() - static_cast<std::size_t>(decimals), ".");
  while (digits.back() == '0') digits.pop_back();
  if (digits.back() == '.') digits.pop_back();
  if (value < 0 && units != 0) text += '-';
  text += digits;
}

void put_vector(std::string& text, const char* keyword, const Vec3& v, int decimals) {
  text += keyword;
  for (int i = 0; i < 3; ++i) {
    text += ' ';
    put_number(text, v[i], decimals);
  }
  text += '\n';
}

std::string mesh_text(const TriangleMesh& mesh, const std::string& name) {
  std::string text = "mtllib pack.mtl\no " + name + "\n";
  for (const Vec3f& p : mesh.positions) put_vector(text, "v", Vec3(p), 5);
  for (const Vec3f& n : mesh.normals) put_vector(text, "vn", Vec3(n), 3);
  int surface = -1;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.surfaces[t] != surface) {
      surface = mesh.surfaces[t];
      text += "usemtl " + mesh.surface_names[static_cast<std::size_t>(surface)] + "\n";
    }
    text += 'f';
    for (const std::uint32_t v : mesh.triangles[t]) {
      const std::string number = std::to_string(v + 1);
      text += " " + number + "//" + number;
    }
    text += '\n';
  }
  return text;
}

std::string parts_text(const std::vector<std::vector<Vec3>>& parts) {
  std::string text;
  std::size_t first = 1;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    text += "o part_" + std::to_string(i) + "\n";
    for (const Vec3& p : parts[i]) put_vector(text, "v", p, 5);
    for (const Polygon& face : hull_faces(parts[i])) {
      for (std::size_t k = 2; k < face.corners.size(); ++k) {
        text += 'f';
        for (const int c : {face.corners[0], face.corners[k - 1], face.corners[k]}) {
          text += ' ' + std::to_string(first + static_cast<std::size_t>(c));
        }
        text += '\n';
      }
    }
    first += parts[i].size();
  }
  return text;
}

// Colours for programs that know nothing of our surfaces; ours goes by the names.
std::string material_text() {
  static const char* const kColours[kSurfaceCount] = {
      "0.62 0.61 0.58", "0.55 0.53 0.50", "0.55 0.27 0.20", "0.60 0.33 0.25",
      "0.50 0.50 0.49", "0.36 0.22 0.15", "0.60 0.62 0.64", "0.40 0.27 0.20",
      "0.58 0.44 0.29", "0.70 0.56 0.38", "0.80 0.78 0.73", "0.85 0.84 0.82",
      "0.30 0.34 0.42", "0.35 0.40 0.40", "0.45 0.42 0.38", "0.05 0.05 0.05",
      "0.80 0.78 0.73"};
  std::string text;
  for (int s = 0; s < kSurfaceCount; ++s) {
    text += std::string("newmtl ") + surface_name(static_cast<Surface>(s)) + "\nKd " + kColours[s] +
            "\n";
  }
  return text;
}

std::string tags_text(const std::vector<std::string>& tags) {
  std::string text = "{";
  for (std::size_t i = 0; i < tags.size(); ++i) text += (i ? ", \"" : "\"") + tags[i] + "\"";
  return text + "}";
}

std::string articulated_text(const ArticulatedRecipe& r) {
  std::string text = "    { name = \"" + r.name + "\",\n      links = {\n";
  for (const std::string& link : r.links) text += "        { " + link + " },\n";
  text += "      },\n      scale = {";
  put_number(text, r.scale_min, 3);
  text += ", ";
  put_number(text, r.scale_max, 3);
  text += "},\n      weight = ";
  put_number(text, r.weight, 3);
  return text + ",\n      tags = " + tags_text(r.tags) + ",\n    },\n";
}

std::string asset_text(const Asset& asset) {
  const Recipe& r = asset.recipe;
  std::string text = "    {\n      name = \"" + r.name + "\",\n      mesh = {";
  for (std::size_t i = 0; i < asset.levels.size(); ++i) {
    text += (i ? ", \"" : "\"") + r.name + ".lod" + std::to_string(i) + ".obj\"";
  }
  text += "},\n      units = \"m\",\n      up = \"z\",\n      collision = { parts = \"" + r.name +
          ".parts.obj\" },\n      material = \"" + r.material + "\",\n";
  if (r.density > 0) {
    text += "      density = ";
    put_number(text, r.density, 1);
    text += ",\n";
  }
  text += "      scale = {";
  put_number(text, r.scale_min, 3);
  text += ", ";
  put_number(text, r.scale_max, 3);
  text += "},\n      weight = ";
  put_number(text, r.weight, 3);
  return text + ",\n      tags = " + tags_text(r.tags) + ",\n    },\n";
}

void write_file(const std::filesystem::path& path, const std::string& text) {
  const std::filesystem::path temporary = path.string() + ".part";
  std::ofstream file(temporary, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw RunError("cannot write " + temporary.string());
  std::filesystem::rename(temporary, path);
}

}  // namespace

void write_pack(const Pack& pack, const std::string& folder) {
  const std::filesystem::path root(folder);
  std::filesystem::create_directories(root);
  std::string lua =
      "-- Made by rubble_make_assets; see assets/README.md.\nreturn pack {\n  name = \"" +
      pack.name + "\",\n  assets = {\n";
  for (const Recipe& recipe : pack.recipes) {
    const Asset asset = make_asset(recipe);
    for (std::size_t i = 0; i < asset.levels.size(); ++i) {
      write_file(root / (recipe.name + ".lod" + std::to_string(i) + ".obj"),
                 mesh_text(asset.levels[i], recipe.name));
    }
    write_file(root / (recipe.name + ".parts.obj"), parts_text(asset.parts));
    lua += asset_text(asset);
  }
  for (const ArticulatedRecipe& recipe : pack.articulated) lua += articulated_text(recipe);
  write_file(root / "pack.mtl", material_text());
  write_file(root / "pack.lua", lua + "  },\n}\n");  // last: a pack with pack.lua is complete
}

}  // namespace rubble::generator
