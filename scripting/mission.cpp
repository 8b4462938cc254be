#include "scripting/mission.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "kernel/base/hash.h"
#include "kernel/base/number_text.h"
#include "kernel/robot/step_rate.h"
#include "scripting/sandbox/script_file.h"
#include "scripting/scenario/idle_keys.h"
#include "scripting/scenario/mission_form.h"
#include "scripting/schema/override_text.h"

namespace rubble {
namespace {

// "pile" of "pile.mix[1].weight=2".
std::string first_word(const std::string& text) { return text.substr(0, text.find_first_of(".[=")); }

// The first words of the keys of a mission.
std::vector<std::string> mission_words() {
  MissionForm form;
  const Schema schema = make_scenario_schema(form);
  std::vector<std::string> words;
  for (const Key& key : schema.keys()) words.push_back(first_word(key.path));
  for (const Alias& alias : schema.aliases()) words.push_back(alias.name);
  std::sort(words.begin(), words.end());
  words.erase(std::unique(words.begin(), words.end()), words.end());
  return words;
}

// A key of the mission; anything else is for the script.
bool is_for_script(const std::string& override_text, const std::vector<std::string>& words) {
  const std::size_t equals = override_text.find('=');
  return equals != std::string::npos && equals > 0 &&
         !std::binary_search(words.begin(), words.end(), first_word(override_text));
}

// The seed that rubble.random uses while the script runs: before its table is known, only a number
// that stands in it literally can be.
std::uint64_t seed_for_script(const SourceMap& lines, const MissionOptions& options) {
  MissionForm form;
  std::vector<Diagnostic> ignored;  // reported when the scenario itself is read
  for (const char* key : {"seed", "randomseed"})
    if (const auto literal = lines.literal_of(key); literal && *literal >= 0)
      form.rest.seed = std::uint64_t(*literal);
  const Schema schema = make_scenario_schema(form);
  for (const std::string& text : options.overrides) apply_override(schema, text, ignored);
  return options.seed.value_or(form.rest.seed);
}

void require_table(const Value& value, const SourceFile& script, const SourceMap& lines) {
  if (value.kind == Value::Kind::table) return;
  throw InputError({script.path, lines.line_of(""), "", "the script does not return a mission",
                    "return rubble.mission { ... }", describe(value), ""});
}

void check_seed(const LuaSandbox& sandbox, std::uint64_t used, std::uint64_t stated,
                std::vector<Diagnostic>& mistakes) {
  if (!sandbox.used_random() || stated == used) return;
  mistakes.push_back({"", 0, "seed", "random numbers were drawn before the seed was known",
                      "a plain number in the mission's table", "", "or give it with --seed"});
}

void check_asset(const std::string& name, const std::string& key,
                 const std::vector<std::string>& names, std::vector<Diagnostic>& mistakes) {
  for (const std::string& known : names)
    if (known == name) return;
  const std::string near = nearest_name(name, names);
  mistakes.push_back({"", 0, key, "unknown asset `" + name + "`", "", "",
                      near.empty() ? "the packs have " + std::to_string(names.size()) + " assets"
                                   : "did you mean `" + near + "`?"});
}

std::string placed_key(std::size_t i, const char* name) {
  return "pile.placed[" + std::to_string(i + 1) + "]." + name;
}

// Functions are in no text: one that a program has made of a mission has their numbers alone.
void check_controllers(const std::vector<RobotItem>& robots, int registered, std::vector<Diagnostic>& mistakes) {
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (robots[i].control <= registered) continue;
    mistakes.push_back({"", 0, "robots[" + std::to_string(i + 1) + "].control",
                        "the script registers no function " + std::to_string(robots[i].control),
                        "what rubble.controller(function) returned", std::to_string(robots[i].control),
                        "a function cannot stand outside the script"});
  }
}

// The last --set of a key counts, as in `rubble run mission.lua --set pile.layers=2 "$@"`.
void add_replaced(const std::vector<std::string>& overrides, std::vector<Diagnostic>& idle_keys) {
  std::map<std::string, std::string> last;
  for (const std::string& text : overrides) last[text.substr(0, text.find('='))] = text;
  for (const std::string& text : overrides) {
    const std::string& counts = last[text.substr(0, text.find('='))];
    if (counts != text)
      idle_keys.push_back({"", 0, "--set", text + " has no effect, because --set " + counts + " follows", "", "", ""});
  }
}

}  // namespace

void give_overrides(const std::vector<std::string>& overrides, LuaSandbox& sandbox) {
  const std::vector<std::string> words = mission_words();
  std::vector<std::string> given;
  for (const std::string& text : overrides)
    if (is_for_script(text, words)) given.push_back(text);
  sandbox.set_overrides(given, words);
}

Mission load_mission(const std::string& path, const MissionOptions& options) {
  return load_mission_text(read_script(path).text, path, options);
}

