#include "io/mesh_formats/gltf_document.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "io/import/uri.h"
#include "kernel/base/error.h"
#include "kernel/base/system/file_sandbox.h"
#include "kernel/base/text.h"

namespace rubble {
namespace {

using Json = nlohmann::json;

// Extensions of materials and textures that are applied, or change nothing that is drawn.
constexpr const char* kApplied[] = {"KHR_materials_pbrSpecularGlossiness", "KHR_materials_unlit", "KHR_texture_transform"};
constexpr std::int64_t kClampToEdge = 33071, kMirroredRepeat = 33648;  // of OpenGL

class MaterialReader {
 public:
  MaterialReader(const GltfDocument& document, ImportedScene& scene) : document_(document), scene_(scene) {}

  void read() {
    for (std::size_t i = 0; i < document_.count("images"); ++i) read_image(document_.json()["images"][i], i);
    for (std::size_t i = 0; i < document_.count("materials"); ++i) {
      element_ = "materials[" + std::to_string(i) + "]";
      scene_.materials.push_back(read_material(document_.json()["materials"][i]));
    }
  }

 private:
  // A mistake in an image costs the image alone.
  void read_image(const Json& from, std::size_t index) {
    ImportedImage image;
    image.name = "images[" + std::to_string(index) + "]";
    try {
      const std::string uri = gltf_text(from, "uri");
      const std::string mime = gltf_text(from, "mimeType");
      if (uri.compare(0, 5, "data:") == 0) {
        const auto bytes = decode_data_uri(uri);
        if (!bytes) throw RunError("has a damaged data URI");
        image.bytes = std::make_shared<const std::string>(*bytes);
      } else if (!uri.empty()) {
        image.name = uri;
      } else {
        const std::string name = gltf_text(from, "name");
        if (!name.empty()) image.name = name;
        image.bytes = std::make_shared<const std::string>(document_.read_view(gltf_index(from, "bufferView"), image.name));
      }
    } catch (const RefusedFile&) {
      throw;
    } catch (const InputError& error) {
      image.fault = "cannot be had: " + error.diagnostics().front().message;
    } catch (const std::exception& error) {
      image.fault = error.what();
    }
    scene_.images.push_back(std::move(image));
  }

  ImportedMaterial read_material(const Json& from) {
    ImportedMaterial material;
    material.name = gltf_text(from, "name");
    if (material.name.empty()) material.name = element_;
    const Json* pbr = gltf_member(from, "pbrMetallicRoughness");
    const Json nothing = Json::object();
    const Json& rough = pbr ? *pbr : nothing;
    material.alpha_of_image = false;
    const std::string mode = gltf_text(from, "alphaMode");
    if (!mode.empty() && mode != "OPAQUE") material.alpha_of_image = true;
    read_colour(rough, "baseColorFactor", material);
    material.roughness = float(gltf_number(rough, "roughnessFactor", 1));
    material.metalness = float(gltf_number(rough, "metallicFactor", 1));
    material.albedo = read_texture(rough, "baseColorTexture");
    material.roughness_map = material.metalness_map = read_texture(rough, "metallicRoughnessTexture");
    material.normals = read_texture(from, "normalTexture");
    if (gltf_member(from, "emissiveTexture")) material.left_out.push_back("images of light that surfaces give are not drawn");
    if (gives_light(from)) material.left_out.push_back("light that surfaces give is not drawn");
    if (const Json* bumps = gltf_member(from, "normalTexture"); bumps && gltf_number(*bumps, "scale", 1) != 1)
      material.left_out.push_back("the scale of the image of normals is not applied");
    read_extensions(from, material);
    for (const std::string& clause : wrapping_) material.left_out.push_back(clause);
    wrapping_.clear();
    return material;
  }

  static bool gives_light(const Json& from) {
    const Json* factor = gltf_member(from, "emissiveFactor");
    return factor && factor->is_array() &&
           std::any_of(factor->begin(), factor->end(), [](const Json& share) { return share.get<float>() > 0; });
  }

  static void read_colour(const Json& from, const char* name, ImportedMaterial& material) {
    const Json* factor = gltf_member(from, name);
    if (!factor || !factor->is_array() || factor->size() < 3) return;
    for (int i = 0; i < 3; ++i) material.colour[i] = (*factor)[std::size_t(i)].get<float>();
    if (factor->size() > 3 && material.alpha_of_image) material.opacity = (*factor)[3].get<float>();
  }

