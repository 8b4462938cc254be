#include "app/provenance/compare.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "kernel/base/error.h"
#include "kernel/base/hash.h"
#include "kernel/base/read_file.h"
#include "scripting/scenario/scenario.h"

namespace rubble {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kNotThere = "not there";

std::string join(const std::string& path, const std::string& name) {
  return path.empty() ? name : path + "." + name;
}

void add_differences(const std::string& path, const Json& was, const Json& is, std::vector<Difference>& found) {
  const auto shown = [](const Json& json) { return json.dump().substr(0, 80); };
  if (was == is) return;
  if (was.is_object() && is.is_object()) {
    for (const auto& [name, value] : was.items()) {
      if (is.contains(name)) add_differences(join(path, name), value, is[name], found);
      else found.push_back({join(path, name), shown(value), kNotThere});
    }
    for (const auto& [name, value] : is.items())
      if (!was.contains(name)) found.push_back({join(path, name), kNotThere, shown(value)});
  } else if (was.is_array() && is.is_array() && was.size() == is.size()) {
    for (std::size_t i = 0; i < was.size(); ++i)
      add_differences(path + "[" + std::to_string(i + 1) + "]", was[i], is[i], found);
  } else {
    found.push_back({path, shown(was), shown(is)});
  }
}

constexpr std::size_t kDigestDigits = 8;

struct Field {
  const char* name;
  double was, is;
};

std::vector<Field> fields_of(const PieceState& was, const PieceState& is) {
  std::vector<Field> fields{{"type", double(was.type), double(is.type)},
                            {"layer", double(was.layer), double(is.layer)},
                            {"scale", was.scale, is.scale},
                            {"status", double(was.status), double(is.status)}};
  const auto add = [&fields](std::array<const char*, 3> names, const Vec3& a, const Vec3& b) {
    for (int i = 0; i < 3; ++i) fields.push_back({names[std::size_t(i)], a[i], b[i]});
  };
  const Quat &q = was.world_from_body.rotation, &r = is.world_from_body.rotation;
  fields.push_back({"rotation w", q.w, r.w});
  add({"rotation x", "rotation y", "rotation z"}, {q.x, q.y, q.z}, {r.x, r.y, r.z});
  add({"position x", "position y", "position z"}, was.world_from_body.translation,
      is.world_from_body.translation);
  add({"velocity x", "velocity y", "velocity z"}, was.linear_velocity, is.linear_velocity);
  add({"angular velocity x", "angular velocity y", "angular velocity z"}, was.angular_velocity,
      is.angular_velocity);
  return fields;
}

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

std::string describe_piece(const PileState& pile, std::size_t i) {
  const std::size_t type = std::size_t(pile.pieces[i].type);
  return "piece " + std::to_string(i) +
         (type < pile.types.size() ? " (" + pile.types[type] + ")" : "");
}

std::ifstream open_to_compare(const std::string& path) {
  check_readable_file(path);
  std::ifstream in(path, std::ios::binary);
  if (!in) throw RunError("cannot read " + path);
  return in;
}

}  // namespace

std::vector<Difference> list_differences(const Json& was, const Json& is) {
  std::vector<Difference> found;
  add_differences("", was, is, found);
  return found;
}

std::vector<Difference> list_differences(const Scenario& was, const Scenario& is) {
  return list_differences(Json::parse(scenario_to_json(was)), Json::parse(scenario_to_json(is)));
}

std::string describe_difference(const Json& was, const Json& is) {
  const std::vector<Difference> found = list_differences(was, is);
  if (found.empty()) return "";
  return (found[0].path.empty() ? "it" : found[0].path) + " is " + found[0].is + " instead of " + found[0].was;
}

