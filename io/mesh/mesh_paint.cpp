#include "io/mesh/mesh_paint.h"

#include <assimp/GltfMaterial.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "io/base/srgb.h"
#include "io/image/picture_decoder.h"
#include "kernel/base/error.h"
#include "kernel/base/hash.h"
#include "kernel/base/read_file.h"
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

Vec3f colour_of(const aiMaterial& material) {
  aiColor4D c(1, 1, 1, 1);
  if (material.Get(AI_MATKEY_BASE_COLOR, c) != aiReturn_SUCCESS) {
    aiColor3D diffuse(1, 1, 1);
    material.Get(AI_MATKEY_COLOR_DIFFUSE, diffuse);
    c = aiColor4D(diffuse.r, diffuse.g, diffuse.b, 1);
  }
  const auto share = [](float x) { return x > 0 ? std::min(x, 1.0f) : 0.0f; };  // also of what is no number
  return {share(c.r), share(c.g), share(c.b)};
}

bool is_same_grey(const Vec3f& a, const Vec3f& b) {
  return std::max({a.x, a.y, a.z, b.x, b.y, b.z}) - std::min({a.x, a.y, a.z, b.x, b.y, b.z}) < kSameGrey;
}

// Whether the file means the fourth channel of images to be seen through: glTF says so or not.
bool means_alpha(const aiMaterial& material) {
  aiString mode;
  return material.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) != aiReturn_SUCCESS || std::string(mode.C_Str()) != "OPAQUE";
}

bool is_seen_through(const RgbaImage& image) {
  for (std::size_t i = 3; i < image.rgba.size(); i += 4)
    if (image.rgba[i] < 128) return true;
  return false;
}

bool has_image(const aiMaterial& material) {
  return material.GetTextureCount(aiTextureType_DIFFUSE) + material.GetTextureCount(aiTextureType_BASE_COLOR) > 0;
}

// A name as a URL has it: "my%20wood.png".
std::string decode_percent(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto digit = [&](std::size_t at) {
      return at < text.size() ? std::string("0123456789abcdef").find(char(std::tolower(text[at]))) : std::string::npos;
    };
    const std::size_t high = digit(i + 1), low = digit(i + 2);
    if (text[i] == '%' && high != std::string::npos && low != std::string::npos)
      out += char(high * 16 + low), i += 2;
    else
      out += text[i];
  }
  return out;
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

std::string sha256_of(std::string_view bytes) {
  Sha256 hash;
  hash.add(bytes.data(), bytes.size());
  return hash.hex();
}

}  // namespace

MeshPaints::MeshPaints(const aiScene& scene, const std::string& path)
    : scene_(scene), folder_(fs::path(path).parent_path().string()) {
  std::string extension = fs::path(path).extension().string();
  for (char& c : extension) c = char(std::tolower(c));
  linear_corners_ = extension == ".gltf" || extension == ".glb";
  std::vector<Vec3f> colours;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[i];
    any_ = any_ || mesh.HasVertexColors(0);
    if (mesh.mMaterialIndex >= scene.mNumMaterials) continue;
    const aiMaterial& material = *scene.mMaterials[mesh.mMaterialIndex];
    any_ = any_ || has_image(material);
    colours.push_back(colour_of(material));
    any_ = any_ || !is_same_grey(colours.front(), colours.back());
  }
}

std::shared_ptr<const SurfacePaint> MeshPaints::of(const aiMesh& mesh) {
  if (!any_) return nullptr;
  const auto [found, is_new] = paints_.try_emplace(mesh.mMaterialIndex);
  if (is_new) {
    SurfacePaint paint;
    paint.sha256 = sha256_of("plain");
    if (mesh.mMaterialIndex < scene_.mNumMaterials) paint = read(*scene_.mMaterials[mesh.mMaterialIndex]);
    found->second = std::make_shared<const SurfacePaint>(std::move(paint));
  }
  return found->second;
}

PaintCorner MeshPaints::corner(const aiMesh& mesh, unsigned vertex) const {
  PaintCorner out;
  if (mesh.HasTextureCoords(0)) {
    const aiVector3D& at = mesh.mTextureCoords[0][vertex];
    if (std::isfinite(at.x) && std::isfinite(at.y)) out.u = at.x, out.v = at.y;
  }
  if (mesh.HasVertexColors(0)) {
    const aiColor4D& c = mesh.mColors[0][vertex];
    const auto part = [this](float x) {
      const float share = x > 0 ? std::min(x, 1.0f) : 0.0f;
      return linear_corners_ ? share : float(linear_from_srgb(double(share)));
    };
    out.colour = {part(c.r), part(c.g), part(c.b)};
  }
  return out;
}

