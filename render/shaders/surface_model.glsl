// How a surface looks: what every renderer makes of a texture, a look, dust, paint, glass and water. Written once, in
// the words that C++ and GLSL share. surface_words.glsl compiles it as GLSL, shading/wide_math.h for lanes of pixels, and
// surface/scalar_surface.h for one point. Each of them defines these words before:
//   FN                 stands before a function
//   Real, Real3, Mask  a number, three of them, and a truth; of a pixel, or of each lane of pixels
//   real(x), real3(x, y, z)
//   select(m, a, b)    a where m is true, else b
//   both(m, n)         where both are true
//   and, as in GLSL: abs, sqrt, floor, fract, min, max, clamp, exp2, log2, pow, mix, smoothstep, dot, cross, normalize,
//   length; inverse_sqrt
// Numbers in the code end with an f. Only the first argument of min, max and clamp may be other than a plain number.

const float kWaterReflectance = 0.02f;  // of refractive index 1.33
const float kFilmRoughness = 0.12f;     // of water on grit, our choice

FN Real grey_of(Real3 c) { return c.x * 0.2126f + c.y * 0.7152f + c.z * 0.0722f; }

// ---- Where a texture lies on a mesh. Places are in the mesh, in axes of which the longest comes first; unit: m.

FN Real zigzag(Real x) { return abs(fract(x) - 0.5f); }
// Breaks the line where the plane of a texture changes, by waves of 40 to 7 mm. It is even, for grains of one value
// each would show as blocks from near to, and finer waves as a comb.
FN Real ragged(Real x, Real y) {
  return 0.14f * zigzag(x * 23.0f + y * 11.0f) + 0.09f * zigzag(y * 61.0f - x * 29.0f) +
         0.03f * zigzag(x * 127.0f + y * 71.0f) - 0.065f;
}

struct TextureAxes {
  Real3 along, across;  // unit length
};

// On the one of 26 planes that the surface is nearest to: little stretching, one texture. place: in the mesh; normal:
// with rounding.
FN TextureAxes find_texture_axes(Real3 place, Real3 normal) {
  Real3 bent = normal + real3(ragged(place.x, place.y), ragged(place.y, place.z), ragged(place.z, place.x));
  Real3 plane = normalize(real3(floor(bent.x * 1.2f + 0.5f), floor(bent.y * 1.2f + 0.5f), floor(bent.z * 1.2f + 0.5f)));
  Mask level = abs(plane.z) > 0.9f;
  Real inverse = inverse_sqrt(max(plane.x * plane.x + plane.y * plane.y, 1e-12f));
  TextureAxes axes;
  axes.along = real3(select(level, real(1.0f), -plane.y * inverse), select(level, real(0.0f), plane.x * inverse), real(0.0f));
  axes.across = cross(plane, axes.along);
  return axes;
}

// A wall shows another part of its texture every 1.7 m or so, at the boards' joints.
FN Real wall_shift(Real v) { return floor(v) * 0.37f + floor(v * 0.5f) * 0.21f; }

// From 0 to 1 on the map of the ground. along: world X or Y; middle, per_reach: of the map.
FN Real map_place(Real along, Real height, float middle, float per_reach) {
  Real a = (along + 0.6f * height - middle) * per_reach;
  return 0.5f + 0.5f * a / (1.0f + abs(a));
}

// Where the slow variation is high the ground shows another part of its texture, so that no repetition meets the eye:
// the share of that part. Between them shows what lies higher of both. bright, other: of the two parts.
FN Real other_part(Real slow, Real bright, Real other) {
  return smoothstep(-0.15f, 0.15f, slow - 0.15f + 0.6f * (other - bright));
}

// ---- What lies on the surface.

struct LookColours {
  Real3 dark, bright, accent;   // albedos
  Real dust, variation;         // as of SurfaceAppearance
  Real reflectance, roughness;  // likewise
  Real glow;                    // luminance; unit: kcd/m2
};

struct SurfaceDetail {
  Real bright, mask;  // of the texture
  Real raised;        // out of water: bright, in a street against the mean about it
  Real slow, debris;  // of the map of the ground: tone from -2 to 2, cover
  Real up;            // Z of the normal with rounding, in the world
  Mask soil;          // it is the ground
};

