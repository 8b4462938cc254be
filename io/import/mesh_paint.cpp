#include "io/import/mesh_paint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "io/base/srgb.h"
#include "io/image/picture_decoder.h"
#include "io/import/uri.h"
#include "kernel/base/error.h"
#include "kernel/base/hash.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/read_file.h"
#include "kernel/base/system/file_sandbox.h"
#include "kernel/base/text.h"

namespace rubble {

// Empty where it cannot be had.
struct MeshPaints::Image {
  RgbaImage pixels;
  std::string sha256;  // of the file: another decoder may round otherwise
};

namespace {

namespace fs = std::filesystem;

constexpr float kGlossOfPlastics = 0.04f;  // reflectance of refractive index 1.5, as glTF takes it for all
constexpr std::uint64_t kLargestFile = std::uint64_t(256) << 20;  // of an image; unit: byte
// One factor that an exporter may write on purpose is darker: OBJ files with images often say black.
constexpr float kBlack = 1e-3f;
constexpr float kSameGrey = 0.02f;

Vec3f colour_of(const ImportedMaterial& material) {
  const auto share = [](float x) { return x > 0 ? std::min(x, 1.0f) : 0.0f; };  // also of what is no number
  return {share(material.colour.x), share(material.colour.y), share(material.colour.z)};
}

bool is_same_grey(const Vec3f& a, const Vec3f& b) {
  return std::max({a.x, a.y, a.z, b.x, b.y, b.z}) - std::min({a.x, a.y, a.z, b.x, b.y, b.z}) < kSameGrey;
}

bool is_seen_through(const RgbaImage& image) {
  for (std::size_t i = 3; i < image.rgba.size(); i += 4)
    if (image.rgba[i] < 128) return true;
  return false;
}

// The placement of a material's images: that of the first one it has.
const TexturePlace& place_of(const ImportedMaterial& material) {
  for (const ImportedTexture* texture : {&material.albedo, &material.roughness_map, &material.metalness_map, &material.normals})
    if (texture->image >= 0) return texture->place;
  return material.albedo.place;
}

std::array<float, 2> apply_place(const TexturePlace& place, const std::array<float, 2>& at) {
  if (!place.moved()) return at;
  const auto [s, c] = portable::sincos(place.rotation);
  const double u = double(at[0]) * place.scale[0], v = (1 - double(at[1])) * place.scale[1];  // v downwards
  return {float(c * u + s * v + place.offset[0]), float(1 - (-s * u + c * v + place.offset[1]))};
}

// A picture as floats from 0 to 1, colours decoded to linear light if asked: what may be averaged.
class Averaged {
 public:
  Averaged(const RgbaImage& image, bool decode) : image_(image) {
    for (int i = 0; i < 256; ++i) table_[std::size_t(i)] = decode ? float(linear_from_srgb(i / 255.0)) : float(i) / 255;
  }
  // The mean over a rectangle of the picture, by as many places as it has pixels.
  std::array<float, 4> mean(double x0, double x1, double y0, double y1) const {
    const int across = std::max(1, int(std::ceil(x1 - x0))), down = std::max(1, int(std::ceil(y1 - y0)));
    std::array<float, 4> sum{};
    for (int j = 0; j < down; ++j)
      for (int i = 0; i < across; ++i) {
        const auto at = between(x0 + (x1 - x0) * (i + 0.5) / across, y0 + (y1 - y0) * (j + 0.5) / down);
        for (std::size_t c = 0; c < 4; ++c) sum[c] += at[c] / float(across * down);
      }
    return sum;
  }

 private:
  std::array<float, 4> between(double x, double y) const {
    const double fx = std::floor(x - 0.5), fy = std::floor(y - 0.5);
    const auto a = float(x - 0.5 - fx), b = float(y - 0.5 - fy);
    const int x0 = wrap(int(fx), image_.width), x1 = wrap(int(fx) + 1, image_.width);
    const int y0 = wrap(int(fy), image_.height), y1 = wrap(int(fy) + 1, image_.height);
    std::array<float, 4> out;
    for (std::size_t c = 0; c < 4; ++c) {
      const float top = value(x0, y0, c) * (1 - a) + value(x1, y0, c) * a;
      const float bottom = value(x0, y1, c) * (1 - a) + value(x1, y1, c) * a;
      out[c] = top * (1 - b) + bottom * b;
    }
    return out;
  }
  static int wrap(int i, int size) { return (i % size + size) % size; }
  float value(int x, int y, std::size_t c) const {
    return table_[image_.rgba[(std::size_t(y) * std::size_t(image_.width) + std::size_t(x)) * 4 + c]];
  }

