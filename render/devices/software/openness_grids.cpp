#include "render/devices/software/openness_grids.h"

#include <algorithm>

#include "kernel/base/portable_math.h"

namespace rubble {

namespace {

constexpr int kRows = 16;  // that a thread takes at a time; a multiple of four

// Sixteen angles, each `step` after the one before.
void fill_turns(double step, float (&cosine)[16], float (&sine)[16]) {
  for (int i = 0; i < 16; ++i) {
    cosine[i] = float(portable::cos(step * i));
    sine[i] = float(portable::sin(step * i));
  }
}

ContactData contact_data(const ViewProjection& view, const std::vector<float>& depth_values,
                         const ContactLamp& lamp) {
  const Intrinsics& k = view.intrinsics;
  ContactData out;
  out.depth_values = depth_values.data();
  out.width = k.width, out.height = k.height;
  out.near = kNearPlane;
  out.fx = float(k.fx), out.fy = float(k.fy), out.cx = float(k.cx), out.cy = float(k.cy);
  fill_turns(0.3927, out.lamp_cosine, out.lamp_sine);
  out.lamp_radius = lamp.radius;
  out.lamp[0] = lamp.place.x, out.lamp[1] = lamp.place.y, out.lamp[2] = lamp.place.z;
  return out;
}

}  // namespace

void OpennessGrids::find(const WideShader& shader, const ViewProjection& view,
                         const std::vector<float>& depth_values, const ContactLamp& lamp,
                         int first_row, int last_row, ThreadPool& pool) {
  lamp_ = lamp.on;
  if (!lamp_) return;
  ContactData data = contact_data(view, depth_values, lamp);
  width_ = std::max(1, (data.width + 1) / 2), height_ = std::max(1, (data.height + 1) / 2);
  stride_ = (width_ + 3) / 4 * 4;
  const std::size_t size = std::size_t(stride_) * std::size_t(height_);
  raw_.resize(size), lamp_seen_.resize(size);
  data.half_width = width_, data.half_height = height_, data.stride = stride_;
  data.lamp_seen = raw_.data();
  // A pixel reads the means about it, and they the four rows about them.
  const int first = std::max(first_row / 2 - 4, 0) / kRows;
  const int last = (std::min(last_row / 2 + 5, height_) + kRows - 1) / kRows;
  pool.run(last - first, 1, [&](int begin, int end) {
    shader.find_contacts(data, (first + begin) * kRows, std::min((first + end) * kRows, height_));
  });
  smooth(pool);
}

// The mean of 4 by 4 texels, which is the period of the pattern.
void OpennessGrids::smooth(ThreadPool& pool) {
  const std::size_t stride = std::size_t(stride_), width = std::size_t(width_);
  pool.run(height_, kRows, [&](int begin, int end) {
    std::vector<float> column(
        width + 3);  // sums of four rows, one texel to the left and two to the right of the grid
    for (int y = begin; y < end; ++y) {
      const auto row = [&](int i) {
        return raw_.data() + std::size_t(std::clamp(y + i, 0, height_ - 1)) * stride;
      };
      const float *a = row(-1), *b = row(0), *c = row(1), *d = row(2);
      for (std::size_t x = 0; x < width; ++x) column[x + 1] = (a[x] + b[x]) + (c[x] + d[x]);
      column[0] = column[1];
      column[width + 1] = column[width + 2] = column[width];
      float* out = lamp_seen_.data() + std::size_t(y) * stride;
      for (std::size_t x = 0; x < width; ++x)
        out[x] = ((column[x] + column[x + 1]) + (column[x + 2] + column[x + 3])) * (1.0f / 16);
    }
  });
}

OpennessGrid OpennessGrids::view() const {
  OpennessGrid out;
  out.lamp = lamp_ ? lamp_seen_.data() : nullptr;
  out.width = width_, out.height = height_, out.stride = stride_;
  return out;
}

}  // namespace rubble
