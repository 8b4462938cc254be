#include "scripting/files/accelerogram.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/base/tables/text_table.h"
#include "scripting/values/column_names.h"

namespace rubble {
namespace {

constexpr double kGravity = 9.80665;   // unit: m/s2
constexpr std::size_t kHeadLines = 80;  // of any format, at most
constexpr const char* kUnits = "g, mg, gal, cm/s2 or m/s2";

// Of one value; 0: the word is no unit of acceleration that is known.
double acceleration_unit(std::string_view written) {
  std::string word;
  for (const char c : lower_case(written))
    if (c != ' ' && c != '^' && c != '*' && c != '.') word += c;
  const auto is = [&word](std::initializer_list<const char*> names) { return is_one_of(word, names); };
  if (is({"g", "gs", "g's"})) return kGravity;
  if (is({"mg"})) return kGravity / 1000;
  if (is({"gal", "gals", "cm/s2", "cm/s/s", "cm/sec2", "cm/sec/sec", "cm/s-2", "cms-2"})) return 0.01;
  if (is({"mm/s2", "mm/s/s", "mm/sec2", "mm/sec/sec"})) return 0.001;
  return is({"m/s2", "m/s/s", "m/sec2", "m/sec/sec", "ms-2"}) ? 1 : 0;
}


class AccelerogramReader {
 public:
  AccelerogramReader(std::string_view text, const std::string& path, const AccelerogramOptions& options)
      : path_(path), options_(options), lines_(split_lines(text)) {}

  Accelerogram read() {
    switch (format()) {
      case Format::peer: read_peer(); break;
      case Format::esm: read_esm(); break;
      case Format::knet: read_knet(); break;
      case Format::columns: read_columns(); break;
    }
    finish();
    return std::move(result_);
  }

  // Lines before the first value.
  std::size_t head_lines() const {
    if (format() == Format::peer) return std::size_t(find("NPTS")) + 1;
    if (format() == Format::knet) return find("Memo.") < 0 ? 17 : std::size_t(find("Memo.")) + 1;
    if (format() == Format::columns) return 0;
    std::size_t line = std::size_t(find("SAMPLING_INTERVAL_S"));
    while (line < std::min(lines_.size(), kHeadLines) &&
           (lines_[line].find(':') != std::string_view::npos || trimmed(lines_[line]).empty()))
      ++line;
    return line;
  }

 private:
  enum class Format { peer, esm, knet, columns };

  Format format() const {
    const int points = find("NPTS");
    if (points >= 0 && lower_case(lines_[std::size_t(points)]).find("dt") != std::string::npos) return Format::peer;
    if (find("SAMPLING_INTERVAL_S") >= 0) return Format::esm;
    return find("Sampling Freq(Hz)") >= 0 && find("Scale Factor") >= 0 ? Format::knet : Format::columns;
  }

  [[noreturn]] void refuse(int line, const std::string& message, const std::string& expected = "",
                           const std::string& found = "", const std::string& hint = "") const {
    throw InputError({path_, line, "", message, expected, found, hint});
  }

  // The line of the head that has these words in any case, from 0; -1: none has.
  int find(std::string_view words) const {
    const std::string low = lower_case(words);
    for (std::size_t i = 0; i < std::min(lines_.size(), kHeadLines); ++i)
      if (lower_case(lines_[i]).find(low) != std::string::npos) return int(i);
    return -1;
  }

  // What follows the words in their line.
  std::string_view after(std::string_view words) const {
    const int line = find(words);
    if (line < 0) return {};
    const std::string_view text = lines_[std::size_t(line)];
    return trimmed(text.substr(lower_case(text).find(lower_case(words)) + words.size()));
  }

  double number_after(std::string_view words, const std::string& format) const {
    return number_in(after(words), find(words), words, format);
  }

  double number_in(std::string_view rest, int line, std::string_view words, const std::string& format) const {
    while (!rest.empty() && (rest[0] == '=' || rest[0] == ':' || rest[0] == ' ')) rest.remove_prefix(1);
    const auto value = parse_number(rest.substr(0, rest.find_first_of(" \t,;Hhs")));
    if (!value || !(*value > 0))
      refuse(line + 1, "no number after " + std::string(words), "a number above 0, as in files of " + format,
             std::string(rest.substr(0, 20)));
    return *value;
  }

  // Refuses what is no acceleration by the words of its head.
  void check_kind() const {
    for (const char* kind : {"VELOCITY TIME", "DISPLACEMENT TIME", "DATA_TYPE: VELOCITY", "DATA_TYPE: DISPLACEMENT"})
      if (const int line = find(kind); line >= 0)
        refuse(line + 1, "holds no accelerations", "an acceleration time history", std::string(trimmed(lines_[std::size_t(line)])));
  }

  void take_values(std::size_t first_line) {
    for (std::size_t i = first_line; i < lines_.size(); ++i)
      for (const std::string_view word : split_words(lines_[i], int(i) + 1).words) take_value(word, int(i) + 1);
  }

