#include "render/optics/line_filters.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/parallel.h"

namespace rubble {

namespace {

constexpr std::size_t kTogether = 16;  // lines that a job takes, so that columns share cache lines

// Where pixel i of a line of n is, the line mirrored beyond both ends.
std::size_t mirrored(std::ptrdiff_t i, std::ptrdiff_t n) {
  const std::ptrdiff_t period = 2 * n;
  i = ((i % period) + period) % period;
  return std::size_t(i < n ? i : period - 1 - i);
}

// The lines of an image in one direction: of each row, or column, and colour.
struct Lines {
  Lines(const LinearImage& image, bool across)
      : horizontal(across), width(std::size_t(image.width)), height(std::size_t(image.height)) {}
  std::size_t count() const { return 3 * (horizontal ? height : width); }
  std::size_t length() const { return horizontal ? width : height; }
  std::size_t step() const { return horizontal ? 3 : 3 * width; }
  std::size_t begin(std::size_t line) const {
    return horizontal ? line / 3 * (3 * width) + line % 3 : line;
  }

  bool horizontal;
  std::size_t width, height;
};

// Calls filter(padded line, output) for every line; `pad` pixels are mirrored on either side.
template <typename Filter>
void filter_lines(LinearImage& image, const Lines& lines, std::size_t pad, int threads,
                  const Filter& filter) {
  const std::size_t n = lines.length(), wide = n + 2 * pad;
  parallel_for((lines.count() + kTogether - 1) / kTogether, threads, [&](std::size_t job) {
    const std::size_t first = job * kTogether, end = std::min(first + kTogether, lines.count());
    std::vector<double> padded(kTogether * wide), out(n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t line = first; line < end; ++line)
        padded[(line - first) * wide + pad + i] =
            double(image.rgb[lines.begin(line) + i * lines.step()]);
    for (std::size_t line = first; line < end; ++line) {
      double* const values = padded.data() + (line - first) * wide;
      for (std::size_t i = 0; i < pad; ++i) {
        values[i] = values[pad + mirrored(std::ptrdiff_t(i) - std::ptrdiff_t(pad), std::ptrdiff_t(n))];
        values[pad + n + i] = values[pad + mirrored(std::ptrdiff_t(n + i), std::ptrdiff_t(n))];
      }
      filter(values, out);
      std::copy(out.begin(), out.end(), values);
    }
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t line = first; line < end; ++line)
        image.rgb[lines.begin(line) + i * lines.step()] = float(padded[(line - first) * wide + i]);
  });
}

template <typename Filter>
void filter_image(LinearImage& image, std::size_t pad, int threads, const Filter& filter) {
  for (const bool across : {true, false})
    filter_lines(image, Lines(image, across), pad, threads, filter);
}

}  // namespace

std::vector<double> gaussian_weights(double sigma) {
  if (!(sigma > 0)) return {1};
  // Miller's algorithm: downwards by I_(n-1) = I_(n+1) + 2n / t I_n, then to the sum of 1.
  const double t = sigma * sigma;
  const std::size_t most = std::size_t(std::ceil(8 * sigma)) + 16;
  std::vector<double> weights(most + 2, 0);
  weights[most] = 1e-280;
  for (std::size_t n = most; n > 0; --n) {
    weights[n - 1] = weights[n + 1] + 2 * double(n) / t * weights[n];
    if (weights[n - 1] < 1e200) continue;
    for (std::size_t k = n - 1; k < weights.size(); ++k) weights[k] *= 1e-200;
  }
  double sum = weights[0];
  for (std::size_t n = 1; n < weights.size(); ++n) sum += 2 * weights[n];
  while (weights.size() > 1 && weights.back() < 1e-9 * sum) {
    sum -= 2 * weights.back();
    weights.pop_back();
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

void blur_gaussian(LinearImage& image, double sigma, int threads) {
  const std::vector<double> weights = gaussian_weights(sigma);
  const std::size_t reach = weights.size() - 1;
  if (reach == 0) return;
  filter_image(image, reach, threads, [&](const double* in, std::vector<double>& out) {
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double* const middle = in + i + reach;
      double sum = weights[0] * middle[0];
      for (std::size_t k = 1; k <= reach; ++k)
        sum += weights[k] * (middle[std::ptrdiff_t(k)] + middle[-std::ptrdiff_t(k)]);
      out[i] = sum;
    }
  });
}

ExtendedBox make_extended_box(double variance) {
  ExtendedBox box;
  box.radius = int(0.5 * std::sqrt(12 * variance + 1) - 0.5);
  const double r = box.radius, next = (r + 1) * (r + 1);
  box.edge = std::clamp((2 * r + 1) * (r * (r + 1) - 3 * variance) / (6 * (variance - next)), 0.0, 1.0);
  return box;
}

void blur_boxes(LinearImage& image, double variance, int passes, int threads) {
  const ExtendedBox box = make_extended_box(variance);
  const std::size_t r = std::size_t(box.radius);
  const double share = 1 / (2 * double(r) + 1 + 2 * box.edge);
  for (int pass = 0; pass < passes; ++pass)
    filter_image(image, r + 1, threads, [&](const double* in, std::vector<double>& out) {
      double sum = 0;  // of the pixels of weight 1
      for (std::size_t i = 1; i < 2 * r + 2; ++i) sum += in[i];
      for (std::size_t i = 0; i < out.size(); ++i) {
        const double after = in[i + 2 * r + 2];
        out[i] = (sum + box.edge * (in[i] + after)) * share;
        sum += after - in[i + 1];
      }
    });
}

}  // namespace rubble
