#include "app/mission/scenario_lua.h"

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

namespace rubble {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kWidth = 120;  // a table that is no longer than this stays on its line

bool is_narrow(const Json& json) {
  bool flat = true;
  for (const Json& member : json) flat = flat && (!member.is_structured() || member.empty());
  return flat || json.dump().size() < kWidth;
}

// Lua reads JSON's numbers to the same bits; of JSON's strings it lacks only \/ and \u, which do not
// come up in what dump() escapes but for control characters.
std::string quote(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    char escaped[8];
    std::snprintf(escaped, sizeof escaped, "\\%03d", int(static_cast<unsigned char>(c)));
    const bool plain = static_cast<unsigned char>(c) >= 32 && c != '"' && c != '\\';
    out += plain ? std::string(1, c) : std::string(escaped);
  }
  return out + "\"";
}

void write(const Json& json, const std::string& indent, std::string& out);

// {a, b}, {name = value}; members that are null are not set. Long tables take a line a member.
void write_table(const Json& json, const std::string& indent, std::string& out) {
  const bool wide = !is_narrow(json);
  const std::string inner = indent + "  ";
  bool first = true;
  out += "{";
  for (const auto& [name, member] : json.items()) {
    if (member.is_null()) continue;
    if (!first) out += ",";
    out += wide ? "\n" + inner : " ";
    if (json.is_object()) out += name + " = ";
    write(member, inner, out);
    first = false;
  }
  out += first ? "}" : wide ? ",\n" + indent + "}" : " }";
}

void write(const Json& json, const std::string& indent, std::string& out) {
  if (json.is_structured())
    write_table(json, indent, out);
  else
    out += json.is_string() ? quote(json.get<std::string>()) : json.dump();
}

}  // namespace

std::string scenario_to_lua(const Scenario& scenario, const std::string& comment) {
  std::string out;
  std::istringstream lines(comment);
  for (std::string line; std::getline(lines, line);) out += "-- " + line + "\n";
  out += "return rubble.mission ";
  write(Json::parse(scenario_to_json(scenario)), "", out);
  return out + "\n";
}

namespace {

namespace fs = std::filesystem;

std::string whole(const fs::path& path) { return fs::absolute(path).lexically_normal().string(); }

}  // namespace

Scenario with_whole_paths(Scenario scenario, const AssetLibrary& assets, bool packs) {
  std::error_code failed;
  if (packs || !scenario.packs.empty()) {
    scenario.packs.clear();
    // The folders of other files are among them.
    for (const std::string& folder : assets.folders)
      if (fs::is_regular_file(fs::path(folder) / "pack.lua", failed)) scenario.packs.push_back(whole(folder));
  }
  std::string& terrain = scenario.pile.terrain.file;
  for (const std::string& folder : assets.folders)
    if (!terrain.empty() && fs::is_regular_file(fs::path(folder) / terrain, failed)) terrain = whole(fs::path(folder) / terrain);
  if (scenario.pile.snapshot) scenario.pile.snapshot = whole(assets.snapshot_file);
  for (std::size_t i = 0; i < scenario.robots.size(); ++i)
    if (!scenario.robots[i].urdf.empty()) scenario.robots[i].urdf = whole(assets.robot_files.at(i));
  return scenario;
}

}  // namespace rubble
