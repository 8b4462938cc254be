#include "render/sensors/bayer.h"

#include <algorithm>
#include <cstdlib>

namespace rubble {

namespace {

// Of a row and column beyond the border: the same colour on the other side of the outermost photosite.
int reflect(int i, int n) { return i < 0 ? -i : i >= n ? 2 * (n - 1) - i : i; }

// The 5 x 5 photosites around one.
class Neighbourhood {
 public:
  Neighbourhood(const std::vector<std::uint16_t>& counts, int width, int height, int x, int y)
      : counts_(counts), width_(width), height_(height), x_(x), y_(y) {}
  int at(int dx, int dy) const {
    return counts_[std::size_t(reflect(y_ + dy, height_)) * std::size_t(width_) +
                   std::size_t(reflect(x_ + dx, width_))];
  }
  int ring(int r) const { return at(r, 0) + at(-r, 0) + at(0, r) + at(0, -r); }
  int corners() const { return at(1, 1) + at(-1, 1) + at(1, -1) + at(-1, -1); }
  // The filters, times 16.
  int green() const { return 8 * at(0, 0) + 4 * ring(1) - 2 * ring(2); }  // at red and blue
  int opposite() const { return 12 * at(0, 0) + 4 * corners() - 3 * ring(2); }  // red at blue
  // At green, the colour whose photosites are on the left and right (or above and below).
  int beside(bool across) const {
    const int dx = across ? 1 : 0, dy = across ? 0 : 1;
    return 10 * at(0, 0) + 8 * (at(dx, dy) + at(-dx, -dy)) - 2 * corners() -
           2 * (at(2 * dx, 2 * dy) + at(-2 * dx, -2 * dy)) + at(2 * dy, 2 * dx) + at(-2 * dy, -2 * dx);
  }

 private:
  const std::vector<std::uint16_t>& counts_;
  int width_, height_, x_, y_;
};

}  // namespace

int mosaic_colour(Mosaic mosaic, int x, int y) {
  // The place of red in the square of two by two; blue is across.
  const int red_x = mosaic == Mosaic::grbg || mosaic == Mosaic::bggr ? 1 : 0;
  const int red_y = mosaic == Mosaic::gbrg || mosaic == Mosaic::bggr ? 1 : 0;
  const int dx = (x ^ red_x) & 1, dy = (y ^ red_y) & 1;
  return dx == dy ? 2 * dx : 1;
}

std::vector<std::uint16_t> demosaic(Mosaic mosaic, int width, int height,
                                    const std::vector<std::uint16_t>& counts, int most) {
  std::vector<std::uint16_t> out(counts.size() * 3);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Neighbourhood n(counts, width, height, x, y);
      const std::size_t at = 3 * (std::size_t(y) * std::size_t(width) + std::size_t(x));
      const auto put = [&](int colour, int value16) {
        out[at + std::size_t(colour)] = std::uint16_t(std::clamp((value16 + 8) >> 4, 0, most));
      };
      const int own = mosaic_colour(mosaic, x, y);
      put(own, 16 * n.at(0, 0));
      if (own == 1) {
        const int across = mosaic_colour(mosaic, x + 1, y);
        put(across, n.beside(true)), put(2 - across, n.beside(false));
      } else {
        put(1, n.green()), put(2 - own, n.opposite());
      }
    }
  }
  return out;
}

}  // namespace rubble
