#include "app/eval/scores/score_table.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "io/base/atomic_file.h"
#include "io/base/escaped_text.h"
#include "kernel/base/error.h"
#include "kernel/base/number_text.h"

namespace rubble {
namespace {

std::string rounded(const ScoreCell& cell, const char* missing) {
  return cell.value ? fixed_text(*cell.value, cell.digits) : missing;
}

std::string escape_latex(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '_' || c == '%' || c == '&' || c == '#' || c == '$') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string extension_of(const std::string& path) {
  return std::filesystem::path(path).extension().string();
}

}  // namespace

std::string score_text(const std::vector<ScoreRow>& rows) {
  std::string text;
  std::size_t widest = 0;
  for (const ScoreRow& row : rows)
    for (const ScoreCell& cell : row.cells) widest = std::max(widest, cell.heading.size());
  for (const ScoreRow& row : rows) {
    text += row.name + "\n";
    for (const ScoreCell& cell : row.cells)
      text += "  " + cell.heading + std::string(widest + 2 - cell.heading.size(), ' ') +
              rounded(cell, "-") + "\n";
  }
  return text;
}

std::string score_csv(const std::vector<ScoreRow>& rows) {
  std::string text = "name";
  for (const ScoreCell& cell : rows.front().cells) text += "," + cell.key;
  text += "\n";
  for (const ScoreRow& row : rows) {
    text += csv_text(row.name);
    for (const ScoreCell& cell : row.cells)
      text += "," + (cell.value ? exact_text(*cell.value) : "");
    text += "\n";
  }
  return text;
}

std::string score_json(const std::vector<ScoreRow>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ScoreRow& row : rows) {
    nlohmann::ordered_json item{{"name", row.name}};
    for (const ScoreCell& cell : row.cells) {
      if (!cell.value)
        item[cell.key] = nullptr;
      else if (cell.digits == 0)
        item[cell.key] = std::int64_t(*cell.value);  // a count
      else
        item[cell.key] = *cell.value;
    }
    list.push_back(item);
  }
  return nlohmann::ordered_json{{"datasets", list}}.dump(1) + "\n";
}

std::string score_latex(const std::vector<ScoreRow>& rows) {
  std::string text =
      "\\begin{tabular}{l" + std::string(rows.front().cells.size(), 'r') + "}\n\\toprule\ndataset";
  for (const ScoreCell& cell : rows.front().cells) text += " & " + escape_latex(cell.heading);
  text += " \\\\\n\\midrule\n";
  for (const ScoreRow& row : rows) {
    text += escape_latex(row.name);
    for (const ScoreCell& cell : row.cells) text += " & " + rounded(cell, "--");
    text += " \\\\\n";
  }
  return text + "\\bottomrule\n\\end{tabular}\n";
}

void check_score_file(const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension == ".csv" || extension == ".json" || extension == ".tex") return;
  throw InputError({"", 0, "--out", "unknown kind of file", ".csv, .json or .tex", path, ""});
}

void write_score_file(const std::string& path, const std::vector<ScoreRow>& rows) {
  const std::string extension = extension_of(path);
  const auto text = extension == ".csv"    ? score_csv
                    : extension == ".json" ? score_json
                                           : score_latex;
  write_text_file(path, text(rows));
}

}  // namespace rubble
