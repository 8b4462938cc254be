#include "io/robot/urdf_elements.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

constexpr std::size_t kMostLines = 12;  // of one warning

// What is lost with elements that are known and not simulated.
const char* what_is_lost(const std::string& element) {
  static const std::pair<const char*, const char*> kLost[] = {
      {"transmission", "motors act on joints, without gears"},
      {"gazebo", "settings and plugins of Gazebo"},
      {"ros2_control", "a mission has its own controllers"},
      {"sensor", "sensors are in the mission: `cameras`, `imus` and so on (docs/reference/sensors.md)"},
      {"safety_controller", "limits are those of <limit>"},
      {"calibration", "encoders start calibrated"},
      {"texture", "surfaces of URDF materials have one colour"},
  };
  for (const auto& [name, lost] : kLost)
    if (element == name) return lost;
  return "not an element that this reader knows";
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

// The whole text as one number.
bool parse(const std::string& text, double& out) {
  const char *first = text.data(), *last = first + text.size();
  if (first != last && *first == '+' && last - first > 1 && first[1] != '-') ++first;
  const auto [end, error] = std::from_chars(first, last, out);
  return error == std::errc() && end == last && first != last && !std::isnan(out);
}

bool is_of_xacro(const std::string& text) {
  return text.find("${") != std::string::npos || text.find("$(") != std::string::npos;
}

std::string lines_text(const std::vector<int>& lines) {
  std::string text = " (lines";
  for (std::size_t i = 0; i < std::min(lines.size(), kMostLines); ++i)
    text += (i > 0 ? ", " : " ") + std::to_string(lines[i]);
  if (lines.size() > kMostLines) text += " and " + std::to_string(lines.size() - kMostLines) + " more";
  return text + ")";
}

}  // namespace

void UrdfElements::mistake(int line, const std::string& message, const std::string& expected,
                           const std::string& found, const std::string& hint) {
  mistakes_.push_back({path_, line, owner_, message, expected, found, hint});
}

void UrdfElements::warn(int line, const std::string& text) { warnings_.emplace_back(line, text); }

void UrdfElements::leave_out(const XmlElement& element, const std::string& parent) {
  left_out_[{parent, element.name}].push_back(element.line);
}

void UrdfElements::expect(const XmlElement& element, std::initializer_list<const char*> attributes,
                          std::initializer_list<const char*> children) {
  const auto known = [](std::initializer_list<const char*> list, const std::string& name) {
    return std::find(list.begin(), list.end(), name) != list.end();
  };
  for (const auto& attribute : element.attributes) {
    const std::string& name = attribute.first;
    if (known(attributes, name) || name == "xmlns" || name.compare(0, 6, "xmlns:") == 0) continue;
    left_out_[{element.name, "@" + name}].push_back(element.line);
  }
  for (const XmlElement& child : element.children) {
    if (!known(children, child.name)) leave_out(child, element.name);
    else if (!known({"link", "joint", "material", "visual", "collision"}, child.name) &&
             &child != element.child(child.name))
      warn(child.line, "a second <" + child.name + "> in <" + element.name + "> is left out: the first counts");
  }
}

std::string UrdfElements::name_of(const XmlElement& element, const char* attribute) {
  const std::string* name = element.find(attribute);
  if (name && std::any_of(name->begin(), name->end(), [](char c) { return !is_blank(c); })) return *name;
  mistake(element.line, "<" + element.name + "> has no name", std::string("an attribute `") + attribute + "`",
          name ? "an empty one" : "none");
  return "";
}

void UrdfElements::not_a_number(const XmlElement& element, const std::string& attribute, const std::string& expected,
                                const std::string& found) {
  mistake(element.line, "`" + attribute + "` of <" + element.name + "> cannot be read", expected, "\"" + found + "\"",
          is_of_xacro(found) ? "it is an expression of xacro: expand the file with the xacro tool" : "");
}

double UrdfElements::number(const XmlElement& element, const char* attribute, double otherwise, bool required,
                            bool endless) {
  const std::string* text = element.find(attribute);
  if (!text) {
    if (required)
      mistake(element.line, "<" + element.name + "> has no `" + attribute + "`", "a number", "none");
    return otherwise;
  }
  const std::vector<double> numbers = numbers_in(*text);
  if (numbers.size() == 1 && (endless || std::isfinite(numbers[0]))) return numbers[0];
  not_a_number(element, attribute, "a number", *text);
  return otherwise;
}