struct SurfaceLayers {
  Real3 albedo;                        // of the matt base
  Real cover, reflectance, roughness;  // of the mirror on top
  Real film;                           // share covered by water
  Real3 glow;                          // unit: kcd/m2
  Real3 clear;                         // share of light that goes straight through
};

FN Real3 dust_colour(Real grey) { return real3(grey * 0.375f, grey * 0.36f, grey * 0.335f); }
FN Real dust_grey(Real bright) { return 0.55f + 0.75f * bright; }

// tint, warm: how a piece differs, -1 to 1.
FN SurfaceLayers find_layers(LookColours look, SurfaceDetail p, Real tint, Real warm) {
  SurfaceLayers s;
  // On the ground the mask ranks crumbs: the more debris, the more of them lie there, and dust.
  Real crumbs = smoothstep(0.0f, 0.12f, p.mask - 1.0f + 0.05f + 0.75f * p.debris);
  Real3 accent = look.accent * select(p.soil, 0.55f + 0.7f * p.bright, real(1.0f));
  s.albedo = mix(mix(look.dark, look.bright, p.bright), accent, select(p.soil, crumbs, p.mask));
  s.albedo = s.albedo * (1.0f + select(p.soil, real(0.3f), real(0.16f)) * p.slow);
  Real light = 1.0f + tint * look.variation, red = warm * look.variation * 0.25f;
  s.albedo = s.albedo * real3(light * (1.0f + red), light, light * (1.0f - red));
  s.glow = s.albedo * (look.glow / max(grey_of(look.bright), 1e-3f));
  // Dust settles on what faces up, unevenly, and lets pits and cracks show.
  Real dust = smoothstep(0.30f, 1.05f, p.up + (p.bright - 0.45f) * 0.8f) * select(p.soil, 0.85f * p.debris, look.dust);
  s.albedo = mix(s.albedo, dust_colour(dust_grey(p.bright)), dust);
  s.cover = 1.0f - dust, s.reflectance = look.reflectance, s.roughness = look.roughness;
  s.film = real(0.0f);
  s.clear = real3(real(0.0f), real(0.0f), real(0.0f));
  return s;
}

// Water darkens what it soaks into, and stands as a film on what faces up. even: how even it makes the surface.
struct WetSurface {
  SurfaceLayers layers;
  Real even;
};
FN WetSurface add_water(SurfaceLayers s, SurfaceDetail p, float wetness) {
  Real wet = wetness * smoothstep(-0.6f, 0.5f, p.up + 0.5f * p.slow);
  Real even = smoothstep(0.75f, 0.25f, p.raised);
  WetSurface out_;
  s.albedo = s.albedo * (1.0f - 0.5f * wet);
  s.film = wet * (0.35f + 0.65f * smoothstep(0.2f, 0.9f, p.up)) * even;
  s.cover = s.cover * (1.0f - s.film);
  out_.layers = s, out_.even = 0.6f * wet * even;
  return out_;
}

// ---- Glass.

const float kGlassIndex = 1.52f;  // refractive index of soda-lime glass
// What the glass itself lets through on its way straight through a sheet, 0.86, 0.905 and 0.875, as binary logarithms:
// with both faces 0.79, 0.83 and 0.80, as the green safety glass of cars.
const float kGlassLog2Red = -0.21759f, kGlassLog2Green = -0.14401f, kGlassLog2Blue = -0.19265f;
// Share of a sheet that dust and dirt cover wherever it faces: kHazeLeast + kHazeMore times the brightness of its
// texture; our choice.
const float kHazeLeast = 0.03f, kHazeMore = 0.11f;
// Of the share of dust that lies on other things that face up as much: a pane keeps less of it; our choice.
const float kGlassDust = 0.45f;

struct SheetShares {
  Real mirrored;  // of green light; the other colours differ by a fiftieth of it
  Real3 passed;   // straight on
};

