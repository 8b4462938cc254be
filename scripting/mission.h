// From a mission script to a checked Scenario.
//
//   return rubble.mission {
//     seed = 7,
//     pile = { layers = 2 },
//   }
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scripting/sandbox/lua_sandbox.h"
#include "scripting/sandbox/source_map.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

struct MissionOptions {
  std::optional<std::uint64_t> seed;   // instead of the script's
  // "key=value", in order: of keys of the mission (apply_override in schema.h), of parameters that the script declares,
  // and of options of functions that it calls (LuaSandbox::set_overrides).
  std::vector<std::string> overrides;
  // What rubble.include reads, by path relative to the script, instead of files.
  std::optional<std::map<std::string, std::string>> included;
  SandboxLimits limits;  // of memory, instructions and time
};

struct Mission {
  Scenario scenario;                                       // complete: with every default
  SourceFile script;                                       // path as given, text, SHA-256
  std::vector<SourceFile> included;                        // files that the script took in by rubble.include
  std::vector<std::string> printed;                        // lines that the script printed
  SourceMap lines;                                         // where each key was written
  std::vector<std::pair<std::string, std::string>> drawn;  // by rubble.random: LuaSandbox::drawn
  std::map<std::string, std::string> parameters{};         // that the script declared: LuaSandbox::parameters
  std::vector<Diagnostic> idle_keys{};                     // that it or --set states in vain: find_idle_keys()
};

// What is allowed and hardly meant, each with file and line: an angle that looks like radians, keys that nothing reads.
std::vector<std::string> find_suspicious(const Mission& mission);

// Throws InputError with every mistake in the script and in the overrides; a file that cannot be
// read is one, too.
Mission load_mission(const std::string& path, const MissionOptions& options = {});
// The same for a text that is at hand, as from a manifest; `path` names it.
Mission load_mission_text(const std::string& text, const std::string& path,
                          const MissionOptions& options = {});

// Gives a sandbox the overrides that are no keys of the mission. Before it runs the script.
void give_overrides(const std::vector<std::string>& overrides, LuaSandbox& sandbox);

// Throws InputError with the line of every asset that a mission names and no pack has.
void check_assets(const Mission& mission, const std::vector<std::string>& names);

// Likewise of every material of a box that materials.lua lacks.
void check_materials(const Mission& mission, const std::vector<std::string>& names);

// The mission's pack folders, relative ones taken from the script's folder.
std::vector<std::string> pack_folders(const Mission& mission);

}  // namespace rubble
