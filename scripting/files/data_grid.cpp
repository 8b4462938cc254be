#include "scripting/files/data_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "io/image/data_picture.h"
#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/base/tables/text_table.h"
#include "scripting/values/value.h"

namespace rubble {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
constexpr double kMostStretch = 0.01;      // by which pixels may differ from squares
constexpr double kLeastMetres = 0.1;       // spacing below which an ESRI grid's is taken for degrees; unit: m
// Comments of the kept text.
constexpr const char *kThinnedBy = "averaged over blocks of ", *kInDegrees = "cells in degrees",
                     *kOfColours = "brightness of colours", *kCutColumns = "columns left out at the edges: ",
                     *kCutRows = "rows left out at the edges: ";

[[noreturn]] void decline_grid(const std::string& what) { throw std::runtime_error(what); }

// Any line of the head may be the first.
bool is_esri_grid(std::string_view bytes) {
  static constexpr const char* kKeys[] = {"ncols",     "nrows",    "xllcorner",    "xllcenter", "yllcorner",
                                          "yllcenter", "cellsize", "nodata_value", "dx",        "dy"};
  const std::string text = lower_case(trimmed(skip_byte_order_mark(bytes.substr(0, 64))));
  const std::string_view line = std::string_view(text).substr(0, text.find_first_of("\r\n"));
  const std::size_t end = line.find_first_of(" \t,;");
  if (end == std::string_view::npos) return line == "ncols";
  const bool assigned = trimmed(line.substr(end)).substr(0, 1) == "=";  // a script
  return !assigned && std::find(std::begin(kKeys), std::end(kKeys), line.substr(0, end)) != std::end(kKeys);
}

DataGrid grid_of_picture(DataPicture picture) {
  DataGrid grid;
  grid.columns = picture.width, grid.rows = picture.height;
  grid.values.assign(picture.values.begin(), picture.values.end());
  grid.white = picture.ground ? 0 : picture.white;
  grid.colour = picture.colour;
  if (!picture.ground) return grid;
  const PictureGround& g = *picture.ground;
  if (std::abs(g.pixel_x - g.pixel_y) > kMostStretch * g.pixel_x)
    decline_grid("has pixels of " + exact_text(g.pixel_x) + " by " + exact_text(g.pixel_y) + "; resample it to squares");
  grid.spacing = g.pixel_x, grid.degrees = g.degrees;
  grid.east = g.left, grid.north = g.top - g.pixel_y * picture.height;
  return grid;
}

// The whole number of a comment of data_grid_text(); otherwise: none is there.
int commented(std::string_view text, const char* words, int least, int otherwise) {
  const std::size_t at = text.find(words);
  if (at == std::string_view::npos) return otherwise;
  const std::string_view rest = text.substr(at + std::string_view(words).size());
  const auto value = parse_number(rest.substr(0, rest.find_first_of(" \r\n")));
  return value && *value >= least && *value <= 1e5 ? int(*value) : otherwise;
}

// What the comments of data_grid_text() say.
void read_grid_comments(std::string_view text, DataGrid& grid) {
  text = text.substr(0, 300);
  grid.degrees = grid.degrees || text.find(kInDegrees) != std::string_view::npos;
  grid.colour = grid.colour || text.find(kOfColours) != std::string_view::npos;
  grid.block = commented(text, kThinnedBy, 1, 1);
  grid.cut_columns = commented(text, kCutColumns, 0, 0), grid.cut_rows = commented(text, kCutRows, 0, 0);
}

// The number after a key of an ESRI grid's head.
class EsriHead {
 public:
  void add(const std::string& key, double value) { entries_.emplace_back(key, value); }
  std::optional<double> find(const char* key) const {
    for (const auto& [name, value] : entries_)
      if (name == key) return value;
    return std::nullopt;
  }
  double require(const char* key) const {
    const auto value = find(key);
    if (!value) decline_grid(std::string("is an ESRI ASCII grid without ") + key);
    return *value;
  }
  double either(const char* key, const char* other, double half) const {
    if (const auto value = find(key)) return *value;
    const auto centre = find(other);
    return centre ? *centre - half : 0;
  }

