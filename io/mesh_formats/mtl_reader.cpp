#include "io/mesh_formats/mtl_reader.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "io/base/text_scan.h"
#include "kernel/base/error.h"
#include "kernel/base/read_file.h"
#include "kernel/base/system/file_sandbox.h"
#include "kernel/base/text.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

constexpr float kDefaultGrey = 0.6f;  // of a material without Kd
constexpr std::uint64_t kLargestLibrary = std::uint64_t(64) << 20;  // unit: byte

// Keywords whose effect is not drawn, and that every exporter writes: not worth a note.
constexpr std::string_view kSilent[] = {"ka", "illum", "ni", "sharpness", "tf", "km", "ps", "pc", "pcr", "aniso", "anisor",
                                        "map_ka", "map_aat", "pbr"};

// Keywords with numbers: `most` or one of them, from 0 to `largest`.
struct NumberKey {
  std::string_view keyword;
  std::size_t most;
  float largest;
};
constexpr float kAnySize = std::numeric_limits<float>::max();
constexpr NumberKey kNumberKeys[] = {{"kd", 3, 1}, {"ks", 3, 1}, {"ke", 3, kAnySize}, {"ns", 1, kAnySize},
                                     {"pr", 1, 1}, {"pm", 1, 1}, {"d", 1, 1},         {"tr", 1, 1}};
constexpr float kRounding = 1e-3f;  // by which exporters exceed 1

// Options of images that take as many arguments; -o, -s and -t take up to three numbers.
struct Option {
  std::string_view name;
  int arguments;
};
constexpr Option kOptions[] = {{"-blendu", 1}, {"-blendv", 1}, {"-cc", 1},      {"-clamp", 1}, {"-bm", 1},
                               {"-boost", 1},  {"-mm", 2},     {"-texres", 1},  {"-imfchan", 1}, {"-type", 1},
                               {"-colorspace", 1}, {"-o", -3}, {"-s", -3},      {"-t", -3}};

std::string lower(std::string_view word) {
  std::string out(word);
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  return out;
}

std::string quoted(std::string_view text) { return "\"" + printable(text) + "\""; }

std::string without_quotes(std::string_view name) {
  if (name.size() >= 2 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
  return std::string(name);
}

// A comment begins at a word with a '#'. A name may hold one within a word.
std::string_view without_comment(std::string_view rest) {
  for (std::size_t at = rest.find('#'); at != std::string_view::npos; at = rest.find('#', at + 1))
    if (at == 0 || rest[at - 1] == ' ' || rest[at - 1] == '\t') return trimmed(rest.substr(0, at));
  return trimmed(rest);
}

std::string plain_name(std::string_view name) { return without_quotes(without_comment(name)); }

}  // namespace

void MtlReader::read_libraries(std::string_view names) {
  asked_ = true;
  if (read_file_of(without_quotes(trimmed(names))) || read_file_of(plain_name(names))) return;
  std::vector<std::string_view> words = split_words(without_comment(names));
  if (words.size() == 1) words[0] = without_comment(names);
  for (const std::string_view word : words)
    if (!read_file_of(without_quotes(word))) {
      lost_ = true;
      scene_.note("the material file " + printable(without_quotes(word)) +
                  " was not found beside the mesh; its colours are left out");
    }
}

bool MtlReader::read_file_of(const std::string& name) {
  std::string path = name;
  std::replace(path.begin(), path.end(), '\\', '/');
  const fs::path folder = fs::path(path_).parent_path();
  std::error_code failed;
  for (const fs::path& below : {fs::path(path), fs::path(path).filename()}) {
    const fs::path tried = folder / below;
    if (!fs::is_regular_file(tried, failed)) continue;
    check_may_read(tried.string(), {path_, 0, "mtllib", "", "", "", ""});
    library_folder_ = below.has_parent_path() ? below.parent_path().generic_string() + "/" : "";
    try {
      read(name, read_file(tried.string(), kLargestLibrary));
    } catch (const InputError& error) {
      lost_ = true;
      scene_.note("the material file " + printable(name) + " cannot be read: " + error.what());
    }
    return true;
  }
  return false;
}

void MtlReader::read(const std::string& name, const std::string& text) {
  current_ = -1;
  LineScanner lines(text);
  while (lines.next()) {
    std::string_view rest = lines.line();
    const std::string_view keyword = take_word(rest);
    if (keyword.empty() || keyword[0] == '#') continue;
    read_line(keyword, trimmed(rest), printable(name) + ":" + std::to_string(lines.number()));
  }
}