SurfacePaint MeshPaints::read(const aiMaterial& material) {
  SurfacePaint paint;
  paint.colour = colour_of(material);
  const Image* albedo = find(material, aiTextureType_BASE_COLOR);
  if (!albedo) albedo = find(material, aiTextureType_DIFFUSE);
  if (albedo) {
    paint.albedo = make_albedo(albedo->pixels);
    if (means_alpha(material) && is_seen_through(albedo->pixels)) note("transparent parts of images are drawn opaque");
    if (std::max({paint.colour.x, paint.colour.y, paint.colour.z}) < kBlack) paint.colour = {1, 1, 1};
  }
  read_gloss(material, paint);
  const Image* normals = find(material, aiTextureType_NORMALS);
  const Image* both = find(material, aiTextureType_UNKNOWN);  // glTF's, where assimp puts it
  const Image* roughness = both ? both : find(material, aiTextureType_DIFFUSE_ROUGHNESS);
  const Image* metalness = both ? both : find(material, aiTextureType_METALNESS);
  const auto pixels = [](const Image* image) { return image ? &image->pixels : nullptr; };
  paint.relief = make_relief(pixels(normals), pixels(roughness), pixels(metalness));
  note_left_out(material);
  Sha256 hash;
  for (const float x : {paint.colour.x, paint.colour.y, paint.colour.z, paint.roughness, paint.metalness,
                        paint.reflectance})
    hash.add(&x, sizeof x);
  for (const Image* image : {albedo, normals, roughness, metalness}) {
    const std::string content = image ? image->sha256 : "none";
    hash.add(content.data(), content.size());
  }
  paint.sha256 = hash.hex();
  return paint;
}

// Metal and roughness where the file says them; otherwise an OBJ's highlight: exponents of Phong's become
// alpha = sqrt(2 / (n + 2)) (Walter et al. 2007).
void MeshPaints::read_gloss(const aiMaterial& material, SurfacePaint& paint) const {
  float roughness = 1, metalness = 0, exponent = 0;
  const bool rough = material.Get(AI_MATKEY_ROUGHNESS_FACTOR, roughness) == aiReturn_SUCCESS;
  const bool metal = material.Get(AI_MATKEY_METALLIC_FACTOR, metalness) == aiReturn_SUCCESS;
  aiColor3D specular(0, 0, 0);
  material.Get(AI_MATKEY_COLOR_SPECULAR, specular);
  material.Get(AI_MATKEY_SHININESS, exponent);
  const bool shines = std::max({specular.r, specular.g, specular.b}) > kBlack && exponent > 1;
  if (!rough && !metal && !shines) return;
  if (!rough && shines) roughness = std::sqrt(std::sqrt(2 / (exponent + 2)));
  paint.reflectance = kGlossOfPlastics;
  paint.roughness = roughness >= 0 && roughness <= 1 ? roughness : 1;
  paint.metalness = metal && metalness >= 0 && metalness <= 1 ? metalness : 0;
}

// Null where the material has none, or it cannot be had.
const MeshPaints::Image* MeshPaints::find(const aiMaterial& material, int type) {
  aiString name;
  if (material.GetTexture(aiTextureType(type), 0, &name) != aiReturn_SUCCESS || name.length == 0) return nullptr;
  const auto [found, is_new] = images_.try_emplace(name.C_Str());
  if (is_new) found->second = std::make_shared<const Image>(load(name.C_Str()));
  return found->second->pixels.rgba.empty() ? nullptr : found->second.get();
}

MeshPaints::Image MeshPaints::load(const std::string& name) {
  std::string shown = printable(name);
  try {
    if (const aiTexture* inside = scene_.GetEmbeddedTexture(name.c_str())) {
      shown += " in the file";
      if (inside->mHeight != 0) throw RunError("is of raw texels; PNG and JPEG are read");
      const std::string_view bytes(reinterpret_cast<const char*>(inside->pcData), inside->mWidth);
      return {decode_picture(bytes), sha256_of(bytes)};
    }
    std::string path = decode_percent(name);
    std::replace(path.begin(), path.end(), '\\', '/');
    const std::string file = fs::path(path).filename().string();
    std::error_code failed;
    for (const fs::path& tried : {fs::path(folder_) / path, fs::path(folder_) / file,
                                  fs::path(folder_) / "textures" / file})
      if (fs::is_regular_file(tried, failed)) {
        const std::string bytes = read_file(tried.string(), kLargestFile);
        return {decode_picture(bytes), sha256_of(bytes)};
      }
    throw RunError("lies neither beside the mesh nor in its folder textures");
  } catch (const std::exception& error) {
    note("the image " + shown + " " + error.what());
    return {};
  }
}

void MeshPaints::note_left_out(const aiMaterial& material) {
  for (const auto& [type, what] :
       {std::pair(aiTextureType_EMISSIVE, "images of light that surfaces give"),
        std::pair(aiTextureType_OPACITY, "images of transparency"), std::pair(aiTextureType_HEIGHT, "height images")})
    if (material.GetTextureCount(type) > 0) note(std::string(what) + " are not drawn");
  float opacity = 1;
  if (material.Get(AI_MATKEY_OPACITY, opacity) == aiReturn_SUCCESS && opacity < 0.99f && opacity > 0)
    note("transparent materials are drawn opaque");
}

void MeshPaints::note(const std::string& text) {
  if (std::find(notes_.begin(), notes_.end(), text) == notes_.end()) notes_.push_back(text);
}

}  // namespace rubble
