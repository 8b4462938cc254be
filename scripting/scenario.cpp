#include "scripting/scenario.h"

#include <algorithm>

#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"
#include "scripting/scenario_schema.h"

namespace rubble {
namespace {

// A mix of which nothing can be drawn.
void check_mix(const PileScenario& pile, std::vector<Diagnostic>& mistakes) {
  double sum = 0;
  for (const MixItem& item : pile.mix) sum += item.weight;
  if (!pile.mix.empty() && sum == 0)
    mistakes.push_back(
        {"", 0, "pile.mix", "nothing to draw", "a weight above 0", "only weights of 0", ""});
}

std::string item_key(const char* list, std::size_t i, const char* name = "") {
  return std::string(list) + "[" + std::to_string(i + 1) + "]" + name;
}

void check_box(const PlacedItem& item, std::size_t i, std::vector<Diagnostic>& mistakes) {
  if (item.box && !item.asset.empty())
    mistakes.push_back({"", 0, item_key("pile.placed", i, ".box"), "contradicts asset",
                        "one of asset and box", "both", ""});
  static const std::vector<std::string> kFaces{"+x", "-x", "+y", "-y", "+z", "-z"};
  for (const std::string& face : item.broken)
    if (std::find(kFaces.begin(), kFaces.end(), face) == kFaces.end())
      mistakes.push_back({"", 0, item_key("pile.placed", i, ".broken"), "no such face",
                          "some of \"+x\", \"-x\", \"+y\", \"-y\", \"+z\", \"-z\"",
                          "\"" + face + "\"", ""});
}

void check_names(const PileScenario& pile, std::vector<Diagnostic>& mistakes) {
  for (std::size_t i = 0; i < pile.mix.size(); ++i)
    if (pile.mix[i].asset.empty())
      mistakes.push_back({"", 0, item_key("pile.mix", i, ".asset"), "no name",
                          "the name of an asset", "an empty string", ""});
  for (std::size_t i = 0; i < pile.placed.size(); ++i) {
    const PlacedItem& item = pile.placed[i];
    if (item.asset.empty() && !item.box)
      mistakes.push_back({"", 0, item_key("pile.placed", i), "no piece",
                          "`asset = NAME` or `box = {x, y, z}`", "neither", ""});
    check_box(item, i, mistakes);
  }
}

struct ChannelName {
  const char* name;
  bool ChannelSet::* member;
};
constexpr ChannelName kChannels[] = {{"normals", &ChannelSet::normals},
                                     {"instance", &ChannelSet::instance},
                                     {"label", &ChannelSet::label},
                                     {"flow", &ChannelSet::flow},
                                     {"sky_visibility", &ChannelSet::sky_visibility}};

void check_channels(const CameraScenario& camera, std::vector<Diagnostic>& mistakes) {
  const std::vector<std::string> names = channel_names();
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "one of " : ", ") + name;
  for (std::size_t i = 0; i < camera.channels.size(); ++i) {
    const std::string& written = camera.channels[i];
    if (std::find(names.begin(), names.end(), written) != names.end()) continue;
    const std::string near = nearest_name(written, names);
    mistakes.push_back({"", 0, "camera.channels[" + std::to_string(i + 1) + "]",
                        "unknown channel `" + written + "`", near.empty() ? list : "", "",
                        near.empty() ? "" : "did you mean `" + near + "`?"});
  }
}

}  // namespace

std::vector<std::string> channel_names() {
  std::vector<std::string> names;
  for (const ChannelName& channel : kChannels) names.push_back(channel.name);
  return names;
}

ChannelSet CameraScenario::channel_set() const {
  ChannelSet set;
  for (const std::string& written : channels)
    for (const ChannelName& channel : kChannels)
      if (written == channel.name) set.*channel.member = true;
  return set;
}

Intrinsics CameraScenario::intrinsics() const {
  const portable::SinCos half = portable::sincos(fov_deg * (portable::kPi / 360.0));
  Intrinsics in;
  in.width = width;
  in.height = height;
  in.fx = in.fy = 0.5 * width * half.cos / half.sin;
  in.cx = 0.5 * (width - 1);
  in.cy = 0.5 * (height - 1);
  return in;
}

std::vector<Diagnostic> find_mistakes(const Scenario& scenario) {
  Scenario copy = scenario;  // a schema binds members that can be written
  std::vector<Diagnostic> mistakes = check_ranges(make_scenario_schema(copy));
  if (!mistakes.empty()) return mistakes;  // what follows relies on finite numbers
  check_names(scenario.pile, mistakes);
  check_mix(scenario.pile, mistakes);
  check_channels(scenario.camera, mistakes);
  for (Diagnostic& d : find_mistakes(scenario.trajectory)) mistakes.push_back(std::move(d));
  return mistakes;
}

void Scenario::validate() const {
  std::vector<Diagnostic> mistakes = find_mistakes(*this);
  if (!mistakes.empty()) throw InputError(std::move(mistakes));
}

LightSpec resolve_light(const Scenario& scenario) {
  LightSpec light = scenario.light.spec;
  if (!scenario.light.random_rotation) return light;
  RandomStream random(scenario.seed, "light/rotation");
  const double pitch = random.uniform(20, 80);
  light.rpy_deg = {0, pitch, random.uniform(-180, 180)};
  return light;
}

}  // namespace rubble
