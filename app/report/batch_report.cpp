#include "app/report/batch_report.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "app/batch/finished_batch.h"
#include "app/report/html_text.h"
#include "app/report/score_means.h"
#include "app/report/svg_plot.h"
#include "io/image/image_file.h"
#include "io/recording/contact_sheet.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kMostPlots = 200;

// Sorts by a column where its head is clicked, and by the one that the address names: #sort=NAME or,
// downwards, #sort=-NAME.
constexpr const char* kSorter = R"(
const table = document.querySelector('table.runs'), heads = [...table.tHead.rows[0].cells];
let last = null;
function sortBy(column, down) {
  const value = row => row.cells[column].dataset.value ?? row.cells[column].textContent;
  const order = (a, b) => {
    const x = value(a), y = value(b), m = Number(x), n = Number(y);
    if (x === '' || y === '') return (x === '') - (y === '');
    const sign = down ? -1 : 1;
    return sign * (isNaN(m) || isNaN(n) ? x.localeCompare(y) : m - n);
  };
  table.tBodies[0].append(...[...table.tBodies[0].rows].sort(order));
  heads.forEach(head => head.removeAttribute('aria-sort'));
  heads[column].setAttribute('aria-sort', down ? 'descending' : 'ascending');
  last = down ? null : column;
}
heads.forEach((head, i) => head.addEventListener('click', () => sortBy(i, last === i)));
const asked = decodeURIComponent(location.hash).match(/^#sort=(-?)(.*)$/);
const at = asked ? heads.findIndex(head => head.textContent === asked[2]) : -1;
if (at >= 0) sortBy(at, asked[1] === '-');
)";

std::optional<double> to_number(const std::string& text) {
  double value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || read.ptr != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

struct Report : FinishedBatch {
  ReportOptions options;
  std::vector<std::string> varied;  // names of columns: swept keys, and what scripts drew
};

Report read_report(const std::string& folder, const ReportOptions& options) {
  Report report{open_finished_batch(folder), options, {}};
  report.varied = report.swept;
  for (const std::string& column : report.table.columns)
    if (column.rfind("random.", 0) == 0) report.varied.push_back(column);
  return report;
}

bool is_metric(const Report& report, const std::string& column) {
  for (const char* other : {"seed", "status", "state_hash", "bytes", "variant"})
    if (column == other) return false;
  return std::find(report.varied.begin(), report.varied.end(), column) == report.varied.end();
}

// Metrics that are not the same everywhere.
std::vector<std::size_t> columns_to_plot(const Report& report) {
  std::vector<std::size_t> columns;
  for (std::size_t c = 0; c < report.table.columns.size(); ++c) {
    if (!is_metric(report, report.table.columns[c])) continue;
    std::vector<std::string> seen;
    for (const auto& row : report.table.rows)
      if (to_number(row[c]) && std::find(seen.begin(), seen.end(), row[c]) == seen.end() && seen.size() < 2)
        seen.push_back(row[c]);
    if (seen.size() == 2) columns.push_back(c);
  }
  return columns;
}

std::string histograms(const Report& report) {
  std::string plots;
  for (const std::size_t c : columns_to_plot(report)) {
    std::vector<double> values;
    for (const auto& row : report.table.rows)
      if (const auto value = to_number(row[c])) values.push_back(*value);
    plots += make_histogram(report.table.columns[c], values);
  }
  return plots.empty() ? "" : "<h2>Metrics</h2>\n<div class=\"plots\">\n" + plots + "</div>\n";
}

// A metric over a key; what is no number is a category.
std::string scatter(const Report& report, std::size_t key, std::size_t metric) {
  std::vector<std::string> categories;
  for (const auto& row : report.table.rows)
    if (!row[key].empty() && !to_number(row[key]) &&
        std::find(categories.begin(), categories.end(), row[key]) == categories.end())
      categories.push_back(row[key]);
  std::vector<PlotPoint> points;
  for (const auto& row : report.table.rows) {
    const auto y = to_number(row[metric]);
    const auto place = std::find(categories.begin(), categories.end(), row[key]);
    const auto x = categories.empty()          ? to_number(row[key])
                   : place == categories.end() ? std::nullopt
                                               : std::optional<double>(place - categories.begin());
    if (x && y)
      points.push_back({*x, *y, report.run_of(row), report.status_of(row) != "done"});
  }
  return make_scatter(report.table.columns[key], report.table.columns[metric], points, categories);
}

std::string scatters(const Report& report) {
  std::string text;
  std::size_t count = 0;
  const std::vector<std::size_t> metrics = columns_to_plot(report);
  for (const std::string& key : report.varied) {
    const int column = report.table.find(key);
    if (column < 0) continue;
    std::string plots;
    for (const std::size_t metric : metrics)
      if (count++ < kMostPlots) plots += scatter(report, std::size_t(column), metric);
    if (!plots.empty())
      text += "<h2>Over " + html_escape(key) + "</h2>\n<div class=\"plots\">\n" + plots + "</div>\n";
  }
  if (count > kMostPlots) text += "<p>Further plots were left out.</p>\n";
  return text;
}

// The average of the pixels that each new one covers.
RgbImage shrink(const RgbImage& image, int width) {
  if (image.width <= width) return image;
  RgbImage small{width, std::max(1, int(std::lround(double(image.height) * width / image.width))), {}};
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      const int x0 = x * image.width / small.width, x1 = std::max(x0 + 1, (x + 1) * image.width / small.width);
      const int y0 = y * image.height / small.height, y1 = std::max(y0 + 1, (y + 1) * image.height / small.height);
      for (int c = 0; c < 3; ++c) {
        int sum = 0;
        for (int v = y0; v < y1; ++v)
          for (int u = x0; u < x1; ++u) sum += image.rgb[std::size_t((v * image.width + u) * 3 + c)];
        small.rgb.push_back(std::uint8_t(sum / ((x1 - x0) * (y1 - y0))));
      }
    }
  return small;
}

