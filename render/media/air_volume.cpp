#include "render/media/air_volume.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "render/lighting/light_packing.h"

namespace rubble {

namespace {

static_assert(AirVolume::kSlices <= AirBlock::kMostSlices);
static_assert(AirVolume::kColumns % 4 == 0 && AirVolume::kRows % 4 == 0);

constexpr float kNearGlow = 4;  // from the eye, as far as a lamp near it has a near glow; unit: cell of the grid

void set(float (&out)[4], const Vec3f& v) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }

// Four numbers for each three.
std::vector<float> padded(const std::vector<Vec3f>& values) {
  std::vector<float> out;
  out.reserve(values.size() * 4);
  for (const Vec3f& v : values) out.insert(out.end(), {v.x, v.y, v.z, 0.0f});
  return out;
}

void fill_medium(const Air& air, AirBlock& out) {
  out.fog_density = float(air.fog_density()), out.albedo = float(air.albedo());
  out.fog_rate = air.fog_height() > 0 ? float(1 / air.fog_height()) : 0;
  out.fog_g = float(air.fog_asymmetry()), out.dust_g = float(air.dust_asymmetry());
  out.drops_g = float(Precipitation::kAsymmetry);
  const Air::Billows billows = air.billow_noise();
  out.billows = float(billows.strength), out.billow_scale = float(1 / billows.size);
  set(out.drift, Vec3f(billows.drift));
  out.noise_side = Medium::kNoiseSide;
  out.beam_fog = float(air.turned_share(air.fog_asymmetry()));
  out.beam_drops = float(air.drops() * air.turned_share(Precipitation::kAsymmetry));
}

// Optical depth of what falls, from each entry of the table to the next.
void fill_drops(const Air& air, bool drops_drawn, AirBlock& out) {
  for (int slice = 0; slice < AirVolume::kSlices; ++slice) {
    const double far = AirVolume::slice_distance(slice);
    out.distance[slice] = float(far);
    if (slice == 0) continue;
    const double near = AirVolume::slice_distance(slice - 1);
    double sum = 0;
    for (const Precipitation& kind : air.falling())
      sum += (far - near) * (drops_drawn ? kind.veil(0.5 * (near + far)) : kind.extinction());
    out.drops[slice] = float(sum);
  }
}

void fill_lights(const LitAir& lit, AirBlock& out) {
  const AirLight& baked = lit.baked;
  set(out.origin, baked.origin), set(out.cell, baked.cell);
  const bool grid = baked.radiance.size() > 1;
  for (std::size_t i = 0; i < 3; ++i) out.size[i] = grid ? baked.size[i] : 1;
  out.light_count = int(lit.lights.lights.size());
  for (std::size_t i = 0; i < lit.lights.lights.size(); ++i) {
    const LightModel& from = lit.lights.lights[i];
    AirBlock::Light& to = out.lights[i];
    to.type = int(from.type);
    set(to.position, from.position), set(to.axis, from.axis), set(to.colour, from.colour);
    to.cos_outer = from.cos_outer, to.cone_width = 1 / std::max(from.cos_inner - from.cos_outer, 1e-6f);
    if (from.type != LightType::directional) out.local = 1;
  }
  set(out.open, lit.lights.sky.mean * (0.5f * (1 + kGroundReflectance)));
  const Vec3f size = (baked.nearest({1e9f, 1e9f, 1e9f}) - baked.origin) * 0.5f;
  out.half_size = std::max(norm(size), 1e-6f);
  set(out.box_low, Vec3f(lit.box.min)), set(out.box_high, Vec3f(lit.box.max));
}

void fill_lamp(const AirLamp& lamp, AirBlock& out) {
  out.lamp = 1;
  set(out.lamp_position, lamp.position), set(out.lamp_axis, lamp.axis), set(out.lamp_colour, lamp.colour);
  out.lamp_cone = lamp.cone, out.lamp_size2 = lamp.size2;
}

}  // namespace

double AirVolume::slice_distance(int slice) {
  const double u = double(slice) / (kSlices - 1);
  return slice == kSlices - 1 ? kFarthest : std::min(kFarthest, 2 * u / (1 - u));
}

void AirVolume::prepare(const ViewRays& view, const Air& air, const LitAir& lit, const AirLamp* lamp, bool drops_drawn,
                        const std::vector<float>& farthest) {
  view_ = &view, field_ = lit.field, found_ = false;
  static std::atomic<std::uint64_t> versions{0};
  version_ = ++versions;
  find_wanted(farthest);
  AirTraceData data;
  data.columns = kColumns, data.rows = kRows, data.slices = kSlices;
  data.wanted = wanted_.data(), data.noise = air.billow_noise().noise;
  data.has_lens = view.directions ? 1 : 0;
  fill_medium(air, data);
  fill_drops(air, drops_drawn, data);
  fill_lights(lit, data);
  if (lamp) fill_lamp(*lamp, data);
  puffs_.clear();
  for (const DustPuff& puff : air.puffs()) {
    const Vec3f c(puff.centre);
    puffs_.push_back({{c.x, c.y, c.z, float(puff.deviation)}, float(puff.extinction)});
  }
  data.puffs = puffs_.data(), data.puff_count = int(puffs_.size());
  if (baked_radiance_.empty()) baked_radiance_ = padded(lit.baked.radiance), baked_direct_ = padded(lit.baked.direct);
  data.radiance = baked_radiance_.data(), data.direct = baked_direct_.data();
  data.has_direct = baked_direct_.empty() ? 0 : 1;
  if (lit.field) {
    data.has_around = 1, data.rays_an_entry = kShared;
    data.around_columns = kColumns / kShared, data.around_rows = kRows / kShared;
    if (lamp && (lit.lamp_on_device || !lit.field->of_lamp.empty())) {
      const Vec3f& cell = lit.field->grid.cell;
      data.near_glow = near_glow(lamp->cone, turned_cosine(air.fog_asymmetry())).table().front().data();
      data.has_near_glow = 1, data.near_glow_steps = int(NearGlow::kAngles);
      data.near_glow_cell = std::min(cell.x, std::min(cell.y, cell.z));
      data.near_glow_reach = kNearGlow * data.near_glow_cell;
    }
  }
  data_ = data;
}

