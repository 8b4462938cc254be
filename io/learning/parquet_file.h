// Parquet files (https://parquet.apache.org/docs/file-format/): one row group, one page a column, PLAIN, not compressed.
// For tables of episodes; every value is required.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace rubble {

class ParquetTable {
 public:
  // Columns, each with a value or a list for every row of the table. Lists may have any lengths.
  void add(const std::string& name, const std::vector<std::int64_t>& values);
  void add(const std::string& name, const std::vector<float>& values);
  void add(const std::string& name, const std::vector<double>& values);
  void add(const std::string& name, const std::vector<std::string>& values);
  void add(const std::string& name, const std::vector<bool>& values);
  void add_lists(const std::string& name, const std::vector<std::vector<float>>& lists);
  void add_lists(const std::string& name, const std::vector<std::vector<std::string>>& lists);
  // Key and value of the file, such as "pandas".
  void set_metadata(const std::string& key, const std::string& value) { metadata_.emplace_back(key, value); }

  // The bytes of the file. Throws RunError: the columns have different numbers of rows.
  std::string encode() const;

 private:
  struct Column {
    std::string name;
    int type = 0;  // physical type, as the format numbers it
    bool is_list = false, is_text = false;
    std::size_t rows = 0;
    std::int64_t values = 0;          // with levels: as many as pairs of them
    std::string page{};               // levels and values
  };

  template <typename T>
  void add_flat(const std::string& name, int type, const std::vector<T>& values);
  template <typename T>
  void add_list_column(const std::string& name, int type, const std::vector<std::vector<T>>& lists);

  std::vector<Column> columns_;
  std::vector<std::pair<std::string, std::string>> metadata_;
};

}  // namespace rubble
