#include "scripting/files/calibration_values.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>

#include "kernel/base/error.h"
#include "kernel/base/tables/text_table.h"

namespace rubble {
namespace {

constexpr int kDeepestYaml = 50;
constexpr std::size_t kMostYamlValues = 1'000'000;  // an anchor may stand for many
constexpr std::size_t kLargestYaml = std::size_t(4) << 20;  // unit: byte

Value value_of_scalar(const YAML::Node& node) {
  const std::string text = node.Scalar();
  if (node.Tag() == "!") return Value::make_text(text);  // it has quotes
  if (const auto number = parse_number(text); number && std::isfinite(*number)) return Value::make_number(*number);
  if (text == "true" || text == "True") return Value::make_boolean(true);
  if (text == "false" || text == "False") return Value::make_boolean(false);
  return Value::make_text(text);
}

Value value_of_node(const YAML::Node& node, int depth, std::size_t& count, const std::string& path) {
  if (depth > kDeepestYaml || ++count > kMostYamlValues)
    throw InputError({path, node.Mark().line + 1, "", "holds too much", "at most 50 levels and a million values", "", ""});
  if (node.IsScalar()) return value_of_scalar(node);
  Value value = Value::make_table();
  if (node.IsSequence())
    for (const YAML::Node& item : node) value.items.push_back(value_of_node(item, depth + 1, count, path));
  if (node.IsMap())
    for (const auto& entry : node)
      if (entry.first.IsScalar()) value.set(entry.first.Scalar(), value_of_node(entry.second, depth + 1, count, path));
  return value;
}

}  // namespace

Value parse_yaml(std::string_view text, const std::string& path) {
  text = skip_byte_order_mark(text);
  if (text.size() > kLargestYaml) throw InputError({path, 0, "", "is too large", "at most 4 MiB of YAML or JSON", "", ""});
  std::string plain(text);
  // OpenCV's own first line, which YAML does not know. The line number stays.
  if (plain.rfind("%YAML:", 0) == 0) plain[0] = '#';
  // Brackets are nested by recursion in the parser; the depth of indented maps is bounded there.
  std::size_t open = 0, deepest = 0;
  for (const char c : plain) {
    if (c == '[' || c == '{') deepest = std::max(deepest, ++open);
    if ((c == ']' || c == '}') && open > 0) --open;
  }
  if (deepest > std::size_t(kDeepestYaml))
    throw InputError({path, 0, "", "is nested too deeply", "at most 50 levels", std::to_string(deepest), ""});
  try {
    std::size_t count = 0;
    return value_of_node(YAML::Load(plain), 0, count, path);
  } catch (const YAML::Exception& error) {
    throw InputError({path, error.mark.line + 1, "", "is neither YAML nor JSON: " + error.msg, "", "", ""});
  }
}

}  // namespace rubble
