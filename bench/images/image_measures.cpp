#include "bench/images/image_measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>

#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"

namespace rubble {

namespace {

constexpr double kPi = portable::kPi;

double kurtosis_of_differences(const Luma& image) {
  double second = 0, fourth = 0;
  std::size_t count = 0;
  const auto add = [&](float difference) {
    const double d2 = double(difference) * double(difference);
    second += d2, fourth += d2 * d2, ++count;
  };
  for (int y = 0; y + 1 < image.height; ++y) {
    for (int x = 0; x + 1 < image.width; ++x) {
      add(image.at(x + 1, y) - image.at(x, y));
      add(image.at(x, y + 1) - image.at(x, y));
    }
  }
  return second > 0 ? fourth * double(count) / (second * second) : 0;
}

double share_of_flat(const Luma& image) {
  constexpr float kFlat = 1;  // unit: step
  std::size_t flat = 0, count = 0;
  for (int y = 1; y + 1 < image.height; ++y) {
    for (int x = 1; x + 1 < image.width; ++x, ++count) {
      const auto p = [&](int dx, int dy) { return image.at(x + dx, y + dy); };
      const float across = p(1, -1) + 2 * p(1, 0) + p(1, 1) - p(-1, -1) - 2 * p(-1, 0) - p(-1, 1);
      const float down = p(-1, 1) + 2 * p(0, 1) + p(1, 1) - p(-1, -1) - 2 * p(0, -1) - p(1, -1);
      flat += std::sqrt(across * across + down * down) / 8 < kFlat;
    }
  }
  return double(flat) / double(count);
}

using Complex = std::complex<double>;

// In place, of a power of two (Cooley and Tukey 1965), with a stride.
void transform(Complex* values, std::size_t count, std::size_t stride) {
  for (std::size_t i = 1, j = 0; i < count; ++i) {
    std::size_t bit = count >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(values[i * stride], values[j * stride]);
  }
  for (std::size_t length = 2; length <= count; length *= 2) {
    const Complex turn = std::polar(1.0, -2 * kPi / double(length));
    for (std::size_t first = 0; first < count; first += length) {
      Complex phase = 1;
      for (std::size_t k = 0; k < length / 2; ++k, phase *= turn) {
        Complex& low = values[(first + k) * stride];
        Complex& high = values[(first + k + length / 2) * stride];
        const Complex odd = high * phase;
        high = low - odd, low += odd;
      }
    }
  }
}

// The middle of the image under a window that falls to nothing at the border.
std::vector<Complex> windowed_square(const Luma& image, std::size_t side) {
  const int left = (image.width - int(side)) / 2, top = (image.height - int(side)) / 2;
  double mean = 0;
  for (const float v : image.values) mean += double(v) / double(image.values.size());
  std::vector<Complex> out(side * side);
  const auto window = [&](std::size_t i) { return 0.5 - 0.5 * std::cos(2 * kPi * (double(i) + 0.5) / double(side)); };
  for (std::size_t y = 0; y < side; ++y)
    for (std::size_t x = 0; x < side; ++x)
      out[y * side + x] =
          (double(image.at(left + int(x), top + int(y))) - mean) * window(x) * window(y);
  return out;
}

double slope_of_line(const std::vector<std::array<double, 2>>& points) {
  double x = 0, y = 0, xx = 0, xy = 0;
  const double n = double(points.size());
  for (const auto& p : points) x += p[0], y += p[1], xx += p[0] * p[0], xy += p[0] * p[1];
  return (n * xy - x * y) / (n * xx - x * x);
}

double slope_of_spectrum(const Luma& image) {
  std::size_t side = 1;
  while (int(side * 2) <= std::min(image.width, image.height)) side *= 2;
  std::vector<Complex> values = windowed_square(image, side);
  for (std::size_t y = 0; y < side; ++y) transform(&values[y * side], side, 1);
  for (std::size_t x = 0; x < side; ++x) transform(&values[x], side, side);
  std::vector<double> sums(side, 0);
  std::vector<int> counts(side, 0);
  const auto signed_frequency = [&](std::size_t i) {
    return i < side / 2 ? double(i) : double(i) - double(side);
  };
  for (std::size_t y = 0; y < side; ++y) {
    for (std::size_t x = 0; x < side; ++x) {
      const double f = std::hypot(signed_frequency(x), signed_frequency(y));
      const std::size_t ring = std::size_t(std::lround(f));
      if (ring < side) sums[ring] += std::abs(values[y * side + x]), ++counts[ring];
    }
  }
  std::vector<std::array<double, 2>> points;
  for (std::size_t ring = 8; ring <= side / 4; ++ring)
    if (sums[ring] > 0)
      points.push_back({std::log(double(ring)), std::log(sums[ring] / counts[ring])});
  return points.size() > 1 ? slope_of_line(points) : 0;
}

// In double precision: variances are small differences of large squares.
struct Plane {
  int width, height;
  std::vector<double> values;
};

// Of a product of two images: blurred by a Gaussian of 1.5 pixels, 11 wide, where the whole of it lies
// in the image.
Plane blurred_product(const std::vector<double>& a, const std::vector<double>& b, int width, int height) {
  std::array<double, 11> kernel;
  double sum = 0;
  for (int i = 0; i < 11; ++i) sum += kernel[std::size_t(i)] = std::exp(-(i - 5) * (i - 5) / 4.5);
  for (double& k : kernel) k /= sum;
  Plane rows{width - 10, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < rows.width; ++x) {
      const std::size_t at = std::size_t(y) * std::size_t(width) + std::size_t(x);
      double v = 0;
      for (std::size_t i = 0; i < 11; ++i) v += kernel[i] * a[at + i] * b[at + i];
      rows.values.push_back(v);
    }
  }
  Plane out{rows.width, height - 10, {}};
  const std::size_t stride = std::size_t(rows.width);
  for (std::size_t at = 0; at < stride * std::size_t(out.height); ++at) {
    double v = 0;
    for (std::size_t i = 0; i < 11; ++i) v += kernel[i] * rows.values[at + i * stride];
    out.values.push_back(v);
  }
  return out;
}

void check_sizes(int width, int height, int other_width, int other_height) {
  if (width != other_width || height != other_height)
    throw RunError("two pictures of different sizes, " + std::to_string(width) + " x " +
                   std::to_string(height) + " and " + std::to_string(other_width) + " x " +
                   std::to_string(other_height) + ", cannot be compared");
}

}  // namespace

