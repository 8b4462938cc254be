// Words on pictures that people look at: contact sheets.
#pragma once

#include <opencv2/imgproc.hpp>
#include <string>

namespace rubble {

// Of a sheet; in the order blue, green, red.
inline const cv::Scalar kPaper(28, 24, 22), kInk(232, 232, 230), kFaint(150, 148, 144);

// size 0.45: letters of about 10 pixels. origin: the left end of the baseline.
inline void put_label(cv::Mat& sheet, const std::string& text, cv::Point origin, double size,
                      const cv::Scalar& ink) {
  cv::putText(sheet, text, origin, cv::FONT_HERSHEY_SIMPLEX, size, ink, 1, cv::LINE_AA);
}

// unit: pixel
inline int label_width(const std::string& text, double size) {
  int baseline = 0;
  return cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, size, 1, &baseline).width;
}

}  // namespace rubble
