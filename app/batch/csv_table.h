// A table of text read back from a CSV file (RFC 4180).
#pragma once

#include <string>
#include <vector>

namespace rubble {

struct CsvTable {
  std::vector<std::string> columns;            // the first line
  std::vector<std::vector<std::string>> rows;  // each as long as `columns`

  // -1: there is none of that name.
  int find(const std::string& column) const;
};

// Throws InputError naming `file` and the line: quotes that do not end, a row of another length.
CsvTable parse_csv(const std::string& text, const std::string& file);

}  // namespace rubble