void MtlReader::read_line(std::string_view keyword, std::string_view rest, const std::string& place) {
  const std::string word = lower(keyword);
  if (word == "newmtl") {
    const std::string name(rest);
    const auto [found, is_new] = numbers_.try_emplace(name, int(scene_.materials.size()));
    current_ = found->second;
    defined_.insert(current_);
    ImportedMaterial fresh;
    fresh.name = name, fresh.colour = {kDefaultGrey, kDefaultGrey, kDefaultGrey};
    if (is_new)
      scene_.materials.push_back(fresh);
    else
      scene_.materials[std::size_t(current_)] = fresh;  // the last library that has it counts
    return;
  }
  if (std::find(std::begin(kSilent), std::end(kSilent), word) != std::end(kSilent)) return;
  if (current_ < 0) return scene_.note(place + ": " + quoted(keyword) + " before the first newmtl is left out");
  ImportedMaterial& material = scene_.materials[std::size_t(current_)];
  if (!read_numbers(material, word, rest, place) && !read_image(material, word, rest, place))
    scene_.note(place + ": unknown keyword " + quoted(keyword) + " is left out");
}

// Whether the keyword is one of those with numbers.
bool MtlReader::read_numbers(ImportedMaterial& material, std::string_view keyword, std::string_view rest,
                             const std::string& place) {
  const auto key = std::find_if(std::begin(kNumberKeys), std::end(kNumberKeys),
                                [&](const NumberKey& k) { return k.keyword == keyword; });
  if (key == std::end(kNumberKeys)) return false;
  const std::vector<std::string_view> words = split_words(rest);
  if (!words.empty() && (lower(words[0]) == "spectral" || lower(words[0]) == "xyz"))
    return scene_.note(place + ": " + quoted(keyword) + " by " + quoted(words[0]) + " is left out"), true;
  const float largest = key->largest == kAnySize ? kAnySize : key->largest + kRounding;
  bool good = true;
  std::vector<float> values;
  for (const std::string_view word : words) {
    if (word[0] == '#') break;
    if (keyword == "d" && word == "-halo") continue;
    const std::optional<double> value = read_real(word);
    good = good && value && *value >= 0 && *value <= double(largest);
    values.push_back(good ? float(*value) : 0);
  }
  // One number of a colour means all three.
  if (!good || values.empty() || (values.size() > 1 && values.size() < key->most))
    return scene_.note(place + ": " + quoted(keyword) + " needs " + (key->most == 3 ? "one or three numbers" : "a number") +
                       (key->largest == 1 ? " from 0 to 1" : " of 0 or more") + ", not " + quoted(rest) + "; it is left out"), true;
  if (values.size() > key->most)
    scene_.note(place + ": numbers of " + quoted(keyword) + " beyond the first" + (key->most == 3 ? " three" : "") + " are left out");
  const Vec3f three(values[0], values.size() > 2 ? values[1] : values[0], values.size() > 2 ? values[2] : values[0]);
  if (keyword == "kd") material.colour = three;
  if (keyword == "ks") material.specular = three;
  if (keyword == "ke" && std::max({three.x, three.y, three.z}) > 0)
    material.left_out.push_back("light that surfaces give is not drawn");
  if (keyword == "ns") material.exponent = values[0];
  if (keyword == "pr") material.roughness = values[0];
  if (keyword == "pm") material.metalness = values[0];
  if (keyword == "d") material.opacity = values[0];
  if (keyword == "tr") material.opacity = 1 - values[0];
  return true;
}

// Whether the keyword is one of those with an image.
bool MtlReader::read_image(ImportedMaterial& material, std::string_view keyword, std::string_view rest,
                           const std::string& place) {
  ImportedTexture* texture = nullptr;
  const char* left_out = nullptr;
  if (keyword == "map_kd") texture = &material.albedo;
  else if (keyword == "norm" || keyword == "map_kn") texture = &material.normals;
  else if (keyword == "map_pr") texture = &material.roughness_map;
  else if (keyword == "map_pm") texture = &material.metalness_map;
  else if (keyword == "map_bump" || keyword == "bump" || keyword == "disp" || keyword == "map_disp")
    left_out = "height images are not drawn";
  else if (keyword == "map_ke") left_out = "images of light that surfaces give are not drawn";
  else if (keyword == "map_d" || keyword == "map_tr") left_out = "images of transparency are not drawn";
  else if (keyword == "map_ks" || keyword == "map_ns") left_out = "images of highlights are not drawn";
  else if (keyword == "refl" || keyword == "decal" || keyword == "map_ps") left_out = "images of reflections, decals and sheen are not drawn";
  else return false;
  if (left_out) return material.left_out.push_back(left_out), true;
  TexturePlace where;
  const std::string name = take_options(rest, where, place);
  if (name.empty()) return scene_.note(place + ": " + quoted(keyword) + " names no image"), true;
  texture->image = image_of(name);
  texture->place = where;
  return true;
}