const std::vector<std::array<float, 4>>& AirVolume::table(const WideShader& shader, ThreadPool& pool) {
  if (found_) return table_;
  found_ = true;
  table_.resize(std::size_t(kColumns) * kRows * kSlices);
  find_rays(*view_);
  data_.rays = rays_.data(), data_.table = table_.front().data();
  if (field_) look_around(pool), data_.around = around_.front().data();
  pool.run(kRows / 4, 1, [&](int begin, int end) { shader.trace_air(data_, begin, end); });
  return table_;
}

const NearGlow& AirVolume::near_glow(float cone, double cosine) {
  if (!near_glow_ || near_glow_cone_ != cone || near_glow_cosine_ != cosine) near_glow_.emplace(cone, cosine);
  near_glow_cone_ = cone, near_glow_cosine_ = cosine;
  return *near_glow_;
}

// Of the ray through that place of the table, 0.5 in the middle of its first column or row.
Vec3 AirVolume::direction(const ViewRays& view, double column, double row, Vec3& eye) {
  const Intrinsics& k = view.intrinsics;
  const double u = column * k.width / kColumns - 0.5, v = row * k.height / kRows - 0.5;
  const int pixel_u = std::clamp(int(u + 0.5), 0, k.width - 1);
  const int pixel_v = std::clamp(int(v + 0.5), 0, k.height - 1);
  const Vec3 seen = view.directions ? view.direction(pixel_u, pixel_v)
                                    : normalized(Vec3((u - k.cx) / k.fx, (v - k.cy) / k.fy, 1));
  const Pose world_from_optical = view.pose(pixel_v);
  eye = world_from_optical.translation;
  return world_from_optical.rotation.rotate(seen);
}

void AirVolume::find_rays(const ViewRays& view) {
  constexpr std::size_t kRays = std::size_t(kColumns) * kRows;
  rays_.resize(6 * kRays);
  for (std::size_t i = 0; i < kRays; ++i) {
    Vec3 eye;
    const Vec3f way(direction(view, double(i % kColumns) + 0.5, double(i / kColumns) + 0.5, eye)), from(eye);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      rays_[axis * kRays + i] = from[int(axis)];
      rays_[(axis + 3) * kRays + i] = way[int(axis)];
    }
  }
}

void AirVolume::find_wanted(const std::vector<float>& farthest) {
  wanted_.assign(std::size_t(kColumns) * kRows, kSlices);
  for (std::size_t i = 0; i < farthest.size(); ++i) {
    const float r = farthest[i];
    // Between that slice and the next, and as far again for rounding.
    wanted_[i] = std::min(kSlices, int(r / (r + 2) * (kSlices - 1)) + 3);
  }
}

void AirVolume::look_around(ThreadPool& pool) {
  constexpr int kWide = kColumns / kShared, kHigh = kRows / kShared;
  around_.resize(std::size_t(kWide) * kHigh * kSlices);
  pool.run(kHigh, 1, [&](int begin, int end) {
    for (int row = begin; row < end; ++row)
      for (int column = 0; column < kWide; ++column) look_around_ray(column, row);
  });
}

void AirVolume::look_around_ray(int column, int row) {
  int slices = 0;  // that a ray reads which is between this one and its neighbours
  for (int y = std::max(0, (row - 1) * kShared); y < std::min(kRows, (row + 2) * kShared); ++y)
    for (int x = std::max(0, (column - 1) * kShared); x < std::min(kColumns, (column + 2) * kShared); ++x)
      slices = std::max(slices, wanted_[std::size_t(y) * kColumns + std::size_t(x)]);
  // A ray in the middle of those that share it.
  const std::size_t ray = std::size_t(row * kShared + kShared / 2) * kColumns + std::size_t(column * kShared + kShared / 2);
  const auto part = [&](std::size_t i) { return rays_[i * std::size_t(kColumns) * kRows + ray]; };
  const Vec3f eye(part(0), part(1), part(2)), way(part(3), part(4), part(5));
  Orders* out = &around_[std::size_t(row * (kColumns / kShared) + column)];
  for (int slice = 1; slice < slices; ++slice) {
    out += std::size_t(kColumns / kShared) * (kRows / kShared);
    const Vec3f middle = eye + way * float(0.5 * (slice_distance(slice - 1) + slice_distance(slice)));
    const auto put = [&](const RadianceTerms& terms, std::size_t first) {
      const std::array<Vec3f, kOrders> orders = orders_towards(terms, way);
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t l = 0; l < kOrders; ++l) (*out)[(first + c) * kOrders + l] = orders[l][int(c)];
    };
    put(field_->at(middle), 0), put(field_->of_lamp_at(middle), 3);
  }
}

}  // namespace rubble
