#include "render/media/air_volume.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/media/air_box.h"

namespace rubble {

namespace {

constexpr double kNearGlow = 4;  // from the eye, as far as a lamp near it has a near glow; unit: cell of the grid

// Of light from all around, by what scattering leaves of each order.
Vec3f scattered(const std::array<Vec3f, kOrders>& orders, const std::array<float, kOrders>& left) {
  Vec3f sum;
  for (std::size_t l = 0; l < kOrders; ++l) sum += orders[l] * left[l];
  for (int c = 0; c < 3; ++c) sum[c] = std::max(sum[c], 0.0f);
  return sum;
}

}  // namespace

double AirVolume::slice_distance(int slice) {
  const double u = double(slice) / (kSlices - 1);
  return slice == kSlices - 1 ? kFarthest : std::min(kFarthest, 2 * u / (1 - u));
}

void AirVolume::build(const ViewRays& view, const Air& air, const LitAir& lit, const AirLamp* lamp, bool drops_drawn,
                      std::vector<float> farthest, ThreadPool& pool) {
  drops_drawn_ = drops_drawn, farthest_ = std::move(farthest);
  view_ = &view, air_ = &air, lit_ = &lit, lamp_ = lamp;
  table_.resize(std::size_t(kColumns) * kRows * kSlices);
  near_glow_.reset();
  if (lit.field) {
    const Vec3f& cell = lit.field->grid.cell;
    cell_ = std::min(cell.x, std::min(cell.y, cell.z));
    if (lamp && !lit.field->of_lamp.empty()) near_glow_.emplace(lamp->cone, turned_cosine(air.fog_asymmetry()));
    around_.resize(table_.size() / (kShared * kShared));
    pool.run(kRows / kShared, 1, [&](int begin, int end) {
      for (int row = begin; row < end; ++row)
        for (int column = 0; column < kColumns / kShared; ++column) look_around(column, row);
    });
  }
  pool.run(kRows, 2, [&](int begin, int end) {
    for (int row = begin; row < end; ++row)
      for (int column = 0; column < kColumns; ++column) trace(column, row);
  });
}

// Of the ray through that place of the table, 0.5 in the middle of its first column or row.
Vec3 AirVolume::direction(double column, double row, Vec3& eye) const {
  const Intrinsics& k = view_->intrinsics;
  const double u = column * k.width / kColumns - 0.5, v = row * k.height / kRows - 0.5;
  const int pixel_u = std::clamp(int(u + 0.5), 0, k.width - 1);
  const int pixel_v = std::clamp(int(v + 0.5), 0, k.height - 1);
  const Vec3 seen = view_->directions ? view_->direction(pixel_u, pixel_v)
                                      : normalized(Vec3((u - k.cx) / k.fx, (v - k.cy) / k.fy, 1));
  const Pose world_from_optical = view_->pose(pixel_v);
  eye = world_from_optical.translation;
  return world_from_optical.rotation.rotate(seen);
}

int AirVolume::slices_of(int column, int row) const {
  if (farthest_.empty()) return kSlices;
  const float r = farthest_[std::size_t(row) * kColumns + std::size_t(column)];
  // Between that slice and the next, and as far again for rounding.
  return std::min(kSlices, int(r / (r + 2) * (kSlices - 1)) + 3);
}

void AirVolume::look_around(int column, int row) {
  int slices = 0;  // that a ray reads which is between this one and its neighbours
  for (int y = std::max(0, (row - 1) * kShared); y < std::min(kRows, (row + 2) * kShared); ++y)
    for (int x = std::max(0, (column - 1) * kShared); x < std::min(kColumns, (column + 2) * kShared); ++x)
      slices = std::max(slices, slices_of(x, y));
  Vec3 eye;
  const Vec3 way = direction((column + 0.5) * kShared, (row + 0.5) * kShared, eye);
  Orders* out = &around_[std::size_t(row * (kColumns / kShared) + column)];
  for (int slice = 1; slice < slices; ++slice) {
    out += std::size_t(kColumns / kShared) * (kRows / kShared);
    const Vec3 middle = eye + way * (0.5 * (slice_distance(slice - 1) + slice_distance(slice)));
    *out = {orders_towards(lit_->field->at(Vec3f(middle)), Vec3f(way)),
            orders_towards(lit_->field->of_lamp_at(Vec3f(middle)), Vec3f(way))};
  }
}

// Between the rays that were looked up.
AirVolume::Orders AirVolume::around(int column, int row, int slice) const {
  constexpr int kWide = kColumns / kShared, kHigh = kRows / kShared;
  const auto place = [](int i, int count, int& low) {
    const float at = std::clamp((float(i) + 0.5f) / kShared - 0.5f, 0.0f, float(count - 1));
    low = std::min(int(at), count - 2);
    return at - float(low);
  };
  int x = 0, y = 0;
  const float u = place(column, kWide, x), v = place(row, kHigh, y);
  const Orders* first = &around_[std::size_t((slice * kHigh + y) * kWide + x)];
  const Orders &a = first[0], &b = first[1], &c = first[kWide], &d = first[kWide + 1];
  Orders out;
  const auto mix = [&](std::array<Vec3f, kOrders> Orders::*part) {
    for (std::size_t l = 0; l < kOrders; ++l)
      (out.*part)[l] = ((a.*part)[l] * (1 - u) + (b.*part)[l] * u) * (1 - v) + ((c.*part)[l] * (1 - u) + (d.*part)[l] * u) * v;
  };
  mix(&Orders::all), mix(&Orders::of_lamp);
  return out;
}

void AirVolume::trace(int column, int row) {
  Vec3 eye;
  const Vec3 direction = this->direction(column + 0.5, row + 0.5, eye);
  // Only the puffs that this ray comes near.
  std::vector<const DustPuff*> puffs;
  for (const DustPuff& puff : air_->puffs())
    if (puff.optical_depth(eye, direction, 0, kFarthest) > 1e-5) puffs.push_back(&puff);
  // Outside the box light is scattered once: what is scattered straight on is lost there, too.
  float box_near = 0, box_far = float(kFarthest);
  const bool through = clip_to_box(lit_->box, Vec3f(eye), Vec3f(direction), box_near, box_far);
  Vec3f glow;
  double depth = 0, turned_depth = 0;  // the latter as Air::turned_depth(), but for that
  const std::size_t slice_size = std::size_t(kColumns) * kRows;
  std::array<float, 4>* out = &table_[std::size_t(row) * kColumns + std::size_t(column)];
  *out = {0, 0, 0, 1};
  const int slices = slices_of(column, row);
  for (int slice = 1; slice < slices; ++slice) {
    const double near = slice_distance(slice - 1), far = slice_distance(slice);
    const Vec3 middle = eye + direction * (0.5 * (near + far));
    const double mist = air_->fog_depth(eye + direction * near, direction, far - near);
    double dust = 0;
    for (const DustPuff* puff : puffs) dust += puff->optical_depth(eye, direction, near, far);
    double drops = 0;
    for (const Precipitation& kind : air_->falling())
      drops += (far - near) * (drops_drawn_ ? kind.veil(0.5 * (near + far)) : kind.extinction());
    const double all = mist + dust + drops;
    if (all > 1e-9) {
      const Scatterer scatterer{mist / all, dust / all, drops / all, air_->fog_asymmetry(), air_->dust_asymmetry()};
      const double step = (mist + dust) * air_->billows(middle) + drops;
      const Vec3f p(middle), way(direction);
      const Orders orders = lit_->field ? around(column, row, slice) : Orders();
      Vec3f source = light_glow(*lit_, *air_, scatterer, p, way);
      source += lit_->field ? scattered(orders.all, scatterer.turned()) : even_glow(lit_->baked, lit_->lights, scatterer, p);
      glow += source * float(std::exp(-depth) * (1 - std::exp(-step)) * air_->albedo());
      // The lamp's light goes the same way out and back. Most of what is scattered nearly straight on stays in its
      // beam and in the camera's ray, so both are weakened by what is turned alone; how much is thrown back is by
      // the whole phase function (Nakajima and Tanaka 1988).
      const double at = 0.5 * (near + far);
      const bool inside = through && at > double(box_near) && at < double(box_far);
      const double turned_step = inside ? step * scatterer.turned_share(air_->albedo()) : step;
      const double share = turned_step > 0 ? std::exp(-turned_depth) * (1 - std::exp(-turned_step)) * step / turned_step * air_->albedo() : 0;
      // Next to the lamp its light varies within a slice.
      const int parts = near < 0.5 ? 4 : near < 2 ? 2 : 1;
      for (int i = 0; lamp_ && i < parts; ++i) {
        const double part = (i + 0.5) / parts;
        const Vec3f q(eye + direction * (near + (far - near) * part));
        glow += lamp_glow(*lamp_, scatterer, q, way, turned_depth + part * turned_step) * float(share / parts);
      }
      const std::array<float, kOrders> less = scatterer.turned_less();
      Vec3f again = scattered(orders.of_lamp, less);
      if (near_glow_ && inside && near < kNearGlow * cell_) {
        const std::array<float, kOrders> missing = near_glow_->at(*lamp_, p, way, cell_);
        float sum = 0;
        for (std::size_t l = 0; l < kOrders; ++l) sum += missing[l] * less[l];
        const double scattering = air_->albedo() * double(less[0]) * step / (far - near);
        again += lamp_->colour * float(std::max(sum, 0.0f) * scattering * std::exp(-turned_depth));
      }
      glow += again * float(share);
      depth += step, turned_depth += turned_step;
    }
    out += slice_size;
    *out = {glow.x, glow.y, glow.z, float(std::exp(-depth))};
  }
}

}  // namespace rubble