// Of one polarisation. face: share that one face mirrors; clear: that the glass lets through on one crossing. The sum
// over all reflections between the faces is a geometric series.
FN Real sheet_mirrors(Real face, Real clear) {
  Real twice = clear * clear;
  return face + face * (1.0f - face) * (1.0f - face) * twice / (1.0f - face * face * twice);
}
FN Real sheet_passes(Real face, Real clear) {
  return (1.0f - face) * (1.0f - face) * clear / (1.0f - face * face * clear * clear);
}

// Of clean glass, by Fresnel's equations; cosine: of the light with the normal.
FN SheetShares find_sheet_shares(Real cosine) {
  Real c = clamp(cosine, 0.01f, 1.0f);
  Real inner = sqrt(1.0f - (1.0f - c * c) * (1.0f / (kGlassIndex * kGlassIndex)));
  Real across = (c - kGlassIndex * inner) / (c + kGlassIndex * inner);
  Real along = (kGlassIndex * c - inner) / (kGlassIndex * c + inner);
  Real s = across * across, p = along * along, way = 1.0f / inner;
  Real red = exp2(way * kGlassLog2Red), green = exp2(way * kGlassLog2Green), blue = exp2(way * kGlassLog2Blue);
  SheetShares sheet;
  sheet.mirrored = (sheet_mirrors(s, green) + sheet_mirrors(p, green)) * 0.5f;
  sheet.passed = real3((sheet_passes(s, red) + sheet_passes(p, red)) * 0.5f,
                       (sheet_passes(s, green) + sheet_passes(p, green)) * 0.5f,
                       (sheet_passes(s, blue) + sheet_passes(p, blue)) * 0.5f);
  return sheet;
}

// Dust and dirt lie on a part of it and are matt; the rest is clear, and mirrors as its angle says. As layers: a mirror
// that covers as much as is mirrored, over a base as bright as makes what the dust throws back.
FN SurfaceLayers make_glass(SurfaceLayers s, Real cosine, Real bright) {
  SheetShares sheet = find_sheet_shares(cosine);
  Real dust = (1.0f - s.cover) * kGlassDust;
  Real covered = dust + (1.0f - dust) * (kHazeLeast + kHazeMore * bright);
  s.cover = (1.0f - covered) * sheet.mirrored, s.reflectance = real(1.0f);
  s.albedo = dust_colour(dust_grey(bright) * covered / (1.0f - s.cover));
  s.clear = sheet.passed * (1.0f - covered);
  return s;
}

// ---- Paint: the colours of a user's file.

FN Real decode_srgb(Real code) {
  return select(code <= 0.04045f, code * (1.0f / 12.92f), pow((code + 0.055f) * (1.0f / 1.055f), 2.4f));
}
FN Real3 decode_srgb3(Real3 code) { return real3(decode_srgb(code.x), decode_srgb(code.y), decode_srgb(code.z)); }

// How a triangle lies in the images, and directions in it that are to the right and upwards there; of any length.
struct PaintAxes {
  Real texels;  // sides of an image a metre
  Real3 right, up;
};
// ab, ac: edges of the triangle; u1, v1, u2, v2: the same in the images.
FN PaintAxes find_paint_axes(Real3 ab, Real3 ac, Real u1, Real v1, Real u2, Real v2) {
  Real turn = u1 * v2 - v1 * u2, sign_ = select(turn < 0.0f, real(-1.0f), real(1.0f));
  PaintAxes axes;
  axes.texels = sqrt(abs(turn) / max(length(cross(ab, ac)), 1e-20f));
  axes.right = (ab * v2 - ac * v1) * sign_, axes.up = (ac * u1 - ab * u2) * sign_;
  return axes;
}
// side: of the images, in texels; footprint: width of what is seen, measured across the surface.
FN Real paint_level(PaintAxes axes, float side, Real footprint) { return log2(max(side * axes.texels * footprint, 1.0f)); }

// x, y: of a relief, 0 to 1 as an image has them.
FN Real3 bend_paint(PaintAxes axes, Real3 normal, Real x, Real y) {
  Real sx = (x * 255.0f - 128.0f) * (1.0f / 127.0f), sy = (y * 255.0f - 128.0f) * (1.0f / 127.0f);
  Real3 right = axes.right - normal * dot(axes.right, normal), up = axes.up - normal * dot(axes.up, normal);
  return normalize(right * (sx * inverse_sqrt(max(dot(right, right), 1e-30f))) +
                   up * (sy * inverse_sqrt(max(dot(up, up), 1e-30f))) + normal * sqrt(max(1.0f - sx * sx - sy * sy, 0.04f)));
}

