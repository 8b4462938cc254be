// Small plots as SVG: inline in pages, or as a file.
#pragma once

#include <string>
#include <vector>

namespace rubble {

struct PlotPoint {
  double x = 0, y = 0;  // in the units of the axes
  std::string name;     // shown where the pointer rests
  bool bad = false;     // drawn in another colour
};

// How often values fall into each of `bins` equal parts of their range; of one value all are one bar.
std::string make_histogram(const std::string& title, const std::vector<double>& values, int bins = 12);

// categories: names of x = 0, 1, ... where x is no number; empty: it is one.
std::string make_scatter(const std::string& x_title, const std::string& y_title,
                         const std::vector<PlotPoint>& points,
                         const std::vector<std::string>& categories = {});

struct PlotLine {
  std::string name;  // shown where the pointer rests, and as the key of the plot
  std::vector<PlotPoint> points;
};

// The first line is drawn dark, the second in another colour. equal: one scale for both axes, as in a plan.
std::string make_lines(const std::string& x_title, const std::string& y_title, const std::vector<PlotLine>& lines,
                       bool equal = false);

// Plots beside each other, as the text of an SVG file of its own.
std::string make_svg_file(const std::vector<std::string>& plots);

}  // namespace rubble
