#include "app/report/score_means.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "app/report/html_text.h"
#include "kernel/base/quick_math.h"
#include "kernel/base/tables/text_table.h"

namespace rubble {
namespace {

constexpr std::size_t kMostValues = 12;  // of a key, each with a row
constexpr std::size_t kRanges = 5;       // of one with more numbers

using Rows = std::vector<const std::vector<std::string>*>;
using Groups = std::vector<std::pair<std::string, Rows>>;  // with the value of the key

// The 97.5 % quantile of Student's t, from its usual table; between entries linear in 1 / degrees of freedom.
double student_quantile(std::size_t freedom) {
  constexpr double kFirst[] = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228,
                               2.201,  2.179, 2.160, 2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086,
                               2.080,  2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042};
  if (freedom <= std::size(kFirst)) return kFirst[freedom - 1];
  constexpr std::pair<double, double> kRest[] = {{1.0 / 30, 2.042}, {1.0 / 40, 2.021}, {1.0 / 60, 2.000}, {1.0 / 120, 1.980}, {0, 1.960}};
  const double inverse = 1.0 / double(freedom);
  std::size_t i = 1;
  while (inverse < kRest[i].first) ++i;
  const auto [x0, y0] = kRest[i - 1];
  const auto [x1, y1] = kRest[i];
  return y1 + (y0 - y1) * (inverse - x1) / (x0 - x1);
}

std::optional<double> number_in(const std::string& text) {
  const auto value = parse_number(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::vector<double> values_of(const Rows& rows, std::size_t column) {
  std::vector<double> values;
  for (const auto* row : rows)
    if (const auto value = number_in((*row)[column])) values.push_back(*value);
  return values;
}

// With as many decimals as `scale` needs to have two digits; of 0: six digits.
std::string rounded(double value, double scale) {
  char text[64];
  if (!(scale > 0)) {
    std::snprintf(text, sizeof text, "%.6g", value);
  } else {
    const int decimals = 1 - int(std::floor(quick::log10(scale)));
    std::snprintf(text, sizeof text, "%.*f", std::clamp(decimals, 0, 12), value);
  }
  return text;
}

// A score that is yes or no; numbers of things are not, though they may be 0 and 1.
bool is_share(const FinishedBatch& batch, const Rows& all, std::size_t column) {
  const std::string& name = batch.table.columns[column];
  if (name.find("count") != std::string::npos) return false;
  const std::vector<double> values = values_of(all, column);
  return std::all_of(values.begin(), values.end(), [](double v) { return v == 0 || v == 1; });
}

std::string share_cell(const std::vector<double>& values) {
  const auto hits = std::size_t(std::count(values.begin(), values.end(), 1.0));
  const ShareInterval interval = calc_share_interval(hits, values.size());
  char text[120];
  std::snprintf(text, sizeof text, "<td>%zu of %zu<small>%.0f to %.0f %%</small></td>", hits, values.size(),
                100 * interval.low, 100 * interval.high);
  return text;
}

std::string mean_cell(const std::vector<double>& values) {
  const StudentInterval m = calc_student_interval(values);
  if (m.count == 1) return "<td>" + rounded(m.mean, 0) + "<small>n 1: no interval</small></td>";
  return "<td>" + rounded(m.mean, m.half) + " ± " + rounded(m.half, m.half) + "<small>sd " + rounded(m.deviation, m.deviation) + ", n " +
         std::to_string(m.count) + "</small></td>";
}

std::string group_row(const FinishedBatch& batch, const std::string& name, const Rows& rows, const Rows& all,
                      const std::vector<std::size_t>& metrics) {
  std::string text = "<tr><td>" + html_escape(name) + "</td><td>" + std::to_string(rows.size()) + "</td>";
  for (const std::size_t metric : metrics) {
    const std::vector<double> values = values_of(rows, metric);
    text += values.empty() ? "<td>none</td>" : is_share(batch, all, metric) ? share_cell(values) : mean_cell(values);
  }
  return text + "</tr>\n";
}

std::string table_of(const FinishedBatch& batch, const std::string& key, const Groups& groups, const Rows& all,
                     const std::vector<std::size_t>& metrics) {
  std::string text = "<div class=\"scroll\"><table class=\"means\">\n<thead><tr><th scope=\"col\">" + html_escape(key) +
                     "</th><th scope=\"col\">runs</th>";
  for (const std::size_t metric : metrics) text += "<th scope=\"col\">" + html_escape(batch.table.columns[metric]) + "</th>";
  text += "</tr></thead>\n<tbody>\n";
  for (const auto& [name, rows] : groups) text += group_row(batch, name, rows, all, metrics);
  return text + "</tbody>\n</table></div>\n";
}

// Rows that have numbers, by their value of a key, in the order of numbers, then of first use.
Groups groups_of(const Rows& all, std::size_t column) {
  Groups groups;
  bool numbers = true;
  for (const auto* row : all) {
    const std::string& value = (*row)[column];
    numbers = numbers && number_in(value);
    const auto known = std::find_if(groups.begin(), groups.end(), [&](const auto& group) { return group.first == value; });
    if (known == groups.end())
      groups.push_back({value, {row}});
    else
      known->second.push_back(row);
  }
  const auto less = [](const auto& a, const auto& b) { return *number_in(a.first) < *number_in(b.first); };
  if (numbers) std::stable_sort(groups.begin(), groups.end(), less);
  if (!numbers || groups.size() <= kMostValues) return groups;
  Groups ranges;
  std::size_t taken = 0, next = 0;
  for (std::size_t i = 0; i < kRanges; ++i) {
    const std::size_t first = next;
    Rows rows;
    while (next < groups.size() && (taken + rows.size()) * kRanges < all.size() * (i + 1))
      rows.insert(rows.end(), groups[next].second.begin(), groups[next].second.end()), ++next;
    if (rows.empty()) continue;
    taken += rows.size();
    ranges.push_back({groups[first].first + " to " + groups[next - 1].first, std::move(rows)});
  }
  return ranges;
}

std::string plural(std::size_t count, const char* noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace

StudentInterval calc_student_interval(const std::vector<double>& values) {
  StudentInterval m;
  m.count = values.size();
  if (m.count == 0) return m;
  for (const double value : values) m.mean += value / double(m.count);
  if (m.count == 1) return m;
  double squares = 0;
  for (const double value : values) squares += (value - m.mean) * (value - m.mean);
  m.deviation = std::sqrt(squares / double(m.count - 1));
  m.half = student_quantile(m.count - 1) * m.deviation / std::sqrt(double(m.count));
  return m;
}

ShareInterval calc_share_interval(std::size_t hits, std::size_t count) {
  constexpr double kZ = 1.959964;
  const double n = double(count), p = double(hits) / n, z2 = kZ * kZ / n;
  const double middle = (p + z2 / 2) / (1 + z2), half = kZ * std::sqrt(p * (1 - p) / n + z2 / (4 * n)) / (1 + z2);
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

std::string make_mean_tables(const FinishedBatch& batch, const std::vector<std::string>& varied,
                             const std::vector<std::size_t>& metrics) {
  Rows all;
  std::size_t moving = 0;
  for (const auto& row : batch.table.rows) {
    const std::string& status = batch.status_of(row);
    if (status != "done" && status != "did_not_settle") continue;
    all.push_back(&row);
    moving += status == "did_not_settle";
  }
  if (metrics.empty() || all.empty()) return "";
  const std::size_t failed = batch.table.rows.size() - all.size();
  std::string text = "<h2>Means</h2>\n<p>Mean ± half of its 95 % interval (Student's t), standard deviation (sd) and number of "
                     "runs with this score (n). Of scores that are 0 or 1: how often 1, and the 95 % interval of its share (Wilson). "
                     "Intervals take the runs for independent draws: they tell of other seeds, not of other missions.";
  if (failed > 0) text += " " + plural(failed, "run") + " without scores " + (failed == 1 ? "is" : "are") + " not counted.";
  if (moving > 0) text += " " + plural(moving, "run") + " that did not settle " + (moving == 1 ? "is" : "are") + " counted.";
  text += "</p>\n" + table_of(batch, "all runs", {{"all", all}}, all, metrics);
  const bool several = varied.size() > 1;
  for (const std::string& key : varied) {
    const int column = batch.table.find(key);
    if (column < 0) continue;
    const Groups groups = groups_of(all, std::size_t(column));
    if (groups.size() < 2 || groups.size() > 4 * kMostValues) continue;
    text += "<h3>By " + html_escape(key) + "</h3>\n";
    if (several) text += "<p>Each row is over all values of the other keys.</p>\n";
    text += table_of(batch, key, groups, all, metrics);
  }
  return text;
}

}  // namespace rubble