  void read_extensions(const Json& from, ImportedMaterial& material) {
    const Json* extensions = gltf_member(from, "extensions");
    if (!extensions || !extensions->is_object()) return;
    for (const auto& [name, content] : extensions->items()) {
      if (name == "KHR_materials_pbrSpecularGlossiness") {
        read_colour(content, "diffuseFactor", material);
        if (gltf_member(content, "diffuseTexture")) material.albedo = read_texture(content, "diffuseTexture");
        material.metalness = 0.0f;
        material.roughness = float(1 - gltf_number(content, "glossinessFactor", 1));
        if (gltf_member(content, "specularGlossinessTexture"))
          material.left_out.push_back("images of highlights are not drawn");
      } else if (std::find(std::begin(kApplied), std::end(kApplied), name) == std::end(kApplied)) {
        material.left_out.push_back("the extension " + printable(name) + " of materials is not drawn");
      }
    }
  }

  // The textures of an extension with another kind of picture: its plain source counts if there is one.
  int image_of(const Json& texture, const std::string& user) {
    const std::int64_t plain = gltf_index(texture, "source");
    if (plain >= 0) {
      document_.find("images", plain, user);
      return int(plain);
    }
    const Json* extensions = gltf_member(texture, "extensions");
    if (extensions && extensions->is_object())
      for (const auto& [name, content] : extensions->items()) {
        const std::int64_t source = gltf_index(content, "source");
        if (source < 0) continue;
        document_.find("images", source, user);
        ImportedImage& image = scene_.images[std::size_t(source)];
        if (image.fault.empty()) image.fault = "is of the extension " + printable(name) + "; PNG and JPEG are read";
        return int(source);
      }
    return -1;
  }

  ImportedTexture read_texture(const Json& from, const char* name) {
    ImportedTexture out;
    const Json* use = gltf_member(from, name);
    if (!use) return out;
    const std::string user = element_ + "." + name;
    const Json& texture = document_.find("textures", gltf_index(*use, "index"), user);
    if (document_.count("images") == 0) return out;
    out.image = image_of(texture, user);
    note_wrapping(texture);
    out.place.uv_set = unsigned(std::max<std::int64_t>(0, gltf_index(*use, "texCoord")));
    const Json* extensions = gltf_member(*use, "extensions");
    const Json* moved = extensions ? gltf_member(*extensions, "KHR_texture_transform") : nullptr;
    if (moved) read_place(*moved, out.place);
    return out;
  }

  void note_wrapping(const Json& texture) {
    const std::int64_t index = gltf_index(texture, "sampler");
    if (index < 0 || std::size_t(index) >= document_.count("samplers")) return;
    const Json& sampler = document_.json()["samplers"][std::size_t(index)];
    for (const char* key : {"wrapS", "wrapT"}) {
      const Json* mode = sampler.is_object() ? gltf_member(sampler, key) : nullptr;
      for (const auto& [value, name] :
           {std::pair(kClampToEdge, "CLAMP_TO_EDGE"), std::pair(kMirroredRepeat, "MIRRORED_REPEAT")})
        if (mode && *mode == value)
          wrapping_.insert(std::string("the wrapping ") + name + " of images is not drawn: they repeat");
    }
  }

  static void read_place(const Json& from, TexturePlace& place) {
    for (const auto& [name, target] : {std::pair("offset", &place.offset), std::pair("scale", &place.scale)})
      if (const Json* pair = gltf_member(from, name))
        for (std::size_t i = 0; i < 2; ++i) (*target)[i] = pair->at(i).get<double>();
    place.rotation = gltf_number(from, "rotation", 0);
    if (gltf_index(from, "texCoord") >= 0) place.uv_set = unsigned(gltf_index(from, "texCoord"));
  }

  const GltfDocument& document_;
  ImportedScene& scene_;
  std::string element_;
  std::set<std::string> wrapping_;  // of the textures of this material
};

}  // namespace

void read_gltf_materials(const GltfDocument& document, ImportedScene& scene) { MaterialReader(document, scene).read(); }

}  // namespace rubble
