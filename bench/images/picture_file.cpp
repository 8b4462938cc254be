#include "bench/images/picture_file.h"

#include <opencv2/features2d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "kernel/base/error.h"

namespace rubble {

Picture read_picture(const std::string& path) {
  const cv::Mat stored = cv::imread(path, cv::IMREAD_COLOR);
  if (stored.empty())
    throw InputError({path, 0, "", "cannot be read as a picture", "a PNG or JPEG file", "", ""});
  cv::Mat rgb;
  cv::cvtColor(stored, rgb, cv::COLOR_BGR2RGB);
  Picture out{rgb.cols, rgb.rows, {}};
  for (int y = 0; y < rgb.rows; ++y)
    out.rgb.insert(out.rgb.end(), rgb.ptr(y), rgb.ptr(y) + rgb.cols * 3);
  return out;
}

int count_keypoints(const Picture& picture) {
  const cv::Mat rgb(picture.height, picture.width, CV_8UC3, const_cast<std::uint8_t*>(picture.rgb.data()));
  cv::Mat grey;
  cv::cvtColor(rgb, grey, cv::COLOR_RGB2GRAY);
  std::vector<cv::KeyPoint> points;
  cv::SIFT::create()->detect(grey, points);
  return int(points.size());
}

}  // namespace rubble
