// image_statistics: figures of pictures by which a rendering is told from a photograph, and of pairs.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "bench/images/image_measures.h"
#include "bench/images/picture_file.h"
#include "bench/program.h"

namespace rubble {
namespace {

struct Request {
  std::vector<std::string> pictures;
  std::string against;
  int regions = 8;
  bool csv = false;
};

Luma luma_of_picture(const Picture& picture) {
  return luma_of(picture.rgb.data(), picture.width, picture.height);
}

// Light in proportion to what was seen, by sRGB's transfer function.
std::vector<float> light_of(const Luma& image) {
  std::vector<float> out;
  for (const float v : image.values) {
    const float s = v / 255;
    out.push_back(s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f));
  }
  return out;
}

void print_head(const Request& request) {
  if (request.csv)
    std::printf("picture,width,height,gradient_kurtosis,flat_share,keypoints_per_megapixel,"
                "spectral_slope,mean_luma,clipped%s\n",
                request.against.empty() ? "" : ",similarity,mean_error,worst_error,bias");
  else
    std::printf("%-40s %9s %8s %6s %7s %7s %6s %8s%s\n", "picture", "size", "kurtosis", "flat", "SIFT/MP",
                "slope", "mean", "clipped",
                request.against.empty() ? "" : "   SSIM   mean error      worst (column, row)    bias");
}

void print_statistics(const Request& request, const std::string& path, const Picture& picture) {
  const ImageStatistics s = measure_image(luma_of_picture(picture));
  const double density = count_keypoints(picture) * 1e6 / (double(picture.width) * picture.height);
  const char* format = request.csv ? "%s,%d,%d,%.2f,%.4f,%.0f,%.3f,%.1f,%.4f"
                                   : "%-40s %4dx%4d %8.1f %6.3f %7.0f %7.2f %6.1f %8.4f";
  std::printf(format, path.c_str(), picture.width, picture.height, s.gradient_kurtosis, s.flat_share,
              density, s.spectral_slope, s.mean, s.clipped);
}

void print_comparison(const Request& request, const Picture& expected, const Picture& picture) {
  const Luma a = luma_of_picture(expected), b = luma_of_picture(picture);
  const double similarity = structural_similarity(a, b);
  const RegionDifference d = compare_regions(light_of(a), light_of(b), a.width, a.height,
                                             request.regions, request.regions);
  if (request.csv)
    std::printf(",%.4f,%.4f,%.4f,%.4f", similarity, d.mean_error, d.worst_error, d.bias);
  else
    std::printf(" %6.4f %10.1f %% %10.1f %% (%2d, %2d) %6.1f %%", similarity, 100 * d.mean_error,
                100 * d.worst_error, d.worst_column, d.worst_row, 100 * d.bias);
}

ExitCode measure(const Request& request) {
  Picture expected;
  if (!request.against.empty()) expected = read_picture(request.against);
  print_head(request);
  for (const std::string& path : request.pictures) {
    const Picture picture = read_picture(path);
    print_statistics(request, path, picture);
    if (!request.against.empty()) print_comparison(request, expected, picture);
    std::printf("\n");
  }
  return ExitCode::done;
}

ExitCode run(int argc, char** argv) {
  CLI::App app{
      "Figures of pictures: kurtosis of the gradient, share of flat pixels, SIFT keypoints a megapixel, "
      "slope of the amplitude spectrum, mean, share of clipped pixels (definitions and what photographs "
      "have: bench/images/image_measures.h). With --against also each picture beside that one: structural "
      "similarity, and differences of light by region."};
  Request request;
  app.add_option("pictures", request.pictures, "PNG or JPEG files")->required();
  app.add_option("--against", request.against, "The picture that the others are compared with");
  app.add_option("--regions", request.regions, "Regions across and down")->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_flag("--csv", request.csv, "Comma-separated values");
  return parse_and_run(app, argc, argv, [&] { return measure(request); });
}

}  // namespace
}  // namespace rubble

int main(int argc, char** argv) {
  return rubble::run_program("image_statistics", [=] { return rubble::run(argc, argv); });
}
