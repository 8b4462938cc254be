// Scores of several datasets as a table: for people, spreadsheets, programs and papers.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace rubble {

struct ScoreCell {
  std::string key;              // in JSON and CSV; its last word is the unit
  std::string heading;          // in text and LaTeX
  std::optional<double> value;  // nothing: could not be determined; null, empty or a dash
  int digits = 0;               // after the point, for people
};

// One row; every row of a table has the same keys in the same order.
struct ScoreRow {
  std::string name;              // of the dataset
  std::vector<ScoreCell> cells;  // in the order of the columns
};

std::string score_text(const std::vector<ScoreRow>& rows);
std::string score_csv(const std::vector<ScoreRow>& rows);
// {"datasets": [{"name": ..., KEY: number or null, ...}, ...]}
std::string score_json(const std::vector<ScoreRow>& rows);
// A tabular environment by booktabs' rules; _ % & # are escaped.
std::string score_latex(const std::vector<ScoreRow>& rows);

// By the extension: .csv, .json or .tex. Throws InputError for another one.
void check_score_file(const std::string& path);
void write_score_file(const std::string& path, const std::vector<ScoreRow>& rows);

}  // namespace rubble
