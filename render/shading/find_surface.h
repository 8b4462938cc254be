// What a pixel's surface is: normal, layers and baked light, from the triangle it lies on. shaders/surface_model.glsl has
// the formulas of how it looks; the rest is that of shaders/surface.glsl and shaders/geometry.glsl, by the same names.
#pragma once

#include "render/shading/paint.h"
#include "render/shading/texture_reads.h"

namespace rubble::RUBBLE_ISA {

struct Surface {
  Real3 normal, face_normal;  // world; with and without relief
  Real3 ambient;              // klx
  SurfaceLayers layers;
};

// What a placed mesh is, and the point in its frame.
struct PlacedPoint {
  Real3 rows[3];                  // of mesh_from_world, without the origin
  Real scale;                     // of the mesh
  Word first_light, seed, turns;  // the second and last as PlacedMesh::look_seed
  Real3 point;                    // in the mesh frame

  RUBBLE_INLINE Real3 to_world(const Real3& v) const {
    return (rows[0] * v.x + rows[1] * v.y + rows[2] * v.z) * scale;
  }
};

struct TrianglePoint {
  Row entry;              // of the table of triangles
  Real3 weights, ab, ac;  // of the corners; edges
  Real3 face, smooth;     // normals in the mesh, unit length
};

RUBBLE_INLINE PlacedPoint find_placed(const ShadingData& d, Word placed, const Real3& world) {
  PlacedPoint out;
  const Int at = Int(placed) * 4;
  const auto row = [&](int i, Real& along) {
    const Row r = load_rows(d.placed, at + i);
    out.rows[i] = {as_real(r.x), as_real(r.y), as_real(r.z)};
    along = dot(out.rows[i], world) + as_real(r.w);
  };
  row(0, out.point.x), row(1, out.point.y), row(2, out.point.z);
  const Row more = load_rows(d.placed, at + 3);
  out.scale = as_real(more.x), out.first_light = more.y, out.seed = more.z, out.turns = more.w;
  return out;
}

RUBBLE_INLINE Real3 unpack_normal(Word code) {
  const Real x = to_real(Int(code << 16) >> 16) * (1.0f / 32767),
             y = to_real(Int(code) >> 16) * (1.0f / 32767);
  const Real z = 1.0f - abs(x) - abs(y), t = max(-z, 0.0f);
  return {select(x >= 0.0f, x - t, x + t), select(y >= 0.0f, y - t, y + t), z};
}

RUBBLE_INLINE TrianglePoint find_triangle(const ShadingData& d, Word triangle, const Real3& p) {
  TrianglePoint out;
  out.entry = load_rows(d.triangles, Int(triangle));
  const Row c0 = load_rows(d.vertices, Int(out.entry.x)),
            c1 = load_rows(d.vertices, Int(out.entry.y)),
            c2 = load_rows(d.vertices, Int(out.entry.z));
  const auto place = [](const Row& c) { return Real3{as_real(c.x), as_real(c.y), as_real(c.z)}; };
  const Real3 a = place(c0), ap = p - a;
  out.ab = place(c1) - a, out.ac = place(c2) - a;
  const Real3 area = cross(out.ab, out.ac);
  const Real area2 = max(dot(area, area), 1e-30f), inverse = 1.0f / area2;
  const Real w1 = clamp(dot(cross(ap, out.ac), area) * inverse, 0.0f, 1.0f);
  const Real w2 = min(max(dot(cross(out.ab, ap), area) * inverse, 0.0f), 1.0f - w1);
  out.weights = {1.0f - w1 - w2, w1, w2};
  out.face = area * inverse_sqrt(area2);
  out.smooth = normalize(unpack_normal(c0.w) * out.weights.x + unpack_normal(c1.w) * w1 +
                         unpack_normal(c2.w) * w2 + out.face * real(0.001f));
  return out;
}

// By halves as IEEE 754 has them; neither infinite nor below the least normal one.
RUBBLE_INLINE Real unpack_half(Word half) {
  const Word magnitude = (half & 0x7fffu) << 13, sign = (half & 0x8000u) << 16;
  // Moves the exponent by multiplying, which is right for those below the least normal one, too.
  return Real(Word(Real(magnitude) * 5.192296858534828e33f) | sign);  // 2^112
}

struct NodeLight {
  Real3 vector;    // dot(normal, vector) is the illuminance; unit: klx
  Real red, blue;  // shares of the light; red, green and blue add up to 1
};

RUBBLE_INLINE NodeLight load_light(const ShadingData& d, Int node) {
  const auto* words = static_cast<const std::uint32_t*>(d.light);
  const Word first = gather(words, node * 2), second = gather(words, node * 2 + 1);
  return {{unpack_half(first & 0xffffu), unpack_half(first >> 16), unpack_half(second & 0xffffu)},
          byte_of(second, 16) * (1.0f / 255),
          byte_of(second, 24) * (1.0f / 255)};
}

// The last 11 bits of a triangle's word: its look + 45 (turns of its corners + 3 (steps between
// nodes - 1)).
RUBBLE_INLINE NodeLight find_light(const ShadingData& d, const TrianglePoint& t, Word first_light) {
  const Int code = Int(t.entry.w & 2047u);
  const Int steps = to_int((to_real(code) + 0.5f) * (1.0f / 45)),
            per_turn = to_int((to_real(steps) + 0.5f) * (1.0f / 3));
  const Int turns = steps - per_turn * 3, n = per_turn + 1, first = Int(t.entry.w >> 11);
  const Real3& w = t.weights;
  const Mask once = turns == 1, twice = turns == 2;
  const Real count = to_real(n);
  const Real x = select(once, w.x, select(twice, w.z, w.y)) * count;
  const Real y = select(once, w.y, select(twice, w.x, w.z)) * count;
  const Int i = min(to_int(x), n - 1), j = min(to_int(y), n - 1 - i);
  const Real fx = x - to_real(i), fy = y - to_real(j);
  const Mask upper = Mask(fx + fy > 1.0f) & Mask(i + j + 2 <= n), fine = n > 1;
  const Int row = first + ((j * (2 * n + 3 - j)) >> 1) + i, above = row + n + 1 - j;
  const auto node = [&](Int grid, Word corner) {
    return load_light(d, select(fine, grid, Int(corner)) + Int(first_light));
  };
  const NodeLight a = node(select(upper, above + 1, row), t.entry.x),
                  b = node(select(upper, above, row + 1), t.entry.y),
                  c = node(select(upper, row + 1, above), t.entry.z);
  const Real wa = select(fine, select(upper, fx + fy - 1.0f, 1.0f - fx - fy), w.x);
  const Real wb = select(fine, select(upper, 1.0f - fx, fx), w.y);
  const Real wc = select(fine, select(upper, 1.0f - fy, fy), w.z);
  return {a.vector * wa + b.vector * wb + c.vector * wc, a.red * wa + b.red * wb + c.red * wc,
          a.blue * wa + b.blue * wb + c.blue * wc};
}

// From and to axes in which the longest of the mesh comes first.
RUBBLE_INLINE Real3 turned(const Real3& v, Mask once, Mask twice) {
  return {select(once, v.y, select(twice, v.z, v.x)), select(once, v.z, select(twice, v.x, v.y)),
          select(once, v.x, select(twice, v.y, v.z))};
}
RUBBLE_INLINE Real3 turned_back(const Real3& v, Mask once, Mask twice) {
  return turned(v, twice, once);
}

struct Look {
  Real3 dark, bright, accent;           // albedos
  Real density;                         // 1 / tile
  Real bump;                            // below 0: it shines
  Real gloss;                           // packed
  Real layer, dust, variation, texels;  // the last: log2 of texels a metre
};

RUBBLE_INLINE Look load_look(const ShadingData& d, Int look) {
  const auto row = [&](int i) { return load_rows(d.frame.looks, look * 4 + i); };
  const auto colour = [](const Row& r) { return Real3{as_real(r.x), as_real(r.y), as_real(r.z)}; };
  const Row dark = row(0), bright = row(1), accent = row(2), more = row(3);
  return {colour(dark),      colour(bright),  colour(accent),  as_real(dark.w), as_real(bright.w),
          as_real(accent.w), as_real(more.x), as_real(more.y), as_real(more.z), as_real(more.w)};
}

// What a texture shows there.
struct Pattern {
  Texel texel;          // slopes, brightness, mask
  Real3 bent;           // normal with relief, in the mesh
  SurfaceDetail detail;
  Real grazing;         // cosine at which the face is seen
};

RUBBLE_INLINE Pattern find_pattern(const ShadingData& d, const PlacedPoint& placed,
                                   const TrianglePoint& t, const Look& look,
                                   const Real3& face_normal, const Real3& world,
                                   const Real3& direction, Real z) {
  Pattern out;
  const Mask once = Mask((placed.turns & 3u) == 1u), twice = Mask((placed.turns & 3u) == 2u);
  Real3 q = turned(placed.point, once, twice) * placed.scale;
  Real seed_u = to_real(Int(placed.seed & 0xffffu)), seed_v = to_real(Int(placed.seed >> 16));
  const Mask cut = Mask((placed.turns & 4u) != 0u);  // from a body, whose textures run on
  if (any(cut)) {
    const Real3 o{seed_u * (1.0f / 1024) - 32.0f, seed_v * (1.0f / 1024) - 32.0f,
                  to_real(Int((placed.turns >> 3) & 0x1fffu)) * (1.0f / 256) - 2.0f};
    q = select(cut, q + turned(o, once, twice), q);
    seed_u = select(cut, real(0), seed_u), seed_v = select(cut, real(0), seed_v);
  }
  const TextureAxes axes = find_texture_axes(q, turned(t.smooth, once, twice));
  Real u = dot(q, axes.along) * look.density + seed_u * (1.0f / 65536);
  const Real v = dot(q, axes.across) * look.density + seed_v * (1.0f / 65536);
  // Slow variation over metres.
  const auto& ground = d.frame.ground;
  const Real2 map = read_ground(d, map_place(world.x, world.z, ground[0], ground[2]),
                                map_place(world.y, world.z, ground[1], ground[2]));
  SurfaceDetail& detail = out.detail;
  detail.debris = map.x, detail.slow = 4.0f * map.y - 2.0f;
  u += select(look.layer < 0.5f, wall_shift(v), real(0));
  out.grazing = max(-dot(face_normal, direction), 0.05f);
  const Real level =
      max(look.texels + log2(z * d.frame.lens[0]) - 0.5f * log2(out.grazing) - 0.25f, 0.0f);
  const Int layer = to_int(look.layer);
  out.texel = read_image(d.looks, layer, u, v, level);
  const Mask mixed = Mask(look.dust < 0.2f) & Mask(detail.slow > -0.6f);
  if (any(mixed)) {
    Texel other = read_image(d.looks, layer, v * 0.83f + 0.37f, u * 0.83f + 0.37f, level);
    const Real swapped = other.x;
    other.x = other.y, other.y = swapped;
    const Real share = other_part(detail.slow, out.texel.z, other.z);
    out.texel = mix(out.texel, other, select(mixed, share, real(0)));
  }
  detail.bright = detail.raised = out.texel.z, detail.mask = out.texel.w;
  detail.soil = look.layer == d.soil;
  if (d.wet && d.surrounded) {
    // Along a street the eye sees a texture repeat: only what is finer than an eighth of it stands
    // out of the water.
    const float coarse = float(d.looks.levels - 1) - 3;
    detail.raised += 0.5f - read_image(d.looks, layer, u, v, max(level, coarse)).z;
  }
  const Real bump = max(look.bump, 0.0f);
  const Real sx = (out.texel.x * 4.0f - 2.0f) * bump, sy = (out.texel.y * 4.0f - 2.0f) * bump;
  out.bent =
      t.smooth - turned_back(axes.along, once, twice) * sx - turned_back(axes.across, once, twice) * sy;
  return out;
}

RUBBLE_INLINE LookColours colours_of(const Look& look) {
  const Real whole = floor(look.gloss);
  return {look.dark, look.bright, look.accent, look.dust, look.variation, whole * (1.0f / 255),
          max((look.gloss - whole) * (1.0f / 0.99f), 0.02f), max(-look.bump, 0.0f)};
}

RUBBLE_INLINE SurfaceLayers select(Mask m, const SurfaceLayers& a, const SurfaceLayers& b) {
  return {select(m, a.albedo, b.albedo), select(m, a.cover, b.cover), select(m, a.reflectance, b.reflectance),
          select(m, a.roughness, b.roughness), select(m, a.film, b.film), select(m, a.glow, b.glow),
          select(m, a.clear, b.clear)};
}

RUBBLE_INLINE Surface find_surface(const ShadingData& d, Word placed_id, Word triangle,
                                   const Real3& world, const Real3& direction, Real z) {
  Surface s;
  const PlacedPoint placed = find_placed(d, placed_id, world);
  const TrianglePoint t = find_triangle(d, triangle, placed.point);
  const NodeLight light = find_light(d, t, placed.first_light);
  const Int code = Int(t.entry.w & 2047u);
  const Int look_number = code - to_int((to_real(code) + 0.5f) * (1.0f / 45)) * 45;
  const Look look = load_look(d, look_number);
  s.face_normal = placed.to_world(t.face);
  Pattern p = find_pattern(d, placed, t, look, s.face_normal, world, direction, z);
  s.normal = normalize(placed.to_world(p.bent));
  const Real3 smooth = placed.to_world(t.smooth);
  p.detail.up = smooth.z;
  const auto varied = [&](int shift) { return byte_of(placed.turns, shift) * (2.0f / 255) - 1.0f; };
  SurfaceLayers& layers = s.layers;
  layers = find_layers(colours_of(look), p.detail, varied(16), varied(24));
  if (d.paint_count > 0) {
    const Mask painted = look_number == d.painted_look;
    if (any(painted)) {
      const Real across = z * d.frame.lens[0] * inverse_sqrt(p.grazing) * 0.84f / placed.scale;
      const Paint paint = find_paint(d, Int(triangle), t.weights, t.ab, t.ac, t.smooth, across);
      layers = select(painted,
                      paint_over(layers, paint.albedo, paint.roughness, paint.metalness, paint.reflectance), layers);
      s.normal = select(painted, normalize(placed.to_world(paint.normal)), s.normal);
    }
  }
  const Mask glass = look_number == d.glass_look;
  if (d.glass_look >= 0 && any(glass))
    layers = select(glass, make_glass(layers, -dot(s.face_normal, direction), p.detail.bright), layers);
  if (d.wet) {
    const WetSurface wet = add_water(layers, p.detail, d.frame.wetness[0]);
    layers = wet.layers;
    s.normal = normalize(mix(s.normal, smooth, wet.even));
  }
  const Real lit = max(dot(light.vector, s.normal), 0.15f * length(light.vector));
  s.ambient = Real3{light.red, 1.0f - light.red - light.blue, light.blue} * (3.0f * lit);
  return s;
}

}  // namespace rubble::RUBBLE_ISA
