// Figures by which rendered pictures are told from photographs, and by which two pictures are compared.
// All are of the luma of the stored 8-bit values, 0.299 R + 0.587 G + 0.114 B.
#pragma once

#include <cstdint>
#include <vector>

namespace rubble {

// Rows from the top; unit: step of 255.
struct Luma {
  int width = 0, height = 0;  // unit: pixel
  std::vector<float> values;

  float at(int x, int y) const { return values[std::size_t(y) * std::size_t(width) + std::size_t(x)]; }
};
Luma luma_of(const std::uint8_t* rgb, int width, int height);

struct ImageStatistics {
  // Fourth moment of the differences of neighbours, across and down, over the square of the second.
  // 3: as of normal noise; photographs 6 to 27.
  double gradient_kurtosis = 0;
  // Share of pixels whose gradient (by Sobel's kernels, over 8) is below 1 step. Photographs .09 to .54.
  double flat_share = 0;
  // Exponent of the amplitude over the frequency, by a line through the logarithms of the means over
  // rings from 8 cycles an image to a quarter of a cycle a pixel, of the largest square of a power of
  // two in the middle under a Hann window. Photographs -0.8 to -1.5, mean -1.2 (Tolhurst, Tadmor and
  // Chao 1992, "Amplitude spectra of natural images").
  double spectral_slope = 0;
  double mean = 0;       // luma
  double clipped = 0;    // share of pixels at 0 or 255
};
// The image must be 32 pixels wide and high at least.
ImageStatistics measure_image(const Luma& image);

// Mean structural similarity with a Gaussian window of 1.5 pixels (Wang, Bovik, Sheikh and Simoncelli
// 2004, "Image quality assessment"); 1: equal. Both of one size, 11 pixels at least.
double structural_similarity(const Luma& a, const Luma& b);

// A grid of rectangles over two pictures of one size.
struct RegionDifference {
  double mean_error = 0;   // mean over the regions of |b - a| / a, of the regions' means
  double worst_error = 0;  // the largest of them
  int worst_column = 0, worst_row = 0;
  double bias = 0;         // mean of b over the mean of a, less 1
};
// values: one a pixel, in any linear unit. Regions darker than 1 % of the mean count as that dark.
RegionDifference compare_regions(const std::vector<float>& a, const std::vector<float>& b, int width,
                                 int height, int columns, int rows);

}  // namespace rubble