  const RgbaImage& image_;
  std::array<float, 256> table_{};
};

int side_for(const RgbaImage& image) {
  int side = 1;
  while (side < std::max(image.width, image.height) && side < kLargestPaint) side *= 2;
  return image.rgba.empty() ? 0 : side;
}

// Calls put(texel, mean of the picture there) for each texel of a square of this side.
template <typename Put>
void fill(const RgbaImage& image, bool decode, int side, const Put& put) {
  const Averaged source(image, decode);
  const double dx = double(image.width) / side, dy = double(image.height) / side;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      put(std::size_t(y) * std::size_t(side) + std::size_t(x),
          source.mean(x * dx, (x + 1) * dx, y * dy, (y + 1) * dy));
}

std::uint8_t to_byte(float x) { return std::uint8_t(std::clamp(x, 0.0f, 1.0f) * 255 + 0.5f); }

PaintImage make_albedo(const RgbaImage& image) {
  PaintImage out{side_for(image), {}};
  const bool as_it_is = image.width == out.side && image.height == out.side;
  if (as_it_is || out.side == 0) return {out.side, image.rgba};
  out.texels.assign(std::size_t(out.side) * std::size_t(out.side) * 4, 255);
  fill(image, true, out.side, [&](std::size_t i, const std::array<float, 4>& mean) {
    for (std::size_t c = 0; c < 3; ++c) out.texels[4 * i + c] = srgb8_from_linear(double(mean[c]));
  });
  return out;
}

// glTF has roughness in green and metalness in blue; grey pictures have them there, too.
PaintImage make_relief(const RgbaImage* normals, const RgbaImage* roughness, const RgbaImage* metalness) {
  int side = 0;
  for (const RgbaImage* image : {normals, roughness, metalness})
    if (image) side = std::max(side, side_for(*image));
  PaintImage out{side, {}};
  for (std::size_t i = 0; i < std::size_t(side) * std::size_t(side); ++i)
    out.texels.insert(out.texels.end(), {128, 128, 255, 255});
  const auto take = [&](const RgbaImage* image, std::size_t from, std::size_t to, std::size_t count) {
    if (!image || image->rgba.empty()) return;
    fill(*image, false, side, [&](std::size_t i, const std::array<float, 4>& mean) {
      for (std::size_t c = 0; c < count; ++c) out.texels[4 * i + to + c] = to_byte(mean[from + c]);
    });
  };
  take(normals, 0, 0, 2), take(roughness, 1, 2, 1), take(metalness, 2, 3, 1);
  return out;
}

}  // namespace

MeshPaints::MeshPaints(const ImportedScene& scene, const std::string& path)
    : scene_(scene), mesh_path_(path), folder_(fs::path(path).parent_path().string()) {
  std::vector<Vec3f> colours;
  for (const ImportedMesh& mesh : scene.meshes) {
    if (mesh.triangles.empty()) continue;
    any_ = any_ || !mesh.colours.empty();
    if (mesh.material < 0) continue;
    const ImportedMaterial& material = scene.materials[std::size_t(mesh.material)];
    any_ = any_ || material.albedo.image >= 0;
    colours.push_back(colour_of(material));
    any_ = any_ || !is_same_grey(colours.front(), colours.back());
  }
}

std::shared_ptr<const SurfacePaint> MeshPaints::of(int material) {
  if (!any_) return nullptr;
  const auto [found, is_new] = paints_.try_emplace(material);
  if (is_new) {
    SurfacePaint paint;
    paint.sha256 = sha256("plain");
    if (material >= 0) paint = read(scene_.materials[std::size_t(material)]);
    found->second = std::make_shared<const SurfacePaint>(std::move(paint));
  }
  return found->second;
}

PaintCorner MeshPaints::corner(const ImportedMesh& mesh, std::uint32_t vertex) {
  PaintCorner out;
  TexturePlace place;
  if (mesh.material >= 0) place = place_of(scene_.materials[std::size_t(mesh.material)]);
  const std::size_t set = place.uv_set < mesh.uv_sets.size() && !mesh.uv_sets[place.uv_set].empty() ? place.uv_set : 0;
  if (set < mesh.uv_sets.size() && !mesh.uv_sets[set].empty()) {
    const std::array<float, 2> at = apply_place(place, mesh.uv_sets[set][vertex]);
    if (std::isfinite(at[0]) && std::isfinite(at[1])) out.u = at[0], out.v = at[1];
  }
  if (!mesh.colours.empty()) {
    const Vec3f& c = mesh.colours[vertex];
    if (!std::isfinite(c.x) || !std::isfinite(c.y) || !std::isfinite(c.z)) {
      note("colours of vertices that are not numbers are drawn white");
      return out;
    }
    const auto part = [this](float x) {
      const float share = x > 0 ? std::min(x, 1.0f) : 0.0f;
      return scene_.linear_colours ? share : float(linear_from_srgb(double(share)));
    };
    out.colour = {part(c.x), part(c.y), part(c.z)};
  }
  return out;
}

SurfacePaint MeshPaints::read(const ImportedMaterial& material) {
  SurfacePaint paint;
  paint.colour = colour_of(material);
  const Image* albedo = find(material, material.albedo, "colours");
  if (albedo) {
    paint.albedo = make_albedo(albedo->pixels);
    if (material.alpha_of_image && is_seen_through(albedo->pixels)) note("transparent parts of images are drawn opaque");
    if (std::max({paint.colour.x, paint.colour.y, paint.colour.z}) < kBlack) paint.colour = {1, 1, 1};
  }
  read_gloss(material, paint);
  const Image* normals = find(material, material.normals, "normals");
  const Image* roughness = find(material, material.roughness_map, "roughness");
  const Image* metalness = find(material, material.metalness_map, "metal");
  const auto pixels = [](const Image* image) { return image ? &image->pixels : nullptr; };
  paint.relief = make_relief(pixels(normals), pixels(roughness), pixels(metalness));
  for (const std::string& clause : material.left_out) note(clause);
  if (material.opacity < 0.99f && material.opacity > 0) note("transparent materials are drawn opaque");
  Sha256 hash;
  for (const float x : {paint.colour.x, paint.colour.y, paint.colour.z, paint.roughness, paint.metalness,
                        paint.reflectance})
    hash.add(&x, sizeof x);
  for (const Image* image : {albedo, normals, roughness, metalness}) {
    const std::string content = image ? image->sha256 : "none";
    hash.add(content.data(), content.size());
  }
  const TexturePlace& place = place_of(material);
  if (place.moved()) {
    hash.add(place.offset.data(), sizeof place.offset), hash.add(place.scale.data(), sizeof place.scale);
    hash.add(&place.rotation, sizeof place.rotation);
  }
  if (place.uv_set != 0) hash.add(&place.uv_set, sizeof place.uv_set);
  paint.sha256 = hash.hex();
  return paint;
}

// Metal and roughness where the file says them; otherwise an OBJ's highlight: exponents of Phong's become
// alpha = sqrt(2 / (n + 2)) (Walter et al. 2007).
void MeshPaints::read_gloss(const ImportedMaterial& material, SurfacePaint& paint) const {
  const Vec3f& specular = material.specular;
  const bool shines = std::max({specular.x, specular.y, specular.z}) > kBlack && material.exponent > 1;
  if (!material.roughness && !material.metalness && !shines) return;
  float roughness = material.roughness.value_or(1);
  if (!material.roughness && shines) roughness = std::sqrt(std::sqrt(2 / (material.exponent + 2)));
  const float metalness = material.metalness.value_or(0);
  paint.reflectance = kGlossOfPlastics;
  paint.roughness = roughness >= 0 && roughness <= 1 ? roughness : 1;
  paint.metalness = metalness >= 0 && metalness <= 1 ? metalness : 0;
}

// Null where the material has none, or it cannot be had.
const MeshPaints::Image* MeshPaints::find(const ImportedMaterial& material, const ImportedTexture& texture,
                                          const char* what) {
  if (texture.image < 0) return nullptr;
  const ImportedImage& source = scene_.images[std::size_t(texture.image)];
  const std::string shown = source.name.empty() ? std::to_string(texture.image) : printable(source.name);
  const std::string of_material = " of the material \"" + printable(material.name) + "\"";
  if (!(texture.place == place_of(material))) {
    note("the image " + shown + " with the " + what + of_material + " is left out: it lies otherwise on the surface " +
         "(texture coordinates or transform) than its other images");
    return nullptr;
  }
  for (const ImportedMesh& mesh : scene_.meshes) {
    if (mesh.triangles.empty() || mesh.material < 0 || &scene_.materials[std::size_t(mesh.material)] != &material) continue;
    if (texture.place.uv_set < mesh.uv_sets.size() && !mesh.uv_sets[texture.place.uv_set].empty()) continue;
    note("the image " + shown + of_material + " lies by texture coordinates (set " + std::to_string(texture.place.uv_set) +
         ") that its mesh does not have");
    break;
  }
  const auto [found, is_new] = images_.try_emplace(texture.image);
  if (is_new) found->second = std::make_shared<const Image>(load(source));
  return found->second->pixels.rgba.empty() ? nullptr : found->second.get();
}

MeshPaints::Image MeshPaints::load(const ImportedImage& image) {
  std::string shown = printable(image.name);
  try {
    if (image.bytes) shown += " in the file";
    if (!image.fault.empty()) throw RunError(image.fault);
    if (image.bytes) return {decode_picture(*image.bytes), sha256(*image.bytes)};
    const auto found = find_beside(folder_, image.name, "textures");
    if (!found) throw RunError("lies neither beside the mesh nor in its folder textures");
    check_may_read(*found, {mesh_path_, 0, "the image " + shown, "", "", "", ""});
    const std::string bytes = read_file(*found, kLargestFile);
    return {decode_picture(bytes), sha256(bytes)};
  } catch (const RefusedFile&) {
    throw;
  } catch (const std::exception& error) {
    note("the image " + shown + " " + error.what());
    return {};
  }
}

void MeshPaints::note(const std::string& text) {
  if (std::find(notes_.begin(), notes_.end(), text) == notes_.end()) notes_.push_back(text);
}

}  // namespace rubble
