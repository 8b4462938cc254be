// What a sensor that scans has measured, seen from above: a tile of a contact sheet.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <unordered_map>
#include <vector>

#include "render/scene/range_scan.h"

namespace rubble {

// Takes the scans of one sensor in their order, remembers moments, and draws these when all scans have come: all plans of a
// flight then show the same part of the world in the same colours.
class ScanPlan {
 public:
  // The last scan before a moment, and how much came before it.
  struct Moment {
    std::vector<Vec3> echoes;  // of that scan, each placed by the true motion; in the world; unit: m
    std::size_t scans = 0;     // until then, with that one
  };

  void add(const RangeScan& scan);
  Moment now() const { return {last_echoes_, way_.size()}; }

  // To be called before draw(), with all moments that will be drawn.
  void frame(const std::vector<const Moment*>& moments);
  // CV_8UC3. Echoes of the last scan are coloured by height, warm is high; those of earlier scans are grey; the way of the
  // sensor is a line that ends in a dot. X is to the right, Y is up; a bar shows a length.
  cv::Mat draw(const Moment& moment, const cv::Size& size) const;
  // The heights between which the colours change, such as "0.1 to 1.4 m"; and of the bar, such as "bar 1 m".
  std::string heights() const;
  std::string bar(const cv::Size& size) const;

 private:
  struct View;
  View view(const cv::Size& size) const;

  std::vector<Vec3> last_echoes_;
  std::vector<Vec3> way_;  // by scan: where the sensor was; unit: m
  std::unordered_map<std::uint64_t, std::size_t> cells_;  // of the ground plan, to the number of the first scan that met it
  double x0_ = -1, x1_ = 1, y0_ = -1, y1_ = 1;            // what is drawn; unit: m
  double low_ = 0, high_ = 1;                             // heights; unit: m
};

}  // namespace rubble
