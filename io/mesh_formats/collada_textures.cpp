#include "io/mesh_formats/collada_textures.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "io/base/text_scan.h"
#include "kernel/base/text.h"

namespace rubble {
namespace {

struct TextureUse {
  std::string effect, sampler, channel;
  std::size_t begin = 0, size = 0;  // of the channel's name in the document
};

class ColladaTextureScan {
 public:
  explicit ColladaTextureScan(const std::string& xml) : xml_(xml), tags_(xml) {}

  ColladaTextures read() {
    while (tags_.next()) tags_.closes() ? close() : open();
    ColladaTextures out{xml_, {}};
    note_wrapping(out);
    rank_sets();
    // From the end, so that places before stay.
    std::sort(uses_.begin(), uses_.end(), [](const TextureUse& a, const TextureUse& b) { return a.begin > b.begin; });
    for (const TextureUse& use : uses_) place(use, out);
    return out;
  }

 private:
  using OfEffect = std::pair<std::string, std::string>;  // the effect, and a name in it

  static std::string without_hash(const std::string& url) { return url.substr(url.substr(0, 1) == "#" ? 1 : 0); }

  void open() {
    const std::string_view name = tags_.name();
    if (name == "effect") effect_ = tags_.attribute("id");
    else if (name == "newparam") parameter_ = tags_.attribute("sid");
    else if (name == "texture") add_use();
    else if (name == "material") material_ = tags_.attribute("id");
    else if (name == "instance_effect") effects_[material_] = without_hash(tags_.attribute("url"));
    else if (name == "instance_material") material_ = without_hash(tags_.attribute("target"));
    else if (name == "bind_vertex_input" && tags_.attribute("input_semantic") == "TEXCOORD")
      bound_.push_back({{material_, tags_.attribute("semantic")}, set_of("input_set")});
    else if (name == "geometry") sets_.emplace_back();
    else if (name == "input" && !sets_.empty() && tags_.attribute("semantic") == "TEXCOORD")
      sets_.back().insert(set_of("set"));
  }

  void close() {
    if (tags_.name() != "wrap_s" && tags_.name() != "wrap_t") return;
    const std::string text = tags_.text();
    const std::string_view mode = trimmed(text);
    if (!mode.empty() && mode != "WRAP") wraps_[{effect_, parameter_}].insert(std::string(mode));
  }

  std::int64_t set_of(std::string_view attribute) const { return read_integer(tags_.attribute(attribute)).value_or(0); }

  void add_use() {
    TextureUse use{effect_, tags_.attribute("texture"), tags_.attribute("texcoord")};
    for (const auto& [key, value] : tags_.attributes())
      if (key == "texcoord") use.begin = std::size_t(value.data() - xml_.data()), use.size = value.size();
    uses_.push_back(std::move(use));
  }

  void note_wrapping(ColladaTextures& out) const {
    for (const TextureUse& use : uses_)
      if (const auto found = wraps_.find({use.effect, use.sampler}); found != wraps_.end())
        for (const std::string& mode : found->second)
          out.notes.push_back("the wrapping " + printable(mode) + " of images of the effect \"" + printable(use.effect) +
                              "\" is not drawn: they repeat");
  }

  // Assimp numbers the sets that a mesh has from 0.
  void rank_sets() {
    for (const auto& sets : sets_) {
      int rank = 0;
      for (const std::int64_t set : sets) ranks_[set].insert(rank++);
      several_ = several_ || sets.size() > 1;
    }
    for (const auto& [in_material, set] : bound_)
      if (const auto effect = effects_.find(in_material.first); effect != effects_.end())
        channels_[{effect->second, in_material.second}].insert(set);
  }

  void place(const TextureUse& use, ColladaTextures& out) const {
    const auto found = channels_.find({use.effect, use.channel});
    if (!several_ || use.size == 0 || found == channels_.end()) return;
    const auto ranks = ranks_.find(*found->second.begin());
    const bool one = found->second.size() == 1 && ranks != ranks_.end() && ranks->second.size() == 1;
    if (!one)
      out.notes.push_back("the texture coordinates \"" + printable(use.channel) + "\" of the effect \"" +
                          printable(use.effect) + "\" are not of one set in all meshes: its images lie by the first set");
    out.xml.replace(use.begin, use.size, std::to_string(one ? *ranks->second.begin() : 0));
  }

  const std::string& xml_;
  XmlScanner tags_;
  std::string effect_, parameter_, material_;
  std::vector<TextureUse> uses_;
  std::map<std::string, std::string> effects_;                     // of materials
  std::vector<std::pair<OfEffect, std::int64_t>> bound_;           // material and channel: the set
  std::map<OfEffect, std::set<std::int64_t>> channels_;            // effect and channel: the sets
  std::map<OfEffect, std::set<std::string>> wraps_;                // effect and sampler: other than WRAP
  std::vector<std::set<std::int64_t>> sets_;                       // of each geometry
  std::map<std::int64_t, std::set<int>> ranks_;                    // of a set in the geometries that have it
  bool several_ = false;                                           // a geometry has more than one set
};

}  // namespace

ColladaTextures prepare_textures(const std::string& xml) {
  if (xml.find('\0') != std::string::npos) return {xml, {}};  // UTF-16: assimp's own conversion reads it
  return ColladaTextureScan(xml).read();
}

}  // namespace rubble