std::string describe_difference(const PileState& was, const PileState& is) {
  char text[160];
  const std::size_t both = std::min(was.pieces.size(), is.pieces.size());
  for (std::size_t i = 0; i < both; ++i)
    for (const Field& field : fields_of(was.pieces[i], is.pieces[i])) {
      if (same_bits(field.was, field.is)) continue;
      std::snprintf(text, sizeof text,
                    " is the first that differs, in its %s: %.17g instead of %.17g", field.name,
                    field.is, field.was);
      return describe_piece(was, i) + text;
    }
  if (was.pieces.size() != is.pieces.size())
    return std::to_string(is.pieces.size()) + " pieces instead of " +
           std::to_string(was.pieces.size());
  if (was.steps != is.steps)
    return std::to_string(is.steps) + " steps instead of " + std::to_string(was.steps);
  return "";
}

std::string digest_pieces(const PileState& pile) {
  std::string digests;
  for (const PieceState& piece : pile.pieces) {
    std::string bytes;
    for (const Field& field : fields_of(piece, piece))
      bytes.append(reinterpret_cast<const char*>(&field.is), sizeof field.is);
    digests += hex64(hash64(bytes)).substr(0, kDigestDigits);
  }
  return digests;
}

std::string describe_first_piece(const std::string& was, const PileState& is) {
  const std::string found = digest_pieces(is);
  if (found == was) return "";
  for (std::size_t i = 0; i < is.pieces.size(); ++i) {
    const std::size_t at = i * kDigestDigits;
    if (was.compare(std::min(at, was.size()), kDigestDigits, found, at, kDigestDigits) != 0)
      return describe_piece(is, i) + " is the first that differs";
  }
  return "there are " + std::to_string(is.pieces.size()) + " pieces instead of " +
         std::to_string(was.size() / kDigestDigits);
}

std::string describe_difference_of_files(const std::string& was, const std::string& is) {
  std::ifstream a = open_to_compare(was), b = open_to_compare(is);
  std::vector<char> of_a(1 << 20), of_b(1 << 20);
  for (std::uint64_t at = 0;;) {
    a.read(of_a.data(), std::streamsize(of_a.size()));
    b.read(of_b.data(), std::streamsize(of_b.size()));
    const std::size_t both = std::size_t(std::min(a.gcount(), b.gcount()));
    const auto apart =
        std::mismatch(of_a.begin(), of_a.begin() + std::ptrdiff_t(both), of_b.begin());
    const std::uint64_t first = at + std::uint64_t(apart.first - of_a.begin());
    if (first < at + both) {
      char text[120];
      std::snprintf(text, sizeof text,
                    "byte %llu is the first that differs: 0x%02x instead of 0x%02x",
                    static_cast<unsigned long long>(first), unsigned(std::uint8_t(*apart.second)),
                    unsigned(std::uint8_t(*apart.first)));
      return text;
    }
    at += both;
    if (a.gcount() != b.gcount())
      return "it " + std::string(a.gcount() > b.gcount() ? "ends" : "goes on") +
             " where the other " + (a.gcount() > b.gcount() ? "goes on" : "ends") + ", at byte " +
             std::to_string(at);
    if (both == 0) return "";
  }
}

std::vector<std::string> describe_differences(const BuildInfo& was, const BuildInfo& is) {
  std::vector<std::string> lines;
  const auto compare = [&lines](const std::string& name, const std::string& a,
                                const std::string& b) {
    const auto shown = [](const std::string& s) { return s.empty() ? "none" : s; };
    if (a != b) lines.push_back(name + " " + shown(b) + " instead of " + shown(a));
  };
  compare("rubble", was.version, is.version);
  compare("commit", was.commit, is.commit);
  compare("compiler", was.compiler, is.compiler);
  compare("flags", was.flags, is.flags);
  compare("target", was.target, is.target);
  if (!was.simbody_bits.empty()) compare("Simbody's bits", was.simbody_bits, is.simbody_bits);
  std::map<std::string, std::string> names = was.libraries;
  names.insert(is.libraries.begin(), is.libraries.end());
  const auto version = [](const BuildInfo& build, const std::string& name) {
    const auto found = build.libraries.find(name);
    return found == build.libraries.end() ? std::string() : found->second;
  };
  for (const auto& item : names)
    compare(item.first, version(was, item.first), version(is, item.first));
  return lines;
}

}  // namespace rubble
