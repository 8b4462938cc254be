// Share of the sun's disc that a pixel's surface sees, as the mean over the pixel: the formulas of
// shaders/sun_shadow.frag.glsl, by the same names.
#pragma once

#include "render/shading/texture_reads.h"

namespace rubble::RUBBLE_ISA {

inline constexpr int kSearchTaps = 8;
inline constexpr float kLeastRadius = 0.6f;     // of the comparisons; unit: texel
inline constexpr float kMostFootprint = 16.0f;  // unit: texel

// How the eye sees a pixel's surface.
struct Sight {
  Real3 direction;              // from the eye; unit length
  Real3 across, down;           // from pixel to pixel, by the units of the next
  Real size_across, size_down;  // unit: m
};

// Points spread evenly over the unit disc: a spiral that turns by the golden angle from each to the
// next.
struct DiscPoints {
  float x = 1, y = 0;  // unit length
  RUBBLE_INLINE void turn() {
    const float was = x;
    x = was * -0.7373688f - y * 0.6754903f, y = was * 0.6754903f + y * -0.7373688f;
  }
};

// Number k of points spread evenly over a pixel (Roberts' sequence); -0.5 to 0.5.
RUBBLE_INLINE float pixel_point(int k, float step) {
  const float x = step * float(k + 1);
  return x - float(int(x)) - 0.5f;
}

struct SunView {
  Mask first;        // the finer of two views shows it
  Real u, v, depth;  // place on the map; 0 to 1
  Real3 a, b, c;     // rows of the view
  Real texel;        // its width; unit: m
  Int layer;         // of the map
  Mask known;        // the place is on the map
};

RUBBLE_INLINE SunView view_of(const ShadingData& d, const Real3& p) {
  const FrameBlock& f = d.frame;
  const auto place = [&](int row, Real& u, Real& v, Real& depth) {
    u = times_row(f.shadow_rows[row], p) * 0.5f + 0.5f,
    v = times_row(f.shadow_rows[row + 1], p) * 0.5f + 0.5f;
    depth = times_row(f.shadow_rows[row + 2], p);
  };
  SunView out;
  place(0, out.u, out.v, out.depth);
  out.a = all_lanes(f.shadow_rows[0]), out.b = all_lanes(f.shadow_rows[1]),
  out.c = all_lanes(f.shadow_rows[2]);
  out.texel = real(f.light_position[0][3]), out.layer = integer(0);
  const auto inside = [&](float most) {
    return Mask(out.u >= 0.0f) & Mask(out.u <= most) & Mask(out.v >= 0.0f) & Mask(out.v <= most);
  };
  const Mask first = inside(1.0f);
  if (d.lights[0].views > 1 && any(~first)) {
    Real u, v, depth;
    place(4, u, v, depth);
    out.u = select(first, out.u, u), out.v = select(first, out.v, v),
    out.depth = select(first, out.depth, depth);
    out.a = select(first, out.a, all_lanes(f.shadow_rows[4])),
    out.b = select(first, out.b, all_lanes(f.shadow_rows[5]));
    out.c = select(first, out.c, all_lanes(f.shadow_rows[6]));
    out.texel = select(first, out.texel, real(f.light_axis[0][3])),
    out.layer = select(first, out.layer, integer(1));
  }
  out.known = inside(0.99999f);
  return out;
}

// The least depth of what stands beside an edge about a place of the map; in its lanes 1 where that
// is unknown.
RUBBLE_INLINE Real nearest_edge(const ShadingData& d, const SunView& view) {
  const int tile_side = d.sun_edges.texels_a_tile, across = d.sun_edges.tiles_across;
  const float side = float(d.shadow_side) / float(tile_side);
  const Int x = clamp(to_int(view.u * side), 0, across - 1),
            y = clamp(to_int(view.v * side), 0, across - 1);
  const Int at = y * across + x;  // a word has the least in its lower half
  const auto layer = [&](int i) {
    return gather(reinterpret_cast<const std::uint32_t*>(d.sun_edges.tiles[i]), at);
  };
  Word range = layer(0);
  if (d.sun_edges.tiles[1]) range = Word(select(view.layer == 0, Int(range), Int(layer(1))));
  return to_real(Int(range & 65535u)) * (1.0f / 65535);
}

struct SunShare {
  Real share;   // of the disc that is seen
  Mask partly;  // elsewhere one comparison says all
};

// wanted: lanes that may see an edge. fallback: of the edges that a lane's block meets.
inline SunShare sun_share(const ShadingData& d, Mask wanted, Real fallback, const Real3& p,
                          const Real3& normal, const Sight& sight) {
  const SunView view = view_of(d, p);
  const Real depth_of_metre = length(view.c);
  Real facing = -dot(normal, view.c) / depth_of_metre;
  wanted &= view.known & Mask(facing > 0.0f);
  facing = max(facing, 0.08f);
  const Real edge = nearest_edge(d, view), nearest = select(edge < 1.0f, edge, fallback);
  // How depth grows over the surface, and what it may be off by: half a texel of that and
  // roughness.
  const Real grows = 2.0f * depth_of_metre / facing;
  const Real slope_u = dot(normal, view.a) / dot(view.a, view.a) * grows,
             slope_v = dot(normal, view.b) / dot(view.b, view.b) * grows;
  const Real compared = view.depth - view.texel * 1.6f / facing * depth_of_metre;
  // From pixel to pixel on the surface, and on the map.
  const Real3 slant = sight.direction * (1.0f / min(dot(normal, sight.direction), -0.05f));
  const Real3 across = (sight.across - slant * dot(normal, sight.across)) * sight.size_across;
  const Real3 down = (sight.down - slant * dot(normal, sight.down)) * sight.size_down;
  Real xu = dot(view.a, across) * 0.5f, xv = dot(view.b, across) * 0.5f;
  Real yu = dot(view.a, down) * 0.5f, yv = dot(view.b, down) * 0.5f;
  const float side = float(d.shadow_side);
  const Real wide = (sqrt(xu * xu + xv * xv) + sqrt(yu * yu + yv * yv)) * (0.5f * side);
  const Real shrink = min(kMostFootprint / max(wide, 1e-6f), 1.0f);
  xu *= shrink, xv *= shrink, yu *= shrink, yv *= shrink;

  // How high what hides the sun is above the surface.
  const Real metre_u = length(view.a) * 0.5f, metre_v = length(view.b) * 0.5f;
  const float radius = d.sun_edges.sun_radius;
  const Real search = radius * max(view.depth - nearest, 0.0f) / depth_of_metre + view.texel * 1.5f;
  const Real whole = compare_shadow(d, view.u, view.v, view.layer, min(compared, 1.0f));
  Real sum = real(0), found = real(0);
  const Int layer_start = view.layer * (d.shadow_side * d.shadow_side);
  DiscPoints disc;
  for (int k = 0; k < kSearchTaps; ++k) {
    disc.turn();
    const float px = pixel_point(k, 0.7548777f), py = pixel_point(k, 0.5698403f);
    const float reach = std::sqrt((float(k) + 0.5f) * (1.0f / float(kSearchTaps)));
    const Real aside = metre_u * search * (disc.x * reach);
    const Real off_u = xu * px + yu * py + aside,
               off_v = xv * px + yv * py + metre_v * search * (disc.y * reach);
    const Int tu = to_int(clamp(view.u + off_u, 0.0f, 0.99999f) * side),
              tv = to_int(clamp(view.v + off_v, 0.0f, 0.99999f) * side);
    const Real stored = gather(d.shadow_map, layer_start + tv * d.shadow_side + tu);
    const Real height = (compared + slope_u * off_u + slope_v * off_v - stored) / depth_of_metre;
    // Beyond the disc's image at its own height it hides nothing.
    const Mask hides =
        Mask(height > 0.0f) & Mask(abs(aside) < metre_u * (radius * height + view.texel * 1.5f));
    sum += select(hides, height, real(0)), found += select(hides, real(1), real(0));
  }
  const Mask partly = wanted & (Mask(found > 0.0f) | Mask(whole < 1.0f)) &
                      (Mask(found < float(kSearchTaps)) | Mask(whole > 0.0f));
  SunShare out{real(0), partly};
  if (!any(partly)) return out;
  const Real blur = max(radius * sum / max(found, 1.0f), kLeastRadius * view.texel);
  const Mask many = blur > 6.0f * view.texel, some = blur + view.texel * wide > 1.5f * view.texel;
  const Real count =
      select(partly, select(many, real(32), select(some, real(16), real(8))), real(0));
  const Real inverse = 1.0f / max(count, 1.0f), reach_u = metre_u * blur, reach_v = metre_v * blur;
  Real lit = real(0);
  DiscPoints points;
  for (int k = 0; k < 32; ++k) {
    const Mask here = float(k) < count;
    if (!any(here)) break;
    points.turn();
    const float px = pixel_point(k, 0.7548777f), py = pixel_point(k, 0.5698403f);
    const Real spread = sqrt((float(k) + 0.5f) * inverse);
    const Real off_u = xu * px + yu * py + reach_u * spread * points.x;
    const Real off_v = xv * px + yv * py + reach_v * spread * points.y;
    const Real seen = compare_shadow(d, view.u + off_u, view.v + off_v, view.layer,
                                     min(compared + slope_u * off_u + slope_v * off_v, 1.0f));
    lit += select(here, seen, real(0));
  }
  out.share = lit * inverse;
  return out;
}

}  // namespace rubble::RUBBLE_ISA