// albedo: of metal and matt base alike; roughness: as files have it; reflectance: of what is no metal.
FN SurfaceLayers paint_over(SurfaceLayers s, Real3 albedo, Real roughness, Real metalness, Real reflectance) {
  s.reflectance = mix(reflectance, min(grey_of(albedo), real(0.99f)), metalness);
  s.albedo = albedo * (1.0f - metalness);
  s.cover = select(s.reflectance > 0.0f, real(1.0f), real(0.0f));
  s.roughness = max(roughness * roughness, 0.02f);
  return s;
}

// ---- How it reflects.

// Schlick's approximation of Fresnel's law.
FN Real fresnel(Real reflectance, Real cosine) {
  Real c = 1.0f - cosine, c2 = c * c;
  return reflectance + (1.0f - reflectance) * c2 * c2 * c;
}

struct MirrorAngles {
  Real facing, half_way;  // cosines: normal and half-way, eye and half-way
  Real lit, seen;         // normal and light, normal and eye
};
FN MirrorAngles find_mirror_angles(Real3 normal, Real3 to_light, Real3 to_eye) {
  Real3 h = normalize(to_light + to_eye);
  MirrorAngles angles;
  angles.facing = clamp(dot(h, normal), 0.0f, 1.0f), angles.half_way = clamp(dot(h, to_eye), 0.0f, 1.0f);
  angles.lit = max(dot(to_light, normal), 0.0f), angles.seen = max(dot(to_eye, normal), 0.0f);
  return angles;
}

// pi times the BRDF of a rough mirror, as transport/reflection.h has it: the distribution of Trowbridge and Reitz, with
// Smith's shadowing of correlated heights (Heitz 2014).
FN Real mirror_lobe(Real reflectance, Real alpha, MirrorAngles angles) {
  Real a2 = alpha * alpha, lit = angles.lit, seen = angles.seen;
  Real d = angles.facing * angles.facing * (a2 - 1.0f) + 1.0f;
  Real shadowing = lit * sqrt(seen * seen * (1.0f - a2) + a2) + seen * sqrt(lit * lit * (1.0f - a2) + a2);
  return fresnel(reflectance, angles.half_way) * a2 / (d * d * 2.0f * max(shadowing, 1e-3f));
}
FN Real gloss_lobe(SurfaceLayers s, MirrorAngles angles) {
  return s.cover * mirror_lobe(s.reflectance, s.roughness, angles);
}
FN Real film_lobe(SurfaceLayers s, MirrorAngles angles) {
  return s.film * mirror_lobe(real(kWaterReflectance), real(kFilmRoughness), angles);
}

// Share of even light from all around that the gloss, and the film, throw back at an angle of this cosine: rough mirrors
// rise less towards grazing angles (Lagarde 2011).
FN Real grazing_gain(SurfaceLayers s) { return max(1.0f - sqrt(s.roughness) - s.reflectance, 0.0f); }
FN Real steepness(Real cosine) {
  Real c = 1.0f - clamp(cosine, 0.0f, 1.0f), c2 = c * c;
  return c2 * c2 * c;
}
FN Real gloss_share(SurfaceLayers s, Real cosine) {
  return s.cover * (s.reflectance + grazing_gain(s) * steepness(cosine));
}
FN Real film_share(SurfaceLayers s, Real cosine) {
  return s.film * (kWaterReflectance + (1.0f - 0.34641016f) * steepness(cosine));  // the root of kFilmRoughness
}

// What mirrors let through to the base from a light, as a multiple of what they let through of even light
// (Kelemen and Szirmay-Kalos 2001); a twenty-first is the mean of Schlick's slope. mirrored: the two shares above.
FN Real base_share(SurfaceLayers s, Real mirrored) {
  Real mean = s.cover * (s.reflectance + grazing_gain(s) * (1.0f / 21.0f));
  return (1.0f - mirrored) / (1.0f - mean);
}
