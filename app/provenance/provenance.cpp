#include "app/provenance/provenance.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/support/json_members.h"
#include "kernel/base/hash.h"
#include "kernel/base/text.h"

namespace rubble {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr const char* kKindNames[] = {"run", "settle", "render"};
constexpr const char* kSpreadNames[] = {"uniform", "normal", "lognormal"};

std::string compact(const std::string& json) { return Json::parse(json).dump(); }

Json json_of(const SourceFile& file) {
  return {{"name", file.path}, {"sha256", file.sha256}, {"text", file.text}};
}

Json json_of(const AssetContent& asset) {
  return {{"name", asset.name},
          {"pack", asset.pack},
          {"sha256", asset.sha256},
          {"weight", asset.weight},
          {"scale", asset.scale},
          {"spread", kSpreadNames[int(asset.spread.kind)]},
          {"typical", asset.spread.typical},
          {"deviation", asset.spread.deviation}};
}

SourceFile read_source(const JsonMembers& json) {
  return {json.text("name"), json.text("text"), json.text("sha256")};
}

SizeDistribution read_spread(const JsonMembers& json) {
  const std::string name = json.text("spread");
  for (int i = 0; i < 3; ++i)
    if (name == kSpreadNames[i]) return {Spread(i), json.number("typical"), json.number("deviation")};
  json.fail("spread", "\"uniform\", \"normal\" or \"lognormal\"");
}

std::array<double, 2> read_scale(const JsonMembers& json) {
  const std::vector<JsonMembers> scale = json.list("scale");
  if (scale.size() != 2) json.fail("scale", "two numbers");
  const std::array<double, 2> range{scale[0].as_number(), scale[1].as_number()};
  if (!(range[0] > 0 && range[0] <= range[1])) json.fail("scale", "two numbers, 0 < least <= most");
  return range;
}

AssetContent read_asset(const JsonMembers& json) {
  const double weight = json.number("weight");
  if (!(weight >= 0)) json.fail("weight", "a number of at least 0");
  return {json.text("name"), json.text("pack"),  json.text("sha256"),
          weight,            read_scale(json), read_spread(json)};
}

RunKind read_kind(const JsonMembers& json) {
  const std::string name = json.text("kind");
  for (int i = 0; i < 3; ++i)
    if (name == kKindNames[i]) return RunKind(i);
  json.fail("kind", "\"run\", \"settle\" or \"render\"");
}

Provenance read_provenance(const JsonMembers& json) {
  Provenance provenance;
  provenance.kind = read_kind(json);
  provenance.script = read_source(json.object("script"));
  for (const JsonMembers& file : json.list("included"))
    provenance.included.push_back(read_source(file));
  const JsonMembers request = json.object("request");
  if (request.has("seed")) provenance.seed = request.unsigned_integer("seed");
  for (const JsonMembers& text : request.list("set"))
    provenance.overrides.push_back(text.as_text());
  provenance.scenario = json.object("scenario").dump();
  for (const JsonMembers& asset : json.list("assets"))
    provenance.assets.push_back(read_asset(asset));
  if (json.has("robots"))
    for (const JsonMembers& robot : json.list("robots"))
      provenance.robots.push_back({robot.text("urdf"), robot.text("sha256")});
  if (json.has("snapshot"))
    provenance.snapshot = SnapshotContent{json.object("snapshot").text("file"), json.object("snapshot").text("sha256")};
  if (json.has("pile_from"))
    provenance.pile_from =
        std::make_shared<const Provenance>(read_provenance(json.object("pile_from")));
  return provenance;
}

}  // namespace

Provenance make_provenance(RunKind kind, const Mission& mission, const MissionOptions& options) {
  Provenance provenance;
  provenance.kind = kind;
  const fs::path folder = fs::path(mission.script.path).parent_path();
  provenance.script = mission.script;
  provenance.script.path = printable(fs::path(mission.script.path).filename().string());
  for (SourceFile file : mission.included) {
    file.path = printable(fs::path(file.path).lexically_relative(folder).lexically_normal().string());
    provenance.included.push_back(std::move(file));
  }
  provenance.seed = options.seed;
  provenance.overrides = options.overrides;
  provenance.scenario = compact(scenario_to_json(mission.scenario));
  return provenance;
}

Mission load_mission(const Provenance& provenance) {
  MissionOptions options;
  options.seed = provenance.seed;
  options.overrides = provenance.overrides;
  options.included.emplace();
  for (const SourceFile& file : provenance.included) (*options.included)[file.path] = file.text;
  Mission mission = load_mission_text(provenance.script.text, provenance.script.path, options);
  if (provenance.pile_from) adopt_pile(mission.scenario, stated_scenario(*provenance.pile_from));
  return mission;
}

Scenario stated_scenario(const Provenance& provenance) {
  Scenario scenario = scenario_from_json(provenance.scenario, "the scenario of " + provenance.script.path);
  if (provenance.pile_from) scenario.kept_pile_seed = stated_scenario(*provenance.pile_from).pile_seed();
  return scenario;
}

void adopt_pile(Scenario& scenario, const Scenario& pile_source) {
  scenario.packs = pile_source.packs;
  scenario.pile = pile_source.pile;
  scenario.victims = pile_source.victims;
  scenario.fines = pile_source.fines;
  scenario.settle = pile_source.settle;
  scenario.kept_pile_seed = pile_source.pile_seed();
}

void add_provenance(Json& json, const Provenance& provenance) {
  json["kind"] = kKindNames[int(provenance.kind)];
  json["script"] = json_of(provenance.script);
  json["included"] = Json::array();
  for (const SourceFile& file : provenance.included) json["included"].push_back(json_of(file));
  json["request"] = Json::object();
  if (provenance.seed) json["request"]["seed"] = *provenance.seed;
  json["request"]["set"] = provenance.overrides;
  json["scenario"] = Json::parse(provenance.scenario);
  json["assets"] = Json::array();
  for (const AssetContent& asset : provenance.assets) json["assets"].push_back(json_of(asset));
  for (const RobotContent& robot : provenance.robots)
    json["robots"].push_back({{"urdf", robot.urdf}, {"sha256", robot.sha256}});
  if (provenance.snapshot) json["snapshot"] = {{"file", provenance.snapshot->file}, {"sha256", provenance.snapshot->sha256}};
  if (!provenance.pile_from) return;
  json["pile_from"] = Json::object();
  add_provenance(json["pile_from"], *provenance.pile_from);
}

Provenance provenance_from_json(const Json& json, const std::string& file) {
  return read_provenance(JsonMembers(json, file));
}

}  // namespace rubble
