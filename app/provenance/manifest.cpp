#include "app/provenance/manifest.h"

#include <nlohmann/json.hpp>

#include "app/support/json_members.h"
#include "kernel/base/hash.h"

namespace rubble {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "rubble manifest 2";

// A part of the manifest that is sealed by itself, so that a change can be named.
struct Part {
  const char* name;
  std::vector<const char*> members;
};

const std::vector<Part>& sealed_parts() {
  static const std::vector<Part> parts{{"program", {"format", "program", "libraries"}},
                                       {"script", {"kind", "script", "included", "request"}},
                                       {"scenario", {"seed", "scenario", "pile_from"}},
                                       {"assets", {"assets", "robots"}},
                                       {"pile", {"state_hash", "pile"}},
                                       {"frames", {"frames", "frame_hashes"}},
                                       {"metrics", {"metrics"}},
                                       {"files", {"outputs"}}};
  return parts;
}

std::string seal_of(const Json& manifest, const Part& part) {
  Json content = Json::object();
  for (const char* member : part.members)
    if (manifest.contains(member)) content[member] = manifest[member];
  return sha256(content.dump());
}

Json describe_program(const BuildInfo& build) {
  return {{"name", "rubble"},           {"version", build.version}, {"commit", build.commit},
          {"compiler", build.compiler}, {"flags", build.flags},     {"target", build.target},
          {"simbody_bits", build.simbody_bits}};
}

Json describe_pile(const PileSummary& pile) {
  return {{"settled", pile.settled},
          {"pieces", pile.pieces},
          {"lost", pile.lost},
          {"steps", pile.steps},
          {"simulated_s", pile.simulated},
          {"layers_at_limit", pile.layers_at_limit}};
}

Json describe_frames(const FrameHashes& frames) {
  Json rows = Json::array();
  for (const auto& hashes : frames.frames) rows.push_back(format_hashes(hashes));
  return {{"channels", frames.channels}, {"xxh64", rows}};
}

BuildInfo read_program(const JsonMembers& json) {
  BuildInfo build;
  const JsonMembers program = json.object("program");
  build.version = program.text("version");
  build.commit = program.text("commit");
  build.compiler = program.text("compiler");
  build.flags = program.text("flags");
  build.target = program.text("target");
  if (program.has("simbody_bits")) build.simbody_bits = program.text("simbody_bits");
  for (const auto& [name, version] : json.object("libraries").members())
    build.libraries[name] = version.as_text();
  return build;
}

PileSummary read_pile(const JsonMembers& json) {
  const JsonMembers pile = json.object("pile");
  PileSummary summary;
  summary.state_hash = json.text("state_hash");
  summary.settled = pile.boolean("settled");
  summary.pieces = pile.integer("pieces");
  summary.lost = pile.integer("lost");
  summary.steps = pile.integer("steps");
  summary.layers_at_limit = pile.integer("layers_at_limit");
  summary.simulated = pile.number("simulated_s");
  return summary;
}

FrameHashes read_frames(const JsonMembers& json) {
  const JsonMembers table = json.object("frame_hashes");
  FrameHashes frames;
  for (const JsonMembers& channel : table.list("channels"))
    frames.channels.push_back(channel.as_text());
  for (const JsonMembers& row : table.list("xxh64")) {
    frames.frames.emplace_back();
    const bool read = parse_hashes(row.as_text(), frames.frames.back());
    if (!read || frames.frames.back().size() != frames.channels.size())
      table.fail("xxh64", "a hash for each channel in every row");
  }
  return frames;
}

void read_not_reproducible(const JsonMembers& json, Manifest& manifest) {
  for (const auto& [stage, seconds] : json.object("wall_s").members())
    manifest.wall_seconds[stage] = seconds.as_number();
  for (const auto& [name, value] : json.object("environment").members())
    manifest.environment[name] = value.as_text();
  for (const JsonMembers& folder : json.list("pack_folders"))
    manifest.pack_folders.push_back(folder.as_text());
}

void check_format(const JsonMembers& json, const std::string& file) {
  if (!json.has("format")) json.fail("format", std::string("\"") + kFormat + "\"");
  const std::string format = json.text("format");
  if (format != kFormat)
    throw InputError({file, 0, "format", "another format of manifest", kFormat, format,
                      "use the program that wrote it: " +
                          (json.has("program") ? json.object("program").dump() : "unknown")});
}

}  // namespace

PileSummary summarize(const PileState& pile) {
  PileSummary summary;
  summary.state_hash = hex64(pile.state_hash());
  summary.settled = pile.settled;
  summary.pieces = std::int64_t(pile.pieces.size());
  summary.lost = pile.lost;
  summary.steps = pile.steps;
  summary.layers_at_limit = pile.layers_at_limit;
  summary.simulated = pile.simulated;
  return summary;
}

std::string manifest_to_json(const Manifest& m) {
  Json json;
  json["format"] = kFormat;
  json["program"] = describe_program(m.program);
  json["seed"] = m.seed;
  json["state_hash"] = m.pile.state_hash;
  json["pile"] = describe_pile(m.pile);
  json["frames"] = m.frames.frames.size();
  json["metrics"] = m.metrics;
  json["warnings"] = m.warnings;
  json["outputs"] = m.outputs;
  add_provenance(json, m.provenance);
  json["libraries"] = m.program.libraries;
  json["frame_hashes"] = describe_frames(m.frames);
  json["seals"] = Json::object();
  for (const Part& part : sealed_parts()) json["seals"][part.name] = seal_of(json, part);
  json["not_reproducible"] = {
      {"wall_s", m.wall_seconds}, {"environment", m.environment}, {"pack_folders", m.pack_folders}};
  // The name of a folder may be no UTF-8.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Manifest manifest_from_json(const std::string& text, const std::string& file) {
  const Json json = parse_json_text(text, file);
  const JsonMembers members(json, file);
  check_format(members, file);
  Manifest m;
  m.program = read_program(members);
  m.provenance = provenance_from_json(json, file);
  m.seed = members.unsigned_integer("seed");
  m.pile = read_pile(members);
  m.frames = read_frames(members);
  for (const auto& [name, value] : members.object("metrics").members())
    m.metrics[name] = value.as_number();
  for (const auto& [name, hash] : members.object("outputs").members())
    m.outputs[name] = hash.as_text();
  if (members.has("warnings"))
    for (const JsonMembers& warning : members.list("warnings"))
      m.warnings.push_back(warning.as_text());
  read_not_reproducible(members.object("not_reproducible"), m);
  return m;
}

std::vector<std::string> find_altered_parts(const std::string& text, const std::string& file) {
  const Json json = parse_json_text(text, file);
  const JsonMembers seals = JsonMembers(json, file).object("seals");
  std::vector<std::string> altered;
  for (const Part& part : sealed_parts()) {
    const std::string found = seal_of(json, part), stated = seals.text(part.name);
    if (found == stated) continue;
    std::string members;
    for (const char* member : part.members)
      if (json.contains(member))
        members += (members.empty() ? "`" : ", `") + std::string(member) + "`";
    altered.push_back("the manifest's part " + std::string(part.name) + " (" + members +
                      ") was altered: its hash is " + found + ", its seal says " + stated);
  }
  return altered;
}

}  // namespace rubble
