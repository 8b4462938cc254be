#include "io/learning/parquet_file.h"

#include "io/base/little_endian.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

// Numbers of the format: physical types, repetition, converted types, encodings.
constexpr int kBoolean = 0, kInt64 = 2, kFloat = 4, kDouble = 5, kByteArray = 6;
constexpr int kRequired = 0, kRepeated = 2;
constexpr int kUtf8 = 0, kList = 3;
constexpr int kPlain = 0, kRle = 3;
constexpr char kParquetMagic[] = "PAR1";

// Thrift's compact protocol.
class Thrift {
 public:
  void integer(int field, std::int64_t value, bool wide = false) {
    head(field, wide ? 6 : 5);
    zigzag(value);
  }
  void text(int field, const std::string& value) {
    head(field, 8);
    raw_text(value);
  }
  void list(int field, std::size_t count, int type) {
    head(field, 9);
    if (count < 15)
      bytes_ += char(count << 4 | std::size_t(type));
    else {
      bytes_ += char(0xf0 | type);
      varint(count);
    }
  }
  void begin(int field) {
    head(field, kStruct);
    open();
  }
  // A struct that is the element of a list.
  void open() {
    outer_.push_back(last_);
    last_ = 0;
  }
  void close() {
    bytes_ += '\0';
    last_ = outer_.back();
    outer_.pop_back();
  }
  void zigzag(std::int64_t value) { varint(std::uint64_t(value) << 1 ^ (value < 0 ? ~std::uint64_t{0} : 0)); }
  void raw_text(const std::string& value) {
    varint(value.size());
    bytes_ += value;
  }
  std::string take() { return std::move(bytes_) + '\0'; }

  static constexpr int kStruct = 12, kInteger = 5, kText = 8;

 private:
  void head(int field, int type) {
    bytes_ += char((field - last_) << 4 | type);
    last_ = field;
  }
  void varint(std::uint64_t value) {
    for (; value >= 128; value >>= 7) bytes_ += char((value & 127) | 128);
    bytes_ += char(value);
  }

  std::string bytes_;
  int last_ = 0;
  std::vector<int> outer_;
};

// Runs of one level each, in the hybrid encoding for levels of one bit, behind their size.
class Levels {
 public:
  void add(int level, std::size_t count) {
    if (count == 0) return;
    if (count_ > 0 && level == level_) {
      count_ += count;
      return;
    }
    flush();
    level_ = level;
    count_ = count;
  }
  std::string take() {
    flush();
    std::string sized;
    put(sized, std::uint32_t(bytes_.size()));
    return sized + bytes_;
  }

 private:
  void flush() {
    if (count_ == 0) return;
    std::uint64_t head = std::uint64_t(count_) << 1;
    for (; head >= 128; head >>= 7) bytes_ += char((head & 127) | 128);
    bytes_ += char(head);
    bytes_ += char(level_);
    count_ = 0;
  }

  std::string bytes_;
  int level_ = 0;
  std::size_t count_ = 0;
};

template <typename T>
void put_plain(std::string& bytes, const T& value) {
  if constexpr (std::is_same_v<T, std::string>) {
    put(bytes, std::uint32_t(value.size()));
    bytes += value;
  } else {
    put(bytes, value);
  }
}

std::string page_head(std::size_t size, std::int64_t values) {
  Thrift head;
  head.integer(1, 0);  // a data page
  head.integer(2, std::int64_t(size));
  head.integer(3, std::int64_t(size));
  head.begin(5);
  head.integer(1, values);
  head.integer(2, kPlain);
  head.integer(3, kRle);
  head.integer(4, kRle);
  head.close();
  return head.take();
}

void put_element(Thrift& out, const std::string& name, int repetition, int type, int children, int converted) {
  out.open();
  if (type >= 0) out.integer(1, type);
  out.integer(3, repetition);
  out.text(4, name);
  if (children > 0) out.integer(5, children);
  if (converted >= 0) out.integer(6, converted);
  out.close();
}

}  // namespace

template <typename T>
void ParquetTable::add_flat(const std::string& name, int type, const std::vector<T>& values) {
  Column& column = columns_.emplace_back(Column{name, type, false, type == kByteArray, values.size(), std::int64_t(values.size())});
  for (const T& value : values) put_plain(column.page, value);
}