// What is left behind the options: the name, in which there may be blanks.
std::string MtlReader::take_options(std::string_view rest, TexturePlace& where, const std::string& place) {
  rest = trimmed(rest);
  while (!rest.empty() && rest[0] == '-') {
    std::string_view after = rest;
    const std::string word = lower(take_word(after));
    const auto known = std::find_if(std::begin(kOptions), std::end(kOptions), [&](const Option& o) { return o.name == word; });
    if (known == std::end(kOptions)) break;  // a name may begin with a minus
    std::vector<double> numbers;
    for (int i = 0; i < std::abs(known->arguments); ++i) {
      std::string_view behind = after;
      const std::optional<double> value = read_real(take_word(behind));
      if (known->arguments < 0 && (!value || trimmed(behind).empty())) break;  // a name such as "2"
      if (value) numbers.push_back(*value);
      after = behind;
    }
    rest = trimmed(after);
    if (!std::all_of(numbers.begin(), numbers.end(), [](double n) { return std::isfinite(n); })) {
      scene_.note(place + ": the option " + word + " of an image needs finite numbers; it is left out");
      continue;
    }
    if (numbers.size() < 2) numbers.resize(2, word == "-s" ? 1.0 : 0.0);
    if (word == "-o") where.offset = {numbers[0], -numbers[1]};  // upwards in MTL
    if (word == "-s") where.scale = {numbers[0], numbers[1]};
    if ((word == "-clamp" || word == "-t" || word == "-imfchan") && !(word == "-clamp" && after.find("off") == 0))
      scene_.note(place + ": the option " + word + " of an image is left out");
  }
  // v' = o + s v, with v upwards, is 1 - v' = (1 - o - s) + s (1 - v).
  where.offset[1] += 1 - where.scale[1];
  return without_quotes(rest);
}

// The image lies beside its library where there is none of that name beside the mesh.
int MtlReader::image_of(const std::string& written) {
  const fs::path folder = fs::path(path_).parent_path();
  std::string name = written, below = library_folder_ + written;
  std::replace(below.begin(), below.end(), '\\', '/');
  std::error_code failed;
  if (!library_folder_.empty() && !fs::exists(folder / written, failed) && fs::is_regular_file(folder / below, failed))
    name = below;
  for (std::size_t i = 0; i < scene_.images.size(); ++i)
    if (scene_.images[i].name == name) return int(i);
  scene_.images.push_back({name, nullptr, ""});
  return int(scene_.images.size()) - 1;
}

int MtlReader::find(const std::string& name) {
  const auto [found, is_new] = numbers_.try_emplace(name, int(scene_.materials.size()));
  if (is_new) {
    scene_.materials.emplace_back();
    scene_.materials.back().name = name;
    scene_.materials.back().colour = {kDefaultGrey, kDefaultGrey, kDefaultGrey};
  }
  return found->second;
}

void MtlReader::define_missing(bool vertex_colours) {
  for (const auto& [name, number] : numbers_) {
    if (defined_.count(number)) continue;
    ImportedMaterial& material = scene_.materials[std::size_t(number)];
    const auto same = std::find_if(numbers_.begin(), numbers_.end(), [&, &wanted = name](const auto& other) {
      return defined_.count(other.second) && plain_name(other.first) == plain_name(wanted);
    });
    if (same != numbers_.end()) {
      material = scene_.materials[std::size_t(same->second)];
      continue;
    }
    if (vertex_colours) material.colour = {1, 1, 1};
    const auto is_drawn = [of = number](const ImportedMesh& mesh) { return mesh.material == of; };
    if (name != kDefaultMaterial && asked_ && !lost_ && std::any_of(scene_.meshes.begin(), scene_.meshes.end(), is_drawn))
      scene_.note("the material \"" + printable(plain_name(name)) + "\" is in no material file; its colour is left out");
  }
}

}  // namespace rubble
