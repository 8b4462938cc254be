// Filters along the rows and the columns of a colour image. Beyond its border the image goes on as in a
// mirror, so that each filter keeps the sum of all pixels, and an even image stays even.
#pragma once

#include <vector>

namespace rubble {

// Three floats a pixel, rows from the top.
struct LinearImage {
  int width = 0, height = 0;  // unit: pixel
  std::vector<float> rgb;     // linear light
};

// Weights at 0, 1, 2, ... of the discrete Gaussian exp(-t) I_n(t), t = sigma^2 (Lindeberg 1990,
// "Scale-space for discrete signals"): its variance is sigma^2 for any sigma, and its sum, both sides
// taken, 1. Cut off where a weight is below 1e-9.
std::vector<double> gaussian_weights(double sigma);
void blur_gaussian(LinearImage& image, double sigma, int threads);

// A box of 2 radius + 1 pixels of weight 1 and one pixel of weight `edge` on either side, of any
// variance (Gwosdek, Grewenig, Bruhn and Weickert 2011, "Theoretical Foundations of Gaussian Convolution
// by Extended Box Filtering").
struct ExtendedBox {
  int radius = 0;
  double edge = 0;  // range: 0 to 1
};
ExtendedBox make_extended_box(double variance);
// `passes` such boxes of this variance together, which come near a Gaussian; the time does not depend on
// the variance.
void blur_boxes(LinearImage& image, double variance, int passes, int threads);

}  // namespace rubble