template <typename T>
void ParquetTable::add_list_column(const std::string& name, int type, const std::vector<std::vector<T>>& lists) {
  Column& column = columns_.emplace_back(Column{name, type, true, type == kByteArray, lists.size()});
  Levels repetition, definition;
  std::string values;
  for (const std::vector<T>& list : lists) {
    repetition.add(0, 1);
    repetition.add(1, list.empty() ? 0 : list.size() - 1);
    definition.add(list.empty() ? 0 : 1, list.empty() ? 1 : list.size());
    column.values += std::int64_t(list.empty() ? 1 : list.size());
    for (const T& value : list) put_plain(values, value);
  }
  column.page = repetition.take() + definition.take() + values;
}

void ParquetTable::add(const std::string& name, const std::vector<std::int64_t>& values) { add_flat(name, kInt64, values); }
void ParquetTable::add(const std::string& name, const std::vector<float>& values) { add_flat(name, kFloat, values); }
void ParquetTable::add(const std::string& name, const std::vector<double>& values) { add_flat(name, kDouble, values); }
void ParquetTable::add(const std::string& name, const std::vector<std::string>& values) { add_flat(name, kByteArray, values); }
// Eight to a byte, the first one lowest.
void ParquetTable::add(const std::string& name, const std::vector<bool>& values) {
  Column& column = columns_.emplace_back(Column{name, kBoolean, false, false, values.size(), std::int64_t(values.size())});
  column.page.assign((values.size() + 7) / 8, '\0');
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i]) column.page[i / 8] = char(column.page[i / 8] | 1 << i % 8);
}
void ParquetTable::add_lists(const std::string& name, const std::vector<std::vector<float>>& lists) {
  add_list_column(name, kFloat, lists);
}
void ParquetTable::add_lists(const std::string& name, const std::vector<std::vector<std::string>>& lists) {
  add_list_column(name, kByteArray, lists);
}

std::string ParquetTable::encode() const {
  std::string bytes = kParquetMagic;
  std::vector<std::size_t> begins, sizes;
  for (const Column& column : columns_) {
    if (column.rows != columns_.front().rows) throw RunError("the column " + column.name + " has another number of rows");
    begins.push_back(bytes.size());
    bytes += page_head(column.page.size(), column.values) + column.page;
    sizes.push_back(bytes.size() - begins.back());
  }
  const auto rows = std::int64_t(columns_.empty() ? 0 : columns_.front().rows);
  std::size_t elements = 1;
  for (const Column& column : columns_) elements += column.is_list ? 3 : 1;

  Thrift foot;
  foot.integer(1, 1);  // version
  foot.list(2, elements, Thrift::kStruct);
  put_element(foot, "schema", kRequired, -1, int(columns_.size()), -1);
  for (const Column& column : columns_) {
    const int converted = column.is_text ? kUtf8 : -1;
    if (column.is_list) {
      put_element(foot, column.name, kRequired, -1, 1, kList);
      put_element(foot, "list", kRepeated, -1, 1, -1);
    }
    put_element(foot, column.is_list ? "element" : column.name, kRequired, column.type, 0, converted);
  }
  foot.integer(3, rows, true);
  foot.list(4, 1, Thrift::kStruct);
  foot.open();
  foot.list(1, columns_.size(), Thrift::kStruct);
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const Column& column = columns_[i];
    foot.open();
    foot.integer(2, std::int64_t(begins[i]), true);
    foot.begin(3);
    foot.integer(1, column.type);
    foot.list(2, 2, Thrift::kInteger);
    foot.zigzag(kPlain), foot.zigzag(kRle);
    foot.list(3, column.is_list ? 3 : 1, Thrift::kText);
    foot.raw_text(column.name);
    if (column.is_list) foot.raw_text("list"), foot.raw_text("element");
    foot.integer(4, 0);  // not compressed
    foot.integer(5, column.values, true);
    foot.integer(6, std::int64_t(sizes[i]), true);
    foot.integer(7, std::int64_t(sizes[i]), true);
    foot.integer(9, std::int64_t(begins[i]), true);
    foot.close();
    foot.close();
  }
  foot.integer(2, std::int64_t(bytes.size() - 4), true);
  foot.integer(3, rows, true);
  foot.close();
  if (!metadata_.empty()) {
    foot.list(5, metadata_.size(), Thrift::kStruct);
    for (const auto& [key, value] : metadata_) {
      foot.open();
      foot.text(1, key);
      foot.text(2, value);
      foot.close();
    }
  }
  foot.text(6, "rubble");
  const std::string footer = foot.take();
  bytes += footer;
  put(bytes, std::uint32_t(footer.size()));
  return bytes + kParquetMagic;
}

}  // namespace rubble