Mission load_mission_text(const std::string& text, const std::string& path,
                          const MissionOptions& options) {
  const SourceMap lines(text, "mission");
  Mission mission{{}, {path, text, sha256(text)}, {}, {}, lines, {}};
  const std::uint64_t seed = seed_for_script(lines, options);
  LuaSandbox sandbox(seed, "rubble.mission", options.limits);
  if (options.included) sandbox.serve_includes(*options.included);
  give_overrides(options.overrides, sandbox);
  const Value table = run_script(sandbox, mission.script, lines);
  mission.included = sandbox.included();
  mission.printed = sandbox.take_printed();
  mission.drawn = sandbox.drawn();
  mission.parameters = sandbox.parameters();
  require_table(table, mission.script, lines);

  MissionForm form;
  const Schema schema = make_scenario_schema(form);
  std::vector<Diagnostic> mistakes = sandbox.mistakes();
  StatedKeys stated;
  read_table(schema, table, mistakes, &stated.in_script);
  const std::vector<std::string> words = mission_words();
  for (const std::string& override_text : options.overrides) {
    if (is_for_script(override_text, words)) continue;
    apply_override(schema, override_text, mistakes);
    stated.by_set.push_back(override_path(schema, override_text));
  }
  for (const auto& [override_text, hint] : sandbox.unused_overrides()) {
    std::vector<Diagnostic> unknown;
    apply_override(schema, override_text, unknown);
    for (Diagnostic& d : unknown) {
      const bool knows = d.hint.rfind("did you mean", 0) == 0, better = hint.rfind("did you mean", 0) == 0;
      if (better || (!knows && !hint.empty())) d.hint = hint;
      mistakes.push_back(std::move(d));
    }
  }
  if (options.seed) form.rest.seed = *options.seed;
  check_seed(sandbox, seed, form.rest.seed, mistakes);
  add_duplicates(lines, mistakes);
  check_controllers(form.rest.robots, sandbox.controllers(), mistakes);
  add_unrelated(find_mistakes(form), mistakes);
  locate(mistakes, path, lines);
  throw_if_any(std::move(mistakes));
  mission.idle_keys = find_idle_keys(form, stated);
  locate(mission.idle_keys, path, lines);
  add_replaced(options.overrides, mission.idle_keys);
  mission.scenario = form.normalized();
  return mission;
}

void check_assets(const Mission& mission, const std::vector<std::string>& names) {
  std::vector<Diagnostic> mistakes;
  const PileScenario& pile = mission.scenario.pile;
  const auto key = [](const char* list, std::size_t i) {
    return std::string("pile.") + list + "[" + std::to_string(i + 1) + "].asset";
  };
  for (std::size_t i = 0; i < pile.mix.size(); ++i)
    check_asset(pile.mix[i].asset, key("mix", i), names, mistakes);
  for (std::size_t i = 0; i < pile.furniture.size(); ++i)
    check_asset(pile.furniture[i].asset, key("building.furniture", i), names, mistakes);
  for (std::size_t i = 0; i < pile.placed.size(); ++i)
    if (!pile.placed[i].box)
      check_asset(pile.placed[i].asset, key("placed", i), names, mistakes);
  locate(mistakes, mission.script.path, mission.lines);
  throw_if_any(std::move(mistakes));
}

void check_materials(const Mission& mission, const std::vector<std::string>& names) {
  std::vector<Diagnostic> mistakes;
  const auto check = [&](const std::string& name, const std::string& key) {
    if (std::find(names.begin(), names.end(), name) != names.end()) return;
    const std::string near = nearest_name(name, names);
    mistakes.push_back({"", 0, key, "unknown material `" + name + "`", "", "",
                        near.empty() ? "materials.lua lists those there are"
                                     : "did you mean `" + near + "`?"});
  };
  const PileScenario& pile = mission.scenario.pile;
  for (std::size_t i = 0; i < pile.mix.size(); ++i)
    for (std::size_t k = 0; k < pile.mix[i].materials.size(); ++k)
      check(pile.mix[i].materials[k].material, "pile.mix[" + std::to_string(i + 1) + "].materials[" +
                                                   std::to_string(k + 1) + "].material");
  for (std::size_t i = 0; i < pile.placed.size(); ++i)
    if (pile.placed[i].box) check(pile.placed[i].material, placed_key(i, "material"));
  locate(mistakes, mission.script.path, mission.lines);
  throw_if_any(std::move(mistakes));
}

std::vector<std::string> find_suspicious(const Mission& mission) {
  constexpr double kLargestInRadians = 3.2;  // pi; unit: rad
  std::vector<std::string> sentences;
  for (const Diagnostic& idle : mission.idle_keys) sentences.push_back(idle.text());
  for (const MountedCamera& camera : mission.scenario.cameras) {
    const std::string key = camera.key() + ".fov_deg";
    if (camera.camera.fov_deg <= kLargestInRadians)
      sentences.push_back(Diagnostic{mission.script.path, mission.lines.line_of(key), key,
                                     exact_text(camera.camera.fov_deg) + " degrees is very narrow", "", "",
                                     "is it in radians?"}
                              .text());
  }
  const double asked = mission.scenario.robot_run.control_hz, used = used_rate(asked, kUsualRobotStep);
  if (!mission.scenario.robots.empty() && std::abs(used - asked) > 1e-9 * asked)
    sentences.push_back(Diagnostic{mission.script.path, mission.lines.line_of("robot_run.control_hz"), "robot_run.control_hz",
                                   "commands and recordings have another rate", "a rate that divides 240 Hz, that of the simulation's steps",
                                   plain_text(asked), "it is taken as " + brief_text(used) + " Hz"}
                            .text());
  return sentences;
}

std::vector<std::string> pack_folders(const Mission& mission) {
  const std::filesystem::path beside = std::filesystem::path(mission.script.path).parent_path();
  std::vector<std::string> folders;
  for (const std::string& pack : mission.scenario.packs)
    folders.push_back((beside / pack).lexically_normal().string());
  return folders;
}

}  // namespace rubble
