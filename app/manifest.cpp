#include "app/manifest.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/build_info.h"
#include "kernel/base/hash.h"

namespace rubble {
namespace {

using Json = nlohmann::ordered_json;

Json describe_program() {
  const BuildInfo build = build_info();
  return {{"name", "rubble"},           {"version", build.version}, {"commit", build.commit},
          {"compiler", build.compiler}, {"flags", build.flags},     {"target", build.target}};
}

Json describe_pile(const PileState& pile) {
  return {{"settled", pile.settled},
          {"pieces", pile.pieces.size()},
          {"lost", pile.lost},
          {"steps", pile.steps},
          {"simulated_s", pile.simulated},
          {"layers_at_limit", pile.layers_at_limit}};
}

Json describe_assets(const AssetLibrary& assets) {
  Json list = Json::array();
  for (const AssetContent& asset : assets.contents)
    list.push_back({{"name", asset.name}, {"pack", asset.pack}, {"sha256", asset.sha256}});
  return list;
}

// By its name alone: where it lay is this machine's business.
Json describe_script(const SourceFile& script) {
  return {{"name", std::filesystem::path(script.path).filename().string()},
          {"sha256", script.sha256},
          {"text", script.text}};
}

}  // namespace

std::string make_manifest(const ManifestContents& contents) {
  const Mission& mission = *contents.mission;
  Json manifest;
  manifest["format"] = "rubble manifest 1";
  manifest["program"] = describe_program();
  manifest["seed"] = mission.scenario.seed;
  manifest["state_hash"] = hex64(contents.pile->state_hash());
  manifest["pile"] = describe_pile(*contents.pile);
  manifest["frames"] = contents.frames;
  manifest["outputs"] = contents.outputs;
  manifest["script"] = describe_script(mission.script);
  manifest["included"] = Json::array();
  for (const SourceFile& file : mission.included)
    manifest["included"].push_back(describe_script(file));
  manifest["scenario"] = Json::parse(scenario_to_json(mission.scenario));
  manifest["assets"] = describe_assets(*contents.assets);
  manifest["libraries"] = build_info().libraries;
  manifest["not_reproducible"] = {{"wall_s", contents.wall_seconds},
                                  {"environment", contents.environment}};
  return manifest.dump(2) + "\n";
}

}  // namespace rubble
