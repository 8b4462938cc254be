#include <algorithm>
#include <functional>
#include <iomanip>
#include <map>
#include <sstream>

#include "bench/equilibrium/pile_record.h"

namespace rubble {
namespace {

using Row = std::vector<std::string>;

std::string fixed(double value, int digits) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

double number_of(const Record& record, const std::string& key) {
  const auto found = record.find(key);
  return found != record.end() && found->is_number() ? found->get<double>() : 0;
}

// What a column shows of one pile.
struct Column {
  std::string heading;
  std::function<std::string(const Record&)> text;
};

Column count_column(const std::string& heading, const std::string& key) {
  return {heading, [key](const Record& r) { return r.contains(key) ? r[key].dump() : "-"; }};
}

Column number_column(const std::string& heading, const std::string& key, int digits) {
  return {heading, [key, digits](const Record& r) {
            return r.contains(key) ? fixed(number_of(r, key), digits) : "-";
          }};
}

std::string join_pair(const Record& pair) {
  return pair.at(0).get<std::string>() + ", " + pair.at(1).get<std::string>();
}

// Pieces that are off balance, and one of them.
std::string off_balance(const Record& r) {
  if (!r.contains("off_1_percent")) return "-";
  return r["off_1_percent"].dump() + ", " + r["off_10_percent"].dump() + ", " +
         r["off_50_percent"].dump();
}

std::vector<Column> pile_columns() {
  return {
      {"work", [](const Record& r) { return r.at("work").get<std::string>(); }},
      count_column("seed", "seed"),
      {"rests", [](const Record& r) { return r.at("settled").get<bool>() ? "yes" : "NO"; }},
      count_column("moving", "moving"),
      number_column("sim s", "simulated_s", 1),
      number_column("CPU s", "cpu_s", 2),
      number_column("overlap mm", "overlap_max_mm", 1),
      count_column("> 5 mm", "over_5mm"),
      number_column("ground mm", "ground_max_mm", 1),
      number_column("terrain mm", "terrain_max_mm", 1),
      number_column("residual %", "residual_percent", 3),
      {"off > 1, 10, 50 %", off_balance},
      count_column("lost", "lost"),
      count_column("ejected", "ejected"),
      number_column("drift p99 mm", "drift_p99_mm", 2),
      number_column("drift max mm", "drift_max_mm", 1),
      {"deepest pair", [](const Record& r) {
         return r.contains("deepest_pair") ? join_pair(r["deepest_pair"]) : "-";
       }},
  };
}

std::string format_table(const std::vector<Row>& rows, bool markdown) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const Row& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  std::ostringstream text;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    for (std::size_t i = 0; i < widths.size(); ++i) {
      if (markdown) {
        text << (i == 0 ? "| " : " | ") << rows[k][i];
      } else {
        text << (i == 0 ? "" : "  ") << std::left << std::setw(int(widths[i])) << rows[k][i];
      }
    }
    text << (markdown ? " |\n" : "\n");
    if (markdown && k == 0) {
      text << "|";
      for (std::size_t i = 0; i < widths.size(); ++i) text << "---|";
      text << "\n";
    }
  }
  return text.str();
}

using Group = std::vector<const Record*>;

double largest(const Group& group, const std::string& key) {
  double most = 0;
  for (const Record* r : group) most = std::max(most, number_of(*r, key));
  return most;
}

double sum(const Group& group, const std::string& key) {
  double all = 0;
  for (const Record* r : group) all += number_of(*r, key);
  return all;
}

// The worst of the seeds; "-" where none has the figure.
std::string worst(const Group& group, const std::string& key, int digits) {
  const bool known = std::any_of(group.begin(), group.end(),
                                 [&key](const Record* r) { return r->contains(key); });
  return known ? fixed(largest(group, key), digits) : "-";
}

std::string mean(const Group& group, const std::string& key, int digits) {
  return fixed(sum(group, key) / double(group.size()), digits);
}

// Of the pieces of all seeds, in percent.
std::string off_shares(const Group& group) {
  const double bodies = sum(group, "bodies");
  if (bodies == 0) return "-";
  std::string text;
  for (const char* key : {"off_1_percent", "off_10_percent", "off_50_percent"})
    text += (text.empty() ? "" : ", ") + fixed(100 * sum(group, key) / bodies, 2);
  return text;
}

const Row kWorkHeadings{"work", "rest", "sim s", "CPU s", "overlap mm", "pairs > 5 mm",
                        "ground mm", "terrain mm", "residual %", "% off > 1, 10, 50 %",
                        "lost", "ejected", "drift p99 mm", "drift max mm"};

Row work_row(const std::string& name, const Group& group) {
  int rested = 0;
  for (const Record* r : group) rested += r->at("settled").get<bool>();
  return {name,
          std::to_string(rested) + " of " + std::to_string(group.size()),
          mean(group, "simulated_s", 1),
          mean(group, "cpu_s", 2),
          worst(group, "overlap_max_mm", 1),
          fixed(sum(group, "over_5mm"), 0),
          worst(group, "ground_max_mm", 1),
          worst(group, "terrain_max_mm", 1),
          worst(group, "residual_percent", 3),
          off_shares(group),
          fixed(sum(group, "lost"), 0),
          fixed(sum(group, "ejected"), 0),
          worst(group, "drift_p99_mm", 2),
          worst(group, "drift_max_mm", 1)};
}

}  // namespace

std::string describe_record(const Record& r) {
  std::ostringstream text;
  text << r.at("work").get<std::string>() << ", seed " << r.at("seed") << ": "
       << (r.at("settled").get<bool>() ? "rests" : "DOES NOT REST") << " after "
       << fixed(number_of(r, "simulated_s"), 1) << " s, overlap "
       << fixed(number_of(r, "overlap_max_mm"), 1) << " mm";
  if (r.contains("deepest_pair")) text << " (" << join_pair(r["deepest_pair"]) << ")";
  if (r.contains("residual_percent"))
    text << ", residual " << fixed(number_of(r, "residual_percent"), 3)
         << " %, off by > 1, 10, 50 %: " << off_balance(r);
  return text.str();
}

std::string make_pile_table(const std::vector<Record>& records, bool markdown) {
  const std::vector<Column> columns = pile_columns();
  std::vector<Row> rows(1);
  for (const Column& column : columns) rows[0].push_back(column.heading);
  for (const Record& record : records) {
    rows.emplace_back();
    for (const Column& column : columns) rows.back().push_back(column.text(record));
  }
  return format_table(rows, markdown);
}

std::string make_work_table(const std::vector<Record>& records, bool markdown) {
  std::vector<std::string> names;
  std::map<std::string, Group> groups;
  for (const Record& record : records) {
    const std::string name = record.at("work");
    if (groups[name].empty()) names.push_back(name);
    groups[name].push_back(&record);
  }
  std::vector<Row> rows{kWorkHeadings};
  for (const std::string& name : names) rows.push_back(work_row(name, groups[name]));
  return format_table(rows, markdown);
}

}  // namespace rubble
