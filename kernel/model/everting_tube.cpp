#include "kernel/model/everting_tube.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "kernel/model/range_check.h"

namespace rubble {

double EvertingTube::area() const { return portable::kPi * radius * radius; }
double EvertingTube::length() const { return links * link_length; }
double EvertingTube::mass_per_length() const {
  return 2 * (2 * portable::kPi * radius * membrane_density);
}
double EvertingTube::bending_stiffness() const {
  return portable::kPi * membrane_stiffness * radius * radius * radius;
}
double EvertingTube::collapse_moment() const {
  return portable::kPi * pressure * radius * radius * radius;
}
double EvertingTube::wrinkling_moment() const { return 0.5 * collapse_moment(); }

double EvertingTube::tip_force(double grown, double turning) const {
  const double drag = tail_drag * grown * portable::exp(std::min(tail_friction * turning, 700.0));
  return std::max(0.0, (pressure - yield_pressure) * area() - drag);
}
double EvertingTube::speed_loss() const { return area() / extensibility; }

void check_tube(const EvertingTube& tube, const std::string& key, RangeCheck& check) {
  const struct {
    const char* name;
    double value, most;
    const char* expected;
  } positive[] = {
      {".pressure", tube.pressure, 1e6, "above 0 to 1e6 Pa: without pressure a tube carries nothing"},
      {".radius", tube.radius, 1, "above 0 to 1 m"},
      {".link_length", tube.link_length, 1, "above 0 to 1 m"},
      {".membrane_stiffness", tube.membrane_stiffness, 1e9, "above 0 to 1e9 N/m"},
      {".membrane_density", tube.membrane_density, 100, "above 0 to 100 kg/m2"},
      {".extensibility", tube.extensibility, 1, "above 0 to 1 m/(s Pa)"}};
  for (const auto& figure : positive) {
    check.expect(figure.value > 0 && figure.value <= figure.most, key + figure.name, figure.expected,
                 figure.value);
  }
  const struct {
    const char* name;
    double value;
  } others[] = {{".yield_pressure", tube.yield_pressure},
                {".tail_drag", tube.tail_drag},
                {".tail_friction", tube.tail_friction},
                {".damping_time", tube.damping_time}};
  for (const auto& figure : others) {
    check.expect(figure.value >= 0 && figure.value <= 1e9, key + figure.name, "0 to 1e9",
                 figure.value);
  }
  check.expect(tube.start_links >= 1 && tube.start_links <= tube.links, key + ".start_links",
               "1 to the number of links", tube.start_links);
}

}  // namespace rubble