Vec3 UrdfElements::vector(const XmlElement& element, const char* attribute, const Vec3& otherwise, bool required) {
  const std::string* text = element.find(attribute);
  if (!text) {
    if (required)
      mistake(element.line, "<" + element.name + "> has no `" + attribute + "`", "three numbers", "none");
    return otherwise;
  }
  std::vector<double> n = numbers_in(*text);
  if (n.empty() && text->find(',') != std::string::npos) {
    std::string blanks = *text;
    std::replace(blanks.begin(), blanks.end(), ',', ' ');
    n = numbers_in(blanks);
    if (n.size() == 3)
      warn(element.line, std::string("`") + attribute + "` of <" + element.name + "> has commas: taken for blanks");
  }
  if (n.size() == 3 && std::all_of(n.begin(), n.end(), [](double x) { return std::abs(x) <= kUrdfFarthest; }))
    return {n[0], n[1], n[2]};
  const bool far = n.size() == 3 && std::all_of(n.begin(), n.end(), [](double x) { return std::isfinite(x); });
  not_a_number(element, attribute, far ? "numbers from -10000 to 10000" : "three numbers, with blanks between them", *text);
  return otherwise;
}

Vec3 UrdfElements::scale(const XmlElement& element) {
  const std::string* text = element.find("scale");
  const std::vector<double> n = text ? numbers_in(*text) : std::vector<double>{};
  if (n.size() != 4 || n[3] != 1 || !std::all_of(n.begin(), n.end(), [](double x) { return std::isfinite(x); }))
    return vector(element, "scale", {1, 1, 1});
  warn(element.line, "`scale` of <" + element.name + "> has four numbers: the last, 1, is left out");
  return {n[0], n[1], n[2]};
}

std::vector<double> UrdfElements::numbers_in(const std::string& text) {
  std::vector<double> numbers;
  for (std::size_t at = 0; at < text.size();) {
    if (is_blank(text[at])) {
      ++at;
      continue;
    }
    std::size_t end = at;
    while (end < text.size() && !is_blank(text[end])) ++end;
    if (!parse(text.substr(at, end - at), numbers.emplace_back())) return {};
    at = end;
  }
  return numbers;
}

Pose UrdfElements::origin(const XmlElement& element) {
  const XmlElement* origin = element.child("origin");
  if (!origin) return {};
  expect(*origin, {"xyz", "rpy", "quat_xyzw"}, {});
  const Vec3 position = vector(*origin, "xyz", {}), rpy = vector(*origin, "rpy", {});
  const std::string* quaternion = origin->find("quat_xyzw");
  if (!quaternion) return {normalized(portable::quat_from_rpy(rpy.x, rpy.y, rpy.z)), position};
  const std::vector<double> q = numbers_in(*quaternion);
  if (q.size() == 4 && !origin->find("rpy")) {
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (std::abs(length - 1) < 1e-3) return {normalized(Quat{q[3], q[0], q[1], q[2]}), position};
  }
  not_a_number(*origin, "quat_xyzw", "a unit quaternion x y z w, without `rpy` beside it", *quaternion);
  return {{}, position};
}

void UrdfElements::throw_mistakes() {
  if (!mistakes_.empty()) throw InputError(std::move(mistakes_));
}

std::vector<std::string> UrdfElements::take_warnings() {
  for (auto& [names, lines] : left_out_) {
    const auto& [parent, name] = names;
    std::sort(lines.begin(), lines.end());
    lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
    const std::string several = lines.size() > 1 ? lines_text(lines) : "";
    if (name[0] == '@')
      warn(lines[0], "the attribute `" + name.substr(1) + "` of <" + parent + "> is left out" + several);
    else
      warn(lines[0], "<" + name + "> " + (parent == "robot" ? "" : "in <" + parent + "> ") + "is left out" + several +
                         ": " + what_is_lost(name));
  }
  left_out_.clear();
  std::sort(warnings_.begin(), warnings_.end());
  warnings_.erase(std::unique(warnings_.begin(), warnings_.end()), warnings_.end());
  std::vector<std::string> texts;
  for (const auto& [line, text] : warnings_) texts.push_back(path_ + ":" + std::to_string(line) + ": " + text);
  warnings_.clear();
  return texts;
}

}  // namespace rubble
