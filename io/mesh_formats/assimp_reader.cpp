#include "io/mesh_formats/scene_reader.h"

#include <algorithm>
#include <assimp/DefaultIOSystem.h>
#include <assimp/GltfMaterial.h>
#include <assimp/Importer.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "io/base/text_scan.h"
#include "io/mesh_formats/collada_textures.h"
#include "kernel/base/read_file.h"
#include "kernel/base/system/file_sandbox.h"
#include "kernel/base/text.h"

namespace rubble {
namespace {

// Without <init_from/> and <init_from> </init_from>, which end assimp by an assertion: an image without a name is only
// refused where it is used.
std::string without_empty_names(std::string xml) {
  const std::string name = "<init_from", close = "</init_from>";
  for (std::size_t at = xml.find(name); at != std::string::npos; at = xml.find(name, at)) {
    const std::size_t tag = end_of_markup(xml, at);
    const std::size_t content = xml.find_first_not_of(" \t\r\n", tag);
    if (tag >= 2 && xml[tag - 2] == '/')
      xml.erase(at, tag - at);
    else if (content != std::string::npos && xml.compare(content, close.size(), close) == 0)
      xml.erase(at, content + close.size() - at);
    else
      at = tag;
  }
  return xml;
}

}  // namespace

std::string repair_collada(const std::string& xml) {
  if (xml.find('\0') != std::string::npos) return xml;  // UTF-16: assimp's own conversion reads it
  std::string out;
  out.reserve(xml.size());
  for (std::size_t at = 0; at < xml.size();) {
    if (xml[at] == '<') {
      const std::size_t end = end_of_markup(xml, at);
      out.append(xml, at, end - at);
      at = end;
      continue;
    }
    const std::size_t end = std::min(xml.find('<', at), xml.size());
    const std::string_view content = trimmed(std::string_view(xml).substr(at, end - at));
    if (content.empty()) out.append(xml, at, end - at);  // between elements: lines keep their numbers
    out += content;
    at = end;
  }
  return without_empty_names(std::move(out));
}

std::string without_looks(const std::string& collada) {
  std::string out = collada;
  for (const std::string library : {"library_images", "library_effects", "library_materials"})
    for (std::size_t begin = out.find("<" + library); begin != std::string::npos; begin = out.find("<" + library, begin)) {
      const std::string close = "</" + library + ">";
      const std::size_t tag = end_of_markup(out, begin), end = out.find(close, begin);
      const bool empty = tag >= 2 && out[tag - 2] == '/';
      out.erase(begin, (empty || end == std::string::npos ? tag : end + close.size()) - begin);
    }
  return out;
}

std::optional<FileUp> find_up_axis(const std::string& xml) {
  XmlScanner tags(xml);
  int depth = 0;
  bool in_asset = false;  // of the whole document: directly below the root
  while (tags.next()) {
    if (!tags.closes()) {
      if (tags.is_empty()) continue;
      in_asset = in_asset || (depth == 1 && tags.name() == "asset");
      ++depth;
      continue;
    }
    --depth;
    if (!in_asset) continue;
    if (depth == 1) return std::nullopt;  // </asset>
    if (depth != 2 || tags.name() != "up_axis") continue;
    const std::string text = tags.text();
    const std::string_view axis = trimmed(text);
    if (axis == "X_UP") return FileUp::x;
    if (axis == "Y_UP") return FileUp::y;
    return axis == "Z_UP" ? std::optional(FileUp::z) : std::nullopt;
  }
  return std::nullopt;
}

namespace {

// Opens the files that assimp asks for. Gives repaired bytes for one of them, if there are any.
class GuardedFiles : public Assimp::DefaultIOSystem {
 public:
  // bytes: empty: as the file has them. refused: gets what lies outside the sandbox, since assimp keeps exceptions to itself.
  GuardedFiles(std::string path, const std::string& bytes, std::optional<Diagnostic>& refused)
      : path_(std::move(path)), bytes_(bytes), refused_(refused) {}

  Assimp::IOStream* Open(const char* file, const char* mode) override {
    if (path_ == file && !bytes_.empty())
      return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes_.data()), bytes_.size());
    std::error_code failed;
    auto refused = find_refusal(file, {path_, 0, "", "", "", "", ""});
    if (refused && std::filesystem::exists(file, failed)) {  // assimp tries names that are not there, too
      refused_ = std::move(refused);
      return nullptr;
    }
    return DefaultIOSystem::Open(file, mode);
  }

 private:
  std::string path_;
  const std::string& bytes_;
  std::optional<Diagnostic>& refused_;
};

class AssimpReader {
 public:
  explicit AssimpReader(const std::string& path) : path_(path) {}