  void take_value(std::string_view word, int line) {
    if (word.empty()) return;
    const auto value = parse_number(word);
    if (!value || !std::isfinite(*value)) refuse(line, "not a number", "an acceleration", "`" + std::string(word) + "`");
    result_.values.push_back(*value);
  }

  void check_count(double expected, int line, const char* name) const {
    if (double(result_.values.size()) == expected) return;
    refuse(line + 1, "another number of values", std::to_string(std::int64_t(expected)) + ", as " + name + " says",
           std::to_string(result_.values.size()), "the file is cut, or its head is of another one");
  }

  void scale_from(std::string_view unit, int line, const std::string& format) {
    if (!options_.unit.empty()) unit = options_.unit;
    const double scale = acceleration_unit(unit);
    if (scale == 0) refuse(line + 1, "no known unit of acceleration", kUnits, "`" + std::string(unit) + "`", "give `unit`");
    for (double& value : result_.values) value *= scale;
    result_.format = format + ", in " + std::string(trimmed(unit));
  }

  // "4096 0.0100 NPTS, DT" or "NPTS=  1559, DT=  .02000 SEC".
  void read_peer() {
    check_kind();
    const int line = find("NPTS");
    const std::string_view head = lines_[std::size_t(line)];
    double count = 0;
    if (head.find('=') != std::string_view::npos) {
      count = number_after("NPTS", "PEER");
      result_.step = number_in(head.substr(lower_case(head).find("dt") + 2), line, "DT", "PEER");
    } else {
      std::vector<double> numbers;
      for (const std::string_view part : split_words(head.substr(0, lower_case(head).find("npts")), 0).words)
        if (const auto value = parse_number(part)) numbers.push_back(*value);
      if (numbers.size() != 2 || !(numbers[0] >= 1) || !(numbers[1] > 0))
        refuse(line + 1, "no NPTS and DT", "`4096 0.0100 NPTS, DT` or `NPTS= 4096, DT= .0100 SEC`", std::string(trimmed(head)));
      count = numbers[0], result_.step = numbers[1];
    }
    take_values(head_lines());
    check_count(count, line, "NPTS");
    const int units = find("UNITS OF");
    scale_from(units < 0 ? "g" : after("UNITS OF"), units, "PEER AT2");
    if (units < 0) result_.notes.push_back("no line says `UNITS OF`; g is taken, as PEER writes");
  }

  void read_esm() {
    check_kind();
    result_.step = number_after("SAMPLING_INTERVAL_S", "ESM");
    take_values(head_lines());
    if (find("NDATA") >= 0) check_count(number_after("NDATA", "ESM"), find("NDATA"), "NDATA");
    const int units = find("UNITS:");
    scale_from(units < 0 ? "" : after("UNITS:"), units, "ESM");
  }

  // Counts of a recorder, with its offset: "Scale Factor      2000(gal)/8388608".
  void read_knet() {
    result_.step = 1 / number_after("Sampling Freq(Hz)", "K-NET");
    const int line = find("Scale Factor");
    const std::string_view scale = after("Scale Factor");
    const std::size_t open = scale.find('('), close = scale.find(')'), slash = scale.find('/');
    const bool fine = open != std::string_view::npos && close != std::string_view::npos && slash == close + 1;
    const auto full = parse_number(trimmed(scale.substr(0, fine ? open : 0)));
    const auto counts = parse_number(fine ? trimmed(scale.substr(slash + 1)) : std::string_view());
    if (!full || !counts || !(*counts > 0))
      refuse(line + 1, "no scale factor", "such as 2000(gal)/8388608", std::string(scale));
    take_values(head_lines());
    if (result_.values.empty()) refuse(0, "has no values", "counts after the head", "none");
    double sum = 0;
    for (const double value : result_.values) sum += value;
    const double mean = sum / double(result_.values.size());
    for (double& value : result_.values) value = (value - mean) * (*full / *counts);
    scale_from(scale.substr(open + 1, close - open - 1), line, "K-NET");
    result_.notes.push_back("the recorder's offset, the mean of the values, is removed");
  }

  struct NamedColumns {
    int time = -1, value = -1;
    double time_unit = 1;  // unit: s
    std::string unit;      // of the values
  };

  // "t [s]", "time_ms", "a [g]", "acc_g", "acceleration (cm/s2)"
  NamedColumns columns_of(const TextRow& names) const {
    NamedColumns columns;
    const std::vector<std::string> joined_names = join_units(names.words);
    for (std::size_t i = 0; i < joined_names.size(); ++i) {
      const std::string low = lower_case(joined_names[i]);
      const std::string name = low.substr(0, low.find_first_of(" _[("));
      const std::size_t at = low.find_first_of("_[(");
      const std::string unit(at == std::string::npos
                                 ? std::string_view()
                                 : trimmed(std::string_view(low).substr(at + 1, low.find_first_of(")]", at) - at - 1)));
      if (name == "t" || name == "time") {
        columns.time = int(i);
        columns.time_unit = unit.empty() ? 1 : time_unit(unit);
        if (columns.time_unit == 0)
          refuse(names.line, "column `" + joined_names[i] + "` has an unknown unit", kTimeUnits, "`" + unit + "`",
                 "convert it, and name it `t [s]`");
      }
      if (!is_one_of(name, {"a", "acc", "accel", "acceleration"})) continue;
      if (columns.value >= 0) refuse(names.line, "two columns are accelerations", "one", joined_names[i]);
      columns.value = int(i);
      columns.unit = unit;
    }
    return columns;
  }