// The middle one of the colour pictures in the run's contact sheet, at its own size; of another picture all of it.
RgbImage choose_picture(const std::string& file, int width) {
  RgbImage sheet = read_rgb_png(file);
  std::vector<RgbImage> tiles = cut_colour_tiles(sheet);
  return shrink(tiles.empty() ? sheet : tiles[tiles.size() / 2], width);
}

std::string picture(const Report& report, const std::vector<std::string>& row) {
  const std::string run = report.run_of(row), sheet = run + "/preview.png", file = report.folder + "/" + sheet;
  std::error_code failed;
  if (!fs::is_regular_file(file, failed)) return "";
  const RgbImage image = choose_picture(file, report.options.width);
  std::string values;
  for (const std::string& key : report.varied)
    if (const int column = report.table.find(key); column >= 0)
      values += ", " + key + " = " + row[std::size_t(column)];
  if (report.status_of(row) != "done") values += ", " + report.status_of(row);
  const std::string way = url_escape(report.options.way);
  return "<figure><a href=\"" + way + url_escape(sheet) + "\"><img loading=\"lazy\" decoding=\"async\" alt=\"" + html_escape(run) +
         "\" width=\"" + std::to_string(image.width) + "\" height=\"" + std::to_string(image.height) +
         "\" src=\"data:image/jpeg;base64," + base64(encode_jpeg(image.width, image.height, image.rgb.data(), 80)) +
         "\"></a><figcaption><a href=\"" + way + url_escape(run) + "/\">" + html_escape(run) + "</a>" + html_escape(values) +
         "</figcaption></figure>\n";
}

std::string pictures(const Report& report) {
  std::string text;
  int count = 0, left_out = 0, without = 0;
  for (const auto& row : report.table.rows) {
    if (report.status_of(row) != "done" && report.status_of(row) != "did_not_settle") continue;
    if (count >= report.options.pictures) {
      ++left_out;
      continue;
    }
    const std::string one = picture(report, row);
    ++(one.empty() ? without : count);
    text += one;
  }
  if (text.empty()) return "";
  return "<h2>Pictures</h2>\n<p>The middle one of the frames in each run's contact sheet, which a click opens.</p>\n"
         "<div class=\"pictures\">\n" + text + "</div>\n" +
         (without ? "<p>Runs without a contact sheet (outputs.preview): " + std::to_string(without) + ".</p>\n" : "") +
         (left_out ? "<p>Further runs, without pictures here (--pictures): " + std::to_string(left_out) + ".</p>\n" : "");
}

std::string cell(const Report& report, const std::vector<std::string>& row, std::size_t c) {
  const std::string& name = report.table.columns[c];
  if (name == "seed")
    return "<td data-value=\"" + html_escape(row[c]) + "\"><a href=\"" +
           url_escape(report.options.way + report.run_of(row)) + "/\">" + html_escape(row[c]) + "</a></td>";
  const bool text = !row[c].empty() && !to_number(row[c]);
  return std::string(text ? "<td class=\"text\">" : "<td>") + html_escape(row[c]) + "</td>";
}

std::string table(const Report& report) {
  std::string text = "<h2>Table</h2>\n<div class=\"scroll\"><table class=\"runs\">\n<thead><tr>";
  for (const std::string& column : report.table.columns)
    text += "<th scope=\"col\">" + html_escape(column) + "</th>";
  text += "</tr></thead>\n<tbody>\n";
  for (const auto& row : report.table.rows) {
    text += report.status_of(row) == "done" ? "<tr>" : "<tr class=\"bad\">";
    for (std::size_t c = 0; c < row.size(); ++c) text += cell(report, row, c);
    text += "</tr>\n";
  }
  return text + "</tbody>\n</table></div>\n";
}

std::string summary(const Report& report) {
  std::map<std::string, int> counts;
  for (const auto& row : report.table.rows) ++counts[report.status_of(row)];
  std::string text = "<h1>" + html_escape(report.mission) + "</h1>\n<p>" +
                     std::to_string(report.table.rows.size()) + " runs, seeds " +
                     html_escape(report.seeds);
  for (const auto& [status, count] : counts)
    text += ", " + std::to_string(count) + " " + html_escape(status);
  return text + ". Made by rubble " + html_escape(report.program) +
         ". The figures: <a href=\"" + url_escape(report.options.way) + "index.csv\">index.csv</a>; what they mean: docs/how_to/reproducing.md.</p>\n";
}

}  // namespace

std::string make_batch_report(const std::string& folder, const ReportOptions& options) {
  const Report report = read_report(folder, options);
  return make_page(report.mission + ": batch",
                   summary(report) + make_mean_tables(report, report.varied, columns_to_plot(report)) + pictures(report) +
                       histograms(report) + scatters(report) + table(report),
                   kSorter);
}

}  // namespace rubble