  ImportedScene read() {
    std::string extension = std::filesystem::path(path_).extension().string();
    for (char& c : extension) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
    std::string repaired;
    if (extension == ".dae") {
      repaired = repair_collada(read_file(path_));
      out_.up = find_up_axis(repaired);
      ColladaTextures textures = prepare_textures(repaired);
      repaired = std::move(textures.xml);
      for (const std::string& note : textures.notes) out_.note(note);
      importer_.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
    }
    importer_.SetIOHandler(new GuardedFiles(path_, repaired, refused_));  // the importer owns it
    scene_ = importer_.ReadFile(path_, aiProcess_Triangulate);
    if (!scene_ && !repaired.empty()) {
      const std::string reason = importer_.GetErrorString();
      repaired = without_looks(repaired);
      scene_ = importer_.ReadFile(path_, aiProcess_Triangulate);
      if (scene_) out_.note("its materials are left out, since they cannot be read: " + printable(reason));
    }
    if (refused_) throw RefusedFile(*refused_);
    if (!scene_) refuse_mesh(path_, std::string("cannot be read as a mesh: ") + importer_.GetErrorString());
    if (scene_->mFlags & AI_SCENE_FLAGS_INCOMPLETE || scene_->mNumMeshes == 0 || !scene_->mRootNode)
      refuse_mesh(path_, "holds no triangles");
    out_.linear_colours = extension == ".gltf" || extension == ".glb";  // of glTF 1.0
    for (unsigned i = 0; i < scene_->mNumMaterials; ++i) read_material(*scene_->mMaterials[i]);
    add_node(*scene_->mRootNode, aiMatrix4x4());
    return std::move(out_);
  }