  void read_columns() {
    const TextTable table = read_text_table(joined());
    std::vector<TextRow> rows = table.rows;
    const auto is_number = [](std::string_view word) { return bool(parse_number(word)); };
    NamedColumns columns;
    if (!rows.empty() && std::none_of(rows[0].words.begin(), rows[0].words.end(), is_number)) {
      columns = columns_of(rows[0]);
      rows.erase(rows.begin());
    } else if (!table.comments.empty()) {
      columns = columns_of(table.comments.back());
    }
    if (rows.empty()) refuse(0, "has no values", "a file of PEER (AT2), ESM or K-NET, or columns of numbers", "no line of numbers");
    if (columns.value < 0 && rows[0].words.size() > 1 && !(options_.step && !options_.unit.empty()))
      refuse(rows[0].line, "not a known accelerogram",
             "a file of PEER (AT2), ESM or K-NET, or columns `t [s], a [g]` named by the first line",
             std::to_string(rows[0].words.size()) + " values in a line", "give `step` and `unit` for numbers alone");
    if (columns.time >= 0 && columns.value >= 0)
      take_rows(rows, columns);
    else
      for (const TextRow& row : rows)
        for (const std::string_view word : row.words) take_value(word, row.line);
    if (options_.step) result_.step = *options_.step;
    if (!(result_.step > 0)) refuse(0, "has no time step", "a column `t [s]`, or `step`", "numbers alone");
    if (columns.unit.empty() && options_.unit.empty()) refuse(0, "has no unit", kUnits, "none", "give `unit`");
    scale_from(columns.unit, -1, columns.value < 0 ? "numbers" : "columns");
  }

  void take_rows(const std::vector<TextRow>& rows, const NamedColumns& columns) {
    std::vector<double> times;
    for (const TextRow& row : rows) {
      if (row.words.size() <= std::size_t(std::max(columns.time, columns.value)))
        refuse(row.line, "too few values", std::to_string(std::max(columns.time, columns.value) + 1), std::to_string(row.words.size()));
      take_value(row.words[std::size_t(columns.value)], row.line);
      const auto time = parse_number(row.words[std::size_t(columns.time)]);
      if (!time) refuse(row.line, "not a number", "a time", "`" + std::string(row.words[std::size_t(columns.time)]) + "`");
      times.push_back(columns.time_unit == 1 ? *time : *time * columns.time_unit);
    }
    if (times.size() < 2) refuse(0, "has no time step", "two rows or more", "one");
    const double first = times[1] - times[0];
    for (std::size_t i = 1; i < times.size(); ++i)
      if (!(std::abs(times[i] - times[i - 1] - first) <= 0.01 * first))
        refuse(rows[i].line, "unequal time steps", brief_text(first) + " s", brief_text(times[i] - times[i - 1]) + " s",
               "resample it");
    result_.step = (times.back() - times.front()) / double(times.size() - 1);
  }

  // The lines as one text: comments and separators are read_text_table's.
  std::string_view joined() const {
    if (lines_.empty()) return {};
    return {lines_.front().data(), std::size_t(lines_.back().data() + lines_.back().size() - lines_.front().data())};
  }

  void finish() {
    if (result_.values.empty()) refuse(0, "has no values", "accelerations", "none");
    if (!(result_.step >= 1e-4 && result_.step <= 10)) refuse(0, "has an odd time step", "0.0001 to 10 s", brief_text(result_.step) + " s",
                                                              "name a column of other times `t [ms]` or so");
    for (const double value : result_.values) result_.peak = std::max(result_.peak, std::abs(value));
    constexpr double kLargestRecorded = 50;  // the largest on record is 43 m/s2 (Iwate, 2008); unit: m/s2
    if (result_.peak > kLargestRecorded)
      result_.notes.push_back("the peak of " + brief_text(result_.peak) + " m/s2 is larger than any recorded one: is the unit right?");
  }

  std::string path_;
  AccelerogramOptions options_;
  std::vector<std::string_view> lines_;
  Accelerogram result_;
};

}  // namespace

std::size_t accelerogram_head_lines(std::string_view text) { return AccelerogramReader(text, "", {}).head_lines(); }

Accelerogram parse_accelerogram(std::string_view text, const std::string& path, const AccelerogramOptions& options) {
  return AccelerogramReader(text, path, options).read();
}

}  // namespace rubble
