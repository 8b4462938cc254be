#include "app/report/svg_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "app/report/html_text.h"

namespace rubble {
namespace {

constexpr double kWidth = 280, kHeight = 170, kLeft = 46, kRight = 8, kTop = 18, kBottom = 30;

struct Span {
  double low = 0, high = 1;
};

Span span_of(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  if (*low < *high) return {*low, *high};
  const double half = std::max(1e-9, std::abs(*low) * 0.05);
  return {*low - half, *low + half};
}

double to_x(double value, Span span) {
  return kLeft + (value - span.low) / (span.high - span.low) * (kWidth - kLeft - kRight);
}
double to_y(double value, Span span) {
  return kHeight - kBottom - (value - span.low) / (span.high - span.low) * (kHeight - kTop - kBottom);
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string text_at(double x, double y, const char* anchor, const std::string& text) {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor + "\">" +
         html_escape(text) + "</text>";
}

std::string line(double x1, double y1, double x2, double y2) {
  return "<line class=\"axis\" x1=\"" + number(x1) + "\" y1=\"" + number(y1) + "\" x2=\"" +
         number(x2) + "\" y2=\"" + number(y2) + "\"/>";
}

std::string begin(const std::string& title) {
  return "<svg role=\"img\" width=\"" + number(kWidth) + "\" height=\"" + number(kHeight) +
         "\" viewBox=\"0 0 " + number(kWidth) + " " + number(kHeight) + "\">" +
         text_at(kWidth / 2, 11, "middle", title) +
         line(kLeft, kHeight - kBottom, kWidth - kRight, kHeight - kBottom) +
         line(kLeft, kTop, kLeft, kHeight - kBottom);
}

std::string ends_of_x(Span x) {
  return text_at(kLeft, kHeight - kBottom + 12, "start", number(x.low)) +
         text_at(kWidth - kRight, kHeight - kBottom + 12, "end", number(x.high));
}
std::string ends_of_y(Span y) {
  return text_at(kLeft - 4, kHeight - kBottom, "end", number(y.low)) +
         text_at(kLeft - 4, kTop + 8, "end", number(y.high));
}

// Widens one of the two, so that a unit is as long on both axes.
void make_equal(Span& x, Span& y) {
  const double width = kWidth - kLeft - kRight, height = kHeight - kTop - kBottom;
  const double unit = std::max((x.high - x.low) / width, (y.high - y.low) / height);
  for (const auto& [span, size] : {std::pair{&x, width}, {&y, height}}) {
    const double middle = 0.5 * (span->low + span->high);
    *span = {middle - 0.5 * unit * size, middle + 0.5 * unit * size};
  }
}

constexpr char kPlotStyle[] =
    "<style>svg{font:9px sans-serif;background:#fff}.axis{stroke:#888}.bar{fill:#4a6d8c}.dot{fill:#4a6d8c}"
    ".dot.bad{fill:#c0392b}.line{fill:none;stroke:#333;stroke-width:1.4}.line.second{stroke:#c0392b}"
    "g.second text{fill:#c0392b}</style>";

}  // namespace

std::string make_histogram(const std::string& title, const std::vector<double>& values, int bins) {
  if (values.empty()) return "";
  const Span x = span_of(values);
  std::vector<int> counts(std::size_t(bins), 0);
  for (const double value : values) {
    const int bin = int((value - x.low) / (x.high - x.low) * bins);
    ++counts[std::size_t(std::min(std::max(bin, 0), bins - 1))];
  }
  const Span y{0, double(*std::max_element(counts.begin(), counts.end()))};
  std::string svg = begin(title) + ends_of_x(x) + ends_of_y(y);
  for (int i = 0; i < bins; ++i) {
    const double low = x.low + (x.high - x.low) * i / bins, high = x.low + (x.high - x.low) * (i + 1) / bins;
    const int count = counts[std::size_t(i)];
    if (count == 0) continue;
    svg += "<rect class=\"bar\" x=\"" + number(to_x(low, x) + 0.5) + "\" y=\"" + number(to_y(count, y)) +
           "\" width=\"" + number(to_x(high, x) - to_x(low, x) - 1) + "\" height=\"" +
           number(kHeight - kBottom - to_y(count, y)) + "\"><title>" + number(low) + " to " +
           number(high) + ": " + std::to_string(count) + "</title></rect>";
  }
  return svg + "</svg>\n";
}

std::string make_scatter(const std::string& x_title, const std::string& y_title,
                         const std::vector<PlotPoint>& points,
                         const std::vector<std::string>& categories) {
  if (points.empty()) return "";
  std::vector<double> xs, ys;
  for (const PlotPoint& point : points) xs.push_back(point.x), ys.push_back(point.y);
  const Span x = categories.empty() ? span_of(xs) : Span{-0.5, double(categories.size()) - 0.5};
  const Span y = span_of(ys);
  std::string svg = begin(y_title) + ends_of_y(y) +
                    text_at((kLeft + kWidth) / 2, kHeight - 4, "middle", x_title);
  if (categories.empty()) svg += ends_of_x(x);
  for (std::size_t i = 0; i < categories.size(); ++i)
    svg += text_at(to_x(double(i), x), kHeight - kBottom + 12, "middle", categories[i]);
  for (const PlotPoint& point : points)
    svg += "<circle class=\"dot" + std::string(point.bad ? " bad" : "") + "\" cx=\"" +
           number(to_x(point.x, x)) + "\" cy=\"" + number(to_y(point.y, y)) + "\" r=\"3\"><title>" +
           html_escape(point.name) + ": " + number(point.x) + ", " + number(point.y) +
           "</title></circle>";
  return svg + "</svg>\n";
}

std::string make_lines(const std::string& x_title, const std::string& y_title, const std::vector<PlotLine>& lines,
                       bool equal) {
  std::vector<double> xs, ys;
  for (const PlotLine& line : lines)
    for (const PlotPoint& point : line.points) xs.push_back(point.x), ys.push_back(point.y);
  if (xs.empty()) return "";
  Span x = span_of(xs), y = span_of(ys);
  if (equal) make_equal(x, y);
  std::string svg = begin(y_title) + ends_of_x(x) + ends_of_y(y) +
                    text_at((kLeft + kWidth) / 2, kHeight - 4, "middle", x_title);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string kind = i == 0 ? "" : " second";
    svg += "<polyline class=\"line" + kind + "\" points=\"";
    for (const PlotPoint& point : lines[i].points) svg += number(to_x(point.x, x)) + "," + number(to_y(point.y, y)) + " ";
    svg += "\"><title>" + html_escape(lines[i].name) + "</title></polyline>";
    if (lines.size() < 2) continue;
    svg += "<g" + std::string(i == 0 ? "" : " class=\"second\"") + ">" +
           text_at(kWidth - kRight, kTop + 8 + 11 * double(i), "end", lines[i].name) + "</g>";
  }
  return svg + "</svg>\n";
}

std::string make_svg_file(const std::vector<std::string>& plots) {
  const double width = kWidth * double(plots.size());
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + number(2 * width) + "\" height=\"" +
                    number(2 * kHeight) + "\" viewBox=\"0 0 " + number(width) + " " + number(kHeight) + "\">" + kPlotStyle + "\n";
  for (std::size_t i = 0; i < plots.size(); ++i)
    svg += "<g transform=\"translate(" + number(kWidth * double(i)) + " 0)\">" + plots[i] + "</g>\n";
  return svg + "</svg>\n";
}

}  // namespace rubble