Luma luma_of(const std::uint8_t* rgb, int width, int height) {
  Luma out{width, height, {}};
  const std::size_t size = std::size_t(width) * std::size_t(height);
  for (std::size_t i = 0; i < size; ++i)
    out.values.push_back(0.299f * float(rgb[i * 3]) + 0.587f * float(rgb[i * 3 + 1]) +
                         0.114f * float(rgb[i * 3 + 2]));
  return out;
}

ImageStatistics measure_image(const Luma& image) {
  if (image.width < 32 || image.height < 32)
    throw RunError("a picture of " + std::to_string(image.width) + " x " +
                   std::to_string(image.height) + " pixels is too small: 32 x 32 at least");
  ImageStatistics out;
  out.gradient_kurtosis = kurtosis_of_differences(image);
  out.flat_share = share_of_flat(image);
  out.spectral_slope = slope_of_spectrum(image);
  for (const float v : image.values) {
    out.mean += double(v) / double(image.values.size());
    out.clipped += (v <= 0 || v >= 254.99f) / double(image.values.size());
  }
  return out;
}

double structural_similarity(const Luma& a, const Luma& b) {
  check_sizes(a.width, a.height, b.width, b.height);
  if (a.width < 11 || a.height < 11) throw RunError("structural similarity needs 11 x 11 pixels at least");
  constexpr double kC1 = 0.01 * 255 * 0.01 * 255, kC2 = 0.03 * 255 * 0.03 * 255;
  const std::vector<double> one(a.values.size(), 1), va(a.values.begin(), a.values.end());
  const std::vector<double> vb(b.values.begin(), b.values.end());
  const auto blur = [&](const std::vector<double>& u, const std::vector<double>& v) {
    return blurred_product(u, v, a.width, a.height);
  };
  const Plane ma = blur(va, one), mb = blur(vb, one);
  const Plane aa = blur(va, va), bb = blur(vb, vb), ab = blur(va, vb);
  double sum = 0;
  for (std::size_t i = 0; i < ma.values.size(); ++i) {
    const double x = ma.values[i], y = mb.values[i];
    const double vx = aa.values[i] - x * x, vy = bb.values[i] - y * y;
    const double cov = ab.values[i] - x * y;
    sum += (2 * x * y + kC1) * (2 * cov + kC2) / ((x * x + y * y + kC1) * (vx + vy + kC2));
  }
  return sum / double(ma.values.size());
}

RegionDifference compare_regions(const std::vector<float>& a, const std::vector<float>& b, int width,
                                 int height, int columns, int rows) {
  std::vector<double> sum_a(std::size_t(columns * rows)), sum_b = sum_a, counts = sum_a;
  double all_a = 0, all_b = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t i = std::size_t(y) * std::size_t(width) + std::size_t(x);
      const std::size_t r = std::size_t(y * rows / height * columns + x * columns / width);
      sum_a[r] += double(a[i]), sum_b[r] += double(b[i]), counts[r] += 1;
      all_a += double(a[i]), all_b += double(b[i]);
    }
  }
  RegionDifference out;
  const double least = 0.01 * all_a / double(a.size());
  out.bias = all_b / all_a - 1;
  for (std::size_t r = 0; r < counts.size(); ++r) {
    const double mean = sum_a[r] / counts[r];
    const double error = std::fabs(sum_b[r] / counts[r] - mean) / std::max(mean, least);
    out.mean_error += error / double(counts.size());
    if (error <= out.worst_error) continue;
    out.worst_error = error;
    out.worst_column = int(r) % columns, out.worst_row = int(r) / columns;
  }
  return out;
}

}  // namespace rubble
