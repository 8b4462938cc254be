// Keys of a pack.lua that nothing reads: the density of an asset that is made of others, say.
#include "scripting/packs/pack_schema.h"
#include "scripting/schema/idle_key_list.h"
#include "scripting/schema/override_text.h"

namespace rubble {
namespace {

void add_link(const std::string& at, const LinkTable& link, bool first, std::vector<IdleKey>& keys) {
  IdleKeys k(at, keys);
  k.against(first, "the first link hangs on nothing",
            {"joint", "joint_position", "joint_axis", "stiffness", "damping", "friction", "yield", "break_force", "break_torque",
             "limit_deg", "travel", "collide"});
  if (first) return;
  const bool weld = link.joint == JointKind::weld, slider = link.joint == JointKind::slider;
  k.against(!slider, "only a slider has it", {"travel"});
  k.against(weld || slider, "only a hinge or a ball has it", {"limit_deg"});
  k.against(weld, "a weld does not move", {"friction"});
  k.off(!(link.stiffness > 0), "stiffness", "0", {"yield"});
}

void add_asset(const std::string& at, const AssetTable& asset, std::vector<IdleKey>& keys) {
  IdleKeys k(at, keys);
  k.against(!asset.links.empty(), "an asset with links is made of others, which have it",
            {"units", "up", "collision", "material", "look", "looks", "density", "friction"});
  k.off(asset.spread.kind == Spread::uniform, "spread", "\"uniform\"", {"typical", "deviation"});
  for (std::size_t i = 0; i < asset.links.size(); ++i)
    add_link(at + "links[" + std::to_string(i + 1) + "].", asset.links[i], i == 0, keys);
}

}  // namespace

std::vector<Diagnostic> find_idle_pack_keys(const PackTable& pack, const std::vector<std::string>& stated) {
  std::vector<IdleKey> idle;
  for (std::size_t i = 0; i < pack.assets.size(); ++i) add_asset("assets[" + std::to_string(i + 1) + "].", pack.assets[i], idle);
  std::vector<Diagnostic> found;
  for (const std::string& path : stated) {
    for (const IdleKey& key : idle) {
      if (!is_within(path, key.path)) continue;
      found.push_back({"", 0, path, idle_sentence(key), "", "", ""});
      break;
    }
  }
  return found;
}

}  // namespace rubble