 private:
  // Every mesh where the file's tree of nodes puts it, in the order of the tree.
  void add_node(const aiNode& node, const aiMatrix4x4& file_from_parent) {
    const aiMatrix4x4 file_from_node = file_from_parent * node.mTransformation;
    if (node.mNumMeshes > 0) ++object_;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) add_mesh(*scene_->mMeshes[node.mMeshes[i]], file_from_node);
    for (unsigned i = 0; i < node.mNumChildren; ++i) add_node(*node.mChildren[i], file_from_node);
  }

  void add_mesh(const aiMesh& from, const aiMatrix4x4& file_from_mesh) {
    note_left_out(from);
    out_.meshes.emplace_back();
    ImportedMesh& mesh = out_.meshes.back();
    mesh.object = object_;
    if (from.mMaterialIndex < scene_->mNumMaterials) mesh.material = int(from.mMaterialIndex);
    aiMatrix3x3 turn(file_from_mesh);
    const bool mirrored = turn.Determinant() < 0;
    turn.Inverse().Transpose();  // normals go by the inverse transpose
    for (unsigned i = 0; i < from.mNumVertices; ++i) {
      const aiVector3D p = file_from_mesh * from.mVertices[i];
      mesh.positions.push_back({double(p.x), double(p.y), double(p.z)});
      if (from.HasNormals()) {
        const aiVector3D n = turn * from.mNormals[i];
        mesh.normals.push_back({n.x, n.y, n.z});
      }
      if (from.HasVertexColors(0)) mesh.colours.push_back({from.mColors[0][i].r, from.mColors[0][i].g, from.mColors[0][i].b});
    }
    for (unsigned set = 0; set < AI_MAX_NUMBER_OF_TEXTURECOORDS; ++set) {
      mesh.uv_sets.emplace_back();
      for (unsigned i = 0; from.HasTextureCoords(set) && i < from.mNumVertices; ++i)
        mesh.uv_sets.back().push_back({from.mTextureCoords[set][i].x, from.mTextureCoords[set][i].y});
    }
    while (!mesh.uv_sets.empty() && mesh.uv_sets.back().empty()) mesh.uv_sets.pop_back();
    add_faces(from, mirrored, mesh);
  }

  void add_faces(const aiMesh& from, bool mirrored, ImportedMesh& mesh) {
    for (unsigned f = 0; f < from.mNumFaces; ++f) {
      const aiFace& face = from.mFaces[f];
      if (face.mNumIndices != 3) continue;  // noted
      for (unsigned k = 0; k < 3; ++k)
        if (face.mIndices[k] >= from.mNumVertices) refuse_mesh(path_, "has a face with a corner too many");
      mesh.triangles.push_back({face.mIndices[mirrored ? 2 : 0], face.mIndices[1], face.mIndices[mirrored ? 0 : 2]});
    }
  }

  void note_left_out(const aiMesh& mesh) {
    const std::string name = mesh.mName.length ? " of the mesh \"" + printable(mesh.mName.C_Str()) + "\"" : "";
    if (mesh.mPrimitiveTypes & aiPrimitiveType_LINE) out_.note("lines beside its faces are left out");
    if (mesh.mPrimitiveTypes & aiPrimitiveType_POINT) out_.note("points beside its faces are left out");
    if (mesh.HasBones())
      out_.note("the skin" + name + " (" + std::to_string(mesh.mNumBones) +
                " bones) is left out: size and pose are those of its corners as written; bake the pose when you export");
    if (mesh.mNumAnimMeshes > 0)
      out_.note("the morph targets" + name + " are left out: its shape is that of its corners as written; bake them when you export");
  }

  void read_material(const aiMaterial& from) {
    ImportedMaterial material;
    material.name = from.GetName().C_Str();
    aiColor4D base(1, 1, 1, 1);
    aiColor3D diffuse(1, 1, 1), specular(0, 0, 0);
    if (from.Get(AI_MATKEY_BASE_COLOR, base) == aiReturn_SUCCESS)
      material.colour = {base.r, base.g, base.b};
    else if (from.Get(AI_MATKEY_COLOR_DIFFUSE, diffuse) == aiReturn_SUCCESS)
      material.colour = {diffuse.r, diffuse.g, diffuse.b};
    if (from.Get(AI_MATKEY_COLOR_SPECULAR, specular) == aiReturn_SUCCESS) material.specular = {specular.r, specular.g, specular.b};
    from.Get(AI_MATKEY_SHININESS, material.exponent);
    from.Get(AI_MATKEY_OPACITY, material.opacity);
    float share = 0;
    if (from.Get(AI_MATKEY_ROUGHNESS_FACTOR, share) == aiReturn_SUCCESS) material.roughness = share;
    if (from.Get(AI_MATKEY_METALLIC_FACTOR, share) == aiReturn_SUCCESS) material.metalness = share;
    aiColor3D light(0, 0, 0);
    if (from.Get(AI_MATKEY_COLOR_EMISSIVE, light) == aiReturn_SUCCESS && !light.IsBlack())
      material.left_out.push_back("light that surfaces give is not drawn");
    aiString mode;
    if (from.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) == aiReturn_SUCCESS) material.alpha_of_image = std::string(mode.C_Str()) != "OPAQUE";
    material.albedo = find_texture(from, aiTextureType_BASE_COLOR);
    if (material.albedo.image < 0) material.albedo = find_texture(from, aiTextureType_DIFFUSE);
    material.normals = find_texture(from, aiTextureType_NORMALS);
    const ImportedTexture both = find_texture(from, aiTextureType_UNKNOWN);  // of glTF, where assimp puts it
    material.roughness_map = both.image >= 0 ? both : find_texture(from, aiTextureType_DIFFUSE_ROUGHNESS);
    material.metalness_map = both.image >= 0 ? both : find_texture(from, aiTextureType_METALNESS);
    for (const auto& [type, what] :
         {std::pair(aiTextureType_EMISSIVE, "images of light that surfaces give"),
          std::pair(aiTextureType_OPACITY, "images of transparency"), std::pair(aiTextureType_HEIGHT, "height images")})
      if (from.GetTextureCount(type) > 0) material.left_out.push_back(std::string(what) + " are not drawn");
    out_.materials.push_back(std::move(material));
  }

  ImportedTexture find_texture(const aiMaterial& material, aiTextureType type) {
    ImportedTexture texture;
    aiString name;
    if (material.GetTexture(type, 0, &name) != aiReturn_SUCCESS || name.length == 0) return texture;
    int set = 0;
    if (material.Get(AI_MATKEY_UVWSRC(type, 0), set) == aiReturn_SUCCESS && set > 0 && is_there(material, unsigned(set)))
      texture.place.uv_set = unsigned(set);
    aiUVTransform moved;
    if (material.Get(AI_MATKEY_UVTRANSFORM(type, 0), moved) == aiReturn_SUCCESS &&
        (moved.mTranslation.x != 0 || moved.mTranslation.y != 0 || moved.mScaling.x != 1 || moved.mScaling.y != 1 || moved.mRotation != 0))
      out_.note("the transform of the image " + printable(name.C_Str()) + " on the material \"" +
                printable(material.GetName().C_Str()) + "\" is left out: it lies by its plain texture coordinates");
    texture.image = image_of(name.C_Str());
    return texture;
  }

  // COLLADA counts sets by numbers of its own; assimp's number may be of none.
  bool is_there(const aiMaterial& material, unsigned set) const {
    for (unsigned i = 0; i < scene_->mNumMeshes; ++i) {
      const aiMesh& mesh = *scene_->mMeshes[i];
      if (mesh.mMaterialIndex < scene_->mNumMaterials && scene_->mMaterials[mesh.mMaterialIndex] == &material && mesh.HasTextureCoords(set))
        return true;
    }
    return false;
  }

  int image_of(const std::string& name) {
    const auto [found, is_new] = image_numbers_.try_emplace(name, int(out_.images.size()));
    if (!is_new) return found->second;
    ImportedImage image{name, nullptr, ""};
    if (const aiTexture* inside = scene_->GetEmbeddedTexture(name.c_str())) {
      image.bytes = std::make_shared<const std::string>(
          inside->mHeight == 0 ? std::string(reinterpret_cast<const char*>(inside->pcData), inside->mWidth) : std::string());
      if (inside->mHeight != 0) image.fault = "is of raw texels; PNG and JPEG are read";
    }
    out_.images.push_back(std::move(image));
    return found->second;
  }

  const std::string& path_;
  std::optional<Diagnostic> refused_;
  Assimp::Importer importer_;
  const aiScene* scene_ = nullptr;
  ImportedScene out_;
  std::map<std::string, int> image_numbers_;
  int object_ = 0;
};

}  // namespace

ImportedScene read_by_assimp(const std::string& path) { return AssimpReader(path).read(); }

}  // namespace rubble
