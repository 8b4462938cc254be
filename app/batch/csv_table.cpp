#include "app/batch/csv_table.h"

#include "kernel/base/error.h"

namespace rubble {
namespace {

// Reads one row from `at` on and puts `at` behind it.
std::vector<std::string> read_row(const std::string& text, std::size_t& at, int line,
                                  const std::string& file) {
  std::vector<std::string> fields{""};
  bool quoted = false;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (quoted && c == '"' && at + 1 < text.size() && text[at + 1] == '"') {
      fields.back() += c;
      ++at;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && c == ',') {
      fields.emplace_back();
    } else if (!quoted && c == '\n') {
      ++at;
      return fields;
    } else if (quoted || c != '\r') {
      fields.back() += c;
    }
  }
  if (quoted) throw InputError({file, line, "", "a quotation mark is not closed", "", "", ""});
  return fields;
}

}  // namespace

int CsvTable::find(const std::string& column) const {
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i] == column) return int(i);
  return -1;
}

CsvTable parse_csv(const std::string& text, const std::string& file) {
  CsvTable table;
  std::size_t at = 0;
  for (int line = 1; at < text.size(); ++line) {
    std::vector<std::string> row = read_row(text, at, line, file);
    if (line == 1) {
      table.columns = std::move(row);
      continue;
    }
    if (row.size() != table.columns.size())
      throw InputError({file, line, "", "a row of another length than the first line",
                        std::to_string(table.columns.size()) + " fields",
                        std::to_string(row.size()), ""});
    table.rows.push_back(std::move(row));
  }
  if (table.columns.empty()) throw InputError({file, 0, "", "the table is empty", "", "", ""});
  return table;
}

}  // namespace rubble