 private:
  std::vector<std::pair<std::string, double>> entries_;
};

DataGrid parse_esri_grid(std::string_view text, bool kept) {
  EsriHead head;
  DataGrid grid;
  std::optional<double> none;
  bool in_head = true;
  for (const TextRow& row : read_text_table(text).rows) {
    const std::string first = row.words.empty() ? "" : lower_case(row.words[0]);
    const bool key = in_head && row.words.size() == 2 && !first.empty() && first[0] >= 'a' && first[0] <= 'z' && first != "nan";
    if (key) {
      const auto value = parse_number(row.words[1]);
      if (!value || (!std::isfinite(*value) && first != "nodata_value"))
        decline_grid("is an ESRI ASCII grid with no number after " + first + ", in line " + std::to_string(row.line));
      head.add(first, *value);
      continue;
    }
    if (in_head) none = head.find("nodata_value");
    in_head = false;
    for (const std::string_view word : row.words) {
      const auto value = parse_number(word);
      if (!value) decline_grid("has no number in line " + std::to_string(row.line) + ": `" + std::string(word) + "`");
      grid.values.push_back(none && *value == *none ? kNoValue : *value);
    }
    if (grid.values.size() > kMostDataPixels) decline_grid("has more than 64 million values");
  }
  const double columns = head.require("ncols"), rows = head.require("nrows");
  const bool whole = columns == std::floor(columns) && rows == std::floor(rows);
  if (!(columns >= 1 && rows >= 1 && whole) || columns * rows != double(grid.values.size()))
    decline_grid("has " + std::to_string(grid.values.size()) + " values instead of " + exact_text(columns) + " times " +
            exact_text(rows));
  grid.columns = int(columns), grid.rows = int(rows);
  grid.spacing = head.require("cellsize");
  if (!(grid.spacing > 0) && !(kept && grid.spacing == 0))
    decline_grid("has the cellsize " + exact_text(grid.spacing) + ": expected the distance of its points, above 0");
  grid.degrees = grid.spacing > 0 && grid.spacing < kLeastMetres;
  grid.east = head.either("xllcorner", "xllcenter", grid.spacing / 2);
  grid.north = head.either("yllcorner", "yllcenter", grid.spacing / 2);
  return grid;
}

// Of a plain PGM the levels as they are; its size is bounded by the text's own.
DataGrid read_unthinned(std::string_view bytes, bool kept) {
  if (is_esri_grid(bytes)) return parse_esri_grid(bytes, kept);
  try {
    return grid_of_picture(decode_data_picture(bytes));
  } catch (const RunError& error) {
    decline_grid(error.what());
  }
}

// Brightness of colours lies between levels. The text that is kept has whole ones.
void round_levels(DataGrid& grid) {
  if (grid.metric()) return;
  for (double& value : grid.values) value = std::floor(value + 0.5);
}

// The blocks of one way: how many, and the point at which the first begins; below 0: it hangs over.
struct Blocks {
  int count = 0, begin = 0, left_over = 0;
};

Blocks divide(int points, int block) {
  int count = points / block;
  if (count < 2) count = (points + block - 1) / block;
  const int left_over = points - count * block;
  return {count, left_over / 2, std::max(0, left_over)};
}

std::string number_text(double value) { return std::isnan(value) ? "nan" : exact_text(value); }

}  // namespace

bool is_data_grid(std::string_view bytes) { return !picture_kind(bytes).empty() || is_esri_grid(bytes); }

DataGrid read_data_grid(std::string_view bytes, bool kept) {
  DataGrid grid = read_unthinned(bytes, kept);
  if (std::uint64_t(grid.columns) * std::uint64_t(grid.rows) > kMostDataPixels)
    decline_grid("has more than 64 million pixels");
  if (is_esri_grid(bytes) || bytes.substr(0, 2) == "P2") read_grid_comments(bytes, grid);
  round_levels(grid);
  return grid;
}

DataGrid thinned(DataGrid grid, int side) {
  const int block = (std::max(grid.columns, grid.rows) + side - 1) / side;
  if (block <= 1) return grid;
  DataGrid out = grid;
  const Blocks across = divide(grid.columns, block), down = divide(grid.rows, block);
  out.columns = across.count, out.rows = down.count;
  out.values.clear();
  // A comment may state any block.
  const auto of_file = [&grid](int points) { return int(std::min(1e9, double(points) * grid.block)); };
  out.block = of_file(block), out.spacing = grid.spacing * block;
  out.cut_columns += of_file(across.left_over), out.cut_rows += of_file(down.left_over);
  out.east += grid.spacing * across.begin;
  out.north += grid.spacing * (grid.rows - down.begin - down.count * block);
  for (int r = 0; r < out.rows; ++r) {
    for (int c = 0; c < out.columns; ++c) {
      double sum = 0;
      int count = 0;
      const int top = down.begin + r * block, left = across.begin + c * block;
      for (int y = std::max(0, top); y < std::min(grid.rows, top + block); ++y)
        for (int x = std::max(0, left); x < std::min(grid.columns, left + block); ++x)
          sum += grid.values[std::size_t(y) * std::size_t(grid.columns) + std::size_t(x)], ++count;
      // No value in a block makes no sum.
      out.values.push_back(grid.metric() ? sum / count : std::floor((2 * sum + count) / (2 * count)));
    }
  }
  return out;
}

std::string data_grid_text(const DataGrid& grid) {
  std::string text, comments;
  if (grid.block > 1) comments += std::string("# ") + kThinnedBy + std::to_string(grid.block) + " points a side\n";
  if (grid.cut_columns > 0) comments += std::string("# ") + kCutColumns + std::to_string(grid.cut_columns) + "\n";
  if (grid.cut_rows > 0) comments += std::string("# ") + kCutRows + std::to_string(grid.cut_rows) + "\n";
  if (grid.degrees) comments += std::string("# ") + kInDegrees + "\n";
  if (grid.colour) comments += std::string("# ") + kOfColours + "\n";
  if (grid.metric()) {
    text = "ncols " + std::to_string(grid.columns) + "\nnrows " + std::to_string(grid.rows) + "\n" + comments + "xllcorner " +
           exact_text(grid.east) + "\nyllcorner " + exact_text(grid.north) + "\ncellsize " +
           exact_text(grid.spacing) + "\n";
  } else {
    text = "P2\n" + comments + std::to_string(grid.columns) + " " + std::to_string(grid.rows) + "\n" +
           exact_text(grid.white) + "\n";
  }
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.columns; ++c)
      text += (c > 0 ? " " : "") +
              number_text(grid.values[std::size_t(r) * std::size_t(grid.columns) + std::size_t(c)]);
    text += "\n";
  }
  return text;
}

}  // namespace rubble
