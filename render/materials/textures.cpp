#include "render/materials/textures.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/parallel.h"
#include "render/materials/tile_noise.h"

namespace rubble {

namespace {

// What a pattern says about one spot; x and y run over [0, 1).
struct Spot {
  float height = 0;  // relief in tile widths times 100
  float bright = 0.5f;
  float mask = 0;
};

float ramp(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

// Formwork boards, air pores of all sizes, blotches of weathering, hairline cracks, stains.
Spot cast_concrete(float x, float y) {
  const float warp = tile_fractal(x, y, 5, 4, 0.55f, 18) - 0.5f;
  const float blotch = tile_fractal(x + 0.05f * warp, y - 0.05f * warp, 3, 6, 0.58f, 11);
  const float grain = tile_fractal(x, y, 64, 3, 0.65f, 12);
  // Pores crowd in some places and are missing in others; few are large, and none is quite round.
  const float crowd = tile_fractal(x, y, 4, 3, 0.6f, 27);
  const float bend = 0.02f * (tile_fractal(x, y, 30, 3, 0.6f, 28) - 0.5f);
  const CellNoise large = tile_cells(x + bend, y - bend, 19, 13);
  const CellNoise small = tile_cells(x - bend, y + bend, 83, 19);
  const float rank = (large.value - 0.99f + 0.22f * ramp(0.42f, 0.68f, crowd)) / 0.22f;
  const float width = 0.015f + 0.13f * rank * rank;
  const float pit = rank > 0 ? 1 - ramp(0.4f * width, width + 0.03f, large.nearest) : 0;
  const float pin = small.value > 0.97f - 0.3f * ramp(0.45f, 0.7f, crowd)
                        ? 1 - ramp(0.06f, 0.2f * small.value, small.nearest)
                        : 0;
  const float board = std::fabs(std::fmod(y * 7.0f + 0.015f * warp, 1.0f) - 0.5f) * 2;
  const float worn = ramp(0.35f, 0.6f, tile_fractal(x, y, 3, 4, 0.6f, 20));
  const float seam = ramp(0.975f, 0.998f, board) * worn;
  const float tone = lattice_value(int(std::floor(y * 7.0f + 0.5f)) % 7, 3, 26) - 0.5f;
  const float wander = 0.12f * warp + 0.05f * tile_fractal(x, y, 24, 4, 0.65f, 14);
  const CellNoise crack = tile_cells(x + wander, y - wander, 2, 15);
  const float hair = (1 - ramp(0.0005f, 0.005f, crack.second - crack.nearest)) *
                     ramp(0.52f, 0.62f, tile_fractal(x, y, 2, 3, 0.5f, 16));
  Spot s;
  s.height =
      0.06f * grain + 0.30f * blotch - 0.45f * pit - 0.12f * pin - 0.15f * seam - 0.2f * hair;
  s.bright = 0.05f + 0.95f * blotch + 0.28f * (grain - 0.5f) + 0.10f * tone - 0.38f * pit -
             0.25f * pin - 0.12f * seam - 0.35f * hair;
  s.mask = 0.55f * ramp(0.56f, 0.74f, tile_fractal(x - 0.1f * warp, y, 2, 6, 0.62f, 17));
  return s;
}

// Aggregate of two sizes standing out of a torn matrix.
Spot broken_concrete(float x, float y) {
  // The noise bends the grid of stones so that they are angular rather than round.
  const float bend = 0.035f * (tile_fractal(x, y, 20, 4, 0.65f, 21) - 0.5f);
  const CellNoise big = tile_cells(x + bend, y - bend, 26, 22);
  const CellNoise small = tile_cells(x - bend, y + bend, 66, 23);
  const float matrix = tile_fractal(x, y, 7, 7, 0.66f, 24);
  const float size = 0.22f + 0.3f * (big.value - 0.55f);
  const float stone = big.value > 0.55f ? 1 - ramp(0.7f * size, size, big.nearest) : 0.0f;
  const float hole = big.value < 0.12f ? 1 - ramp(0.2f, 0.36f, big.nearest) : 0.0f;
  const float pebble = small.value > 0.5f ? 1 - ramp(0.2f, 0.36f, small.nearest) : 0.0f;
  Spot s;
  s.height = 1.25f * matrix + 0.22f * stone - 0.3f * hole + 0.08f * pebble;
  const float tone = lattice_value(int(big.value * 9999), 7, 25);
  s.bright = 0.10f + 0.85f * matrix + stone * (tone - 0.55f) * 0.75f - 0.35f * hole +
             pebble * (small.value - 0.75f) * 0.9f;
  s.mask = std::max(stone * ramp(0.55f, 0.75f, tone), 0.3f * hole);
  return s;
}

// Fired clay: drag marks, dark firing spots, remnants of mortar.
Spot brick_face(float x, float y) {
  const float tone = tile_fractal(x, y, 4, 5, 0.55f, 31);
  const float drag = tile_noise(x * 12, y * 96, 12, 32) * tile_noise(x * 6, y * 24, 6, 33);
  const CellNoise spot = tile_cells(x, y, 26, 34);
  const float pit = spot.value > 0.6f ? 1 - ramp(0.08f, 0.2f, spot.nearest) : 0.0f;
  const float mortar = tile_fractal(x, y, 3, 6, 0.62f, 35);
  Spot s;
  // Mortar clings in crumbs, not in smooth patches.
  const float crumbs = tile_fractal(x, y, 28, 3, 0.65f, 36);
  s.mask = 0.6f * ramp(0.60f, 0.72f, mortar + 0.35f * (crumbs - 0.5f));
  s.height = 0.2f * tone + 0.3f * drag - 0.4f * pit + 0.5f * s.mask * mortar;
  s.bright = 0.15f + 0.8f * tone - 0.3f * pit + 0.2f * (drag - 0.25f);
  return s;
}

Spot broken_brick(float x, float y) {
  const float rough = tile_fractal(x, y, 10, 5, 0.65f, 41);
  const CellNoise grit = tile_cells(x, y, 46, 42);
  const float grain = grit.value > 0.6f ? 1 - ramp(0.15f, 0.4f, grit.nearest) : 0.0f;
  Spot s;
  s.height = 1.0f * rough + 0.15f * grain;
  s.bright = 0.1f + 0.85f * rough + 0.5f * grain * (grit.value - 0.75f);
  s.mask = grit.value < 0.15f ? 0.8f * (1 - ramp(0.2f, 0.4f, grit.nearest)) : 0.0f;
  return s;
}

// Lightweight block: a froth of pores between grains.
Spot porous_block(float x, float y) {
  const CellNoise coarse = tile_cells(x, y, 38, 51);
  const CellNoise fine = tile_cells(x, y, 80, 52);
  const float tone = tile_fractal(x, y, 4, 5, 0.6f, 53);
  const float pore = coarse.value > 0.45f ? 1 - ramp(0.1f, 0.34f, coarse.nearest) : 0.0f;
  const float pin = fine.value > 0.5f ? 1 - ramp(0.1f, 0.3f, fine.nearest) : 0.0f;
  Spot s;
  s.height = 0.3f * tone - 0.5f * pore - 0.18f * pin + 0.14f * fine.value;
  s.bright = 0.25f + 0.7f * tone + 0.2f * (fine.value - 0.5f) - 0.3f * pin;
  s.mask = 0.9f * pore;
  return s;
}

Spot rust(float x, float y) {
  const float tone = tile_fractal(x, y, 8, 6, 0.62f, 61);
  const float scale = tile_fractal(x, y, 30, 3, 0.6f, 62);
  Spot s;
  s.height = 0.5f * scale + 0.4f * tone;
  s.bright = 0.05f + 0.95f * tone + 0.3f * (scale - 0.5f);
  s.mask = ramp(0.60f, 0.68f, tile_fractal(x, y, 5, 4, 0.5f, 63));
  return s;
}

// Spangles of zinc crystals, and where the coat has gone.
Spot galvanised(float x, float y) {
  const float bend = 0.02f * tile_fractal(x, y, 12, 3, 0.5f, 71);
  const CellNoise crystal = tile_cells(x + bend, y + bend, 24, 72);
  const float tone = tile_fractal(x, y, 5, 5, 0.6f, 73);
  Spot s;
  s.height = 0.06f * crystal.value + 0.1f * tone;
  s.bright = 0.5f * crystal.value + 0.5f * tone;
  s.mask = ramp(0.62f, 0.70f, tile_fractal(x, y, 4, 6, 0.62f, 74));
  return s;
}

// Grain along x, knots, and splits.
Spot wood(float x, float y) {
  const float warp = tile_fractal(x, y, 2, 3, 0.5f, 81);
  const float rings = 0.6f * tile_noise(x * 2 + 0.4f * warp, y * 26 + 3 * warp, 26, 82) +
                      0.4f * tile_noise(x * 3, y * 64 + 5 * warp, 64, 87);
  const float worn = tile_fractal(x, y, 4, 5, 0.6f, 86);
  const float fibre = tile_noise(x * 10, y * 160, 160, 83);
  const CellNoise knot = tile_cells(x, y, 4, 84);
  const float eye = knot.value > 0.82f ? 1 - ramp(0.02f, 0.09f, knot.nearest) : 0.0f;
  const float split = ramp(0.80f, 0.9f, tile_noise(x * 3, y * 44, 44, 85));
  Spot s;
  s.height = 0.22f * rings + 0.2f * fibre - 0.5f * split;
  s.bright = 0.12f + 0.34f * rings + 0.26f * fibre + 0.55f * (worn - 0.3f) - 0.4f * split;
  s.mask = std::max(0.85f * eye, 0.7f * split);
  return s;
}

// Painted plaster with trowel marks, scuffs and old paint.
Spot plaster(float x, float y) {
  const float trowel = tile_fractal(x, y, 5, 4, 0.5f, 91);
  const float grain = tile_fractal(x, y, 60, 2, 0.6f, 92);
  const float paint = tile_fractal(x, y, 3, 6, 0.6f, 93);
  const CellNoise scuff = tile_cells(x, y, 18, 94);
  const float pit = scuff.value > 0.8f ? 1 - ramp(0.05f, 0.2f, scuff.nearest) : 0.0f;
  Spot s;
  s.mask = ramp(0.50f, 0.53f, paint);
  s.height = 0.35f * trowel + 0.08f * grain - 0.4f * pit + 0.12f * s.mask;
  s.bright = 0.35f + 0.5f * trowel + 0.15f * grain - 0.4f * pit;
  return s;
}

// Dirt and sand, and crumbs of debris of three sizes. The mask ranks the crumbs, from 0 to 1: how many
// of them lie there is for the shader to say, by the map of the ground.
Spot soil(float x, float y) {
  const float bend = 0.07f * (tile_fractal(x, y, 30, 4, 0.7f, 104) - 0.5f);
  const float dirt = tile_fractal(x, y, 5, 8, 0.66f, 101);
  const float clods = tile_fractal(x + bend, y - bend, 22, 4, 0.6f, 107);
  const CellNoise sand = tile_cells(x + bend, y - bend, 170, 105);
  const CellNoise grit = tile_cells(x - bend, y - bend, 72, 102);
  const CellNoise gravel = tile_cells(x + bend, y + bend, 40, 106);
  const CellNoise chip = tile_cells(x - bend, y + bend, 17, 103);
  // Angular: the distance to the border of its cell bounds a stone as much as that to its middle.
  const auto stone = [](const CellNoise& c, float size, float edge) {
    const float r = size * (0.45f + 0.55f * c.value);
    return std::min(1 - ramp(0.3f * r, r, c.nearest),
                    ramp(0.0f, edge, c.second - c.nearest - 0.02f));
  };
  const float sands = stone(sand, 0.5f, 0.2f), grits = stone(grit, 0.5f, 0.2f);
  const float stones = stone(gravel, 0.45f, 0.2f), chips = stone(chip, 0.26f, 0.3f);
  // Ranks: most of what lies there is small.
  const float rank = std::max({grits * (0.35f + 0.65f * grit.value),
                               stones * (0.2f + 0.75f * gravel.value),
                               chips * (0.1f + 0.8f * chip.value)});
  Spot s;
  s.height = 0.42f * dirt + 0.2f * clods + 0.03f * sands + 0.05f * grits * grit.value +
             0.08f * stones * gravel.value + 0.12f * chips * chip.value;
  s.bright = 0.06f + 0.62f * dirt + 0.22f * (clods - 0.4f) + 0.14f * sands * (sand.value - 0.5f) +
             0.3f * grits * (lattice_value(int(grit.value * 9999), 3, 108) - 0.45f);
  s.mask = rank;
  return s;
}

// Wood torn along its fibres.
Spot splinters(float x, float y) {
  const float warp = tile_fractal(x, y, 3, 3, 0.5f, 111);
  const float coarse = tile_noise(x * 4 + 0.6f * warp, y * 40 + 2 * warp, 40, 112);
  const float fine = tile_noise(x * 14, y * 130, 130, 113);
  const float gap = ramp(0.72f, 0.85f, tile_noise(x * 3, y * 56, 56, 114));
  Spot s;
  s.height = 0.9f * coarse + 0.35f * fine - 0.6f * gap;
  s.bright = 0.25f + 0.5f * coarse + 0.35f * (fine - 0.3f);
  s.mask = 0.7f * gap;
  return s;
}

// A coat of paint, dented and scratched down to primer and rust.
Spot paint(float x, float y) {
  const float dent = tile_fractal(x, y, 3, 3, 0.5f, 121);
  const float dirt = tile_fractal(x, y, 5, 6, 0.62f, 125);
  const float flake = tile_fractal(x, y, 26, 5, 0.72f, 122);
  // Scratches are thin, run where something scraped along, and come in sheaves.
  const float bend = 0.05f * tile_fractal(x, y, 6, 3, 0.5f, 126);
  const float line = tile_noise(x * 6, (y + bend) * 220, 220, 123) *
                     ramp(0.55f, 0.75f, tile_fractal(x, y, 5, 3, 0.5f, 124));
  Spot s;
  s.height = 0.9f * dent;
  s.bright = 0.15f + 0.75f * dirt + 0.2f * (flake - 0.5f);
  const float chipped = ramp(0.69f, 0.73f, flake * 0.75f + 0.25f * dirt);
  s.mask = std::max(0.9f * chipped, 0.55f * ramp(0.72f, 0.85f, line));
  return s;
}

// Threads over and under each other, worn in places.
Spot weave(float x, float y) {
  constexpr int kThreads = 40;
  const float fx = x * kThreads, fy = y * kThreads;
  const float ax = fx - std::floor(fx), ay = fy - std::floor(fy);
  const bool over = (int(std::floor(fx)) + int(std::floor(fy))) % 2 == 0;
  const float across = over ? ay : ax, along = over ? ax : ay;
  const float thread = 1 - std::fabs(across * 2 - 1), arch = 1 - 0.6f * std::fabs(along * 2 - 1);
  const float worn = tile_fractal(x, y, 3, 5, 0.6f, 131);
  Spot s;
  s.height = 0.5f * thread * arch;
  s.bright = 0.15f + 0.5f * thread * arch + 0.7f * (worn - 0.5f);
  s.mask = 0.7f * ramp(0.6f, 0.72f, worn);
  return s;
}

// Nothing but dirt.
Spot smooth_sheet(float x, float y) {
  const float dirt = tile_fractal(x, y, 4, 6, 0.6f, 141);
  Spot s;
  s.height = 0.03f * dirt;
  s.bright = dirt;
  s.mask = 0.5f * ramp(0.55f, 0.75f, dirt);
  return s;
}

// Stones in a running bond, four by twelve, with sunken joints; no two of one tone.
Spot masonry(float x, float y) {
  constexpr int kColumns = 4, kRows = 12;
  const float wobble = 0.012f * (tile_fractal(x, y, 24, 3, 0.6f, 151) - 0.5f);
  const float v = (y + 0.25f * wobble) * kRows, row = std::floor(v);
  const float u = (x + wobble) * kColumns + (int(row) % 2 ? 0.5f : 0.0f), column = std::floor(u);
  const float across = std::min(u - column, 1 - (u - column)), up = std::min(v - row, 1 - (v - row));
  const float joint = std::max(1 - ramp(0.012f, 0.026f, across), 1 - ramp(0.05f, 0.095f, up));
  const int stone = (int(column) + kColumns) % kColumns + kColumns * ((int(row) + kRows) % kRows);
  const float tone = lattice_value(stone, 5, 152), rough = tile_fractal(x, y, 20, 5, 0.62f, 153);
  const float stain = tile_fractal(x, y, 3, 4, 0.6f, 154);
  Spot s;
  s.height = 0.5f * (1 - joint) + 0.12f * rough;
  s.bright = 0.12f + 0.42f * tone + 0.3f * rough + 0.35f * (stain - 0.35f);
  s.mask = 0.92f * joint;
  return s;
}

Spot spot_of(Pattern pattern, float x, float y) {
  switch (pattern) {
    case Pattern::cast_concrete:
      return cast_concrete(x, y);
    case Pattern::broken_concrete:
      return broken_concrete(x, y);
    case Pattern::brick_face:
      return brick_face(x, y);
    case Pattern::broken_brick:
      return broken_brick(x, y);
    case Pattern::porous_block:
      return porous_block(x, y);
    case Pattern::rust:
      return rust(x, y);
    case Pattern::galvanised:
      return galvanised(x, y);
    case Pattern::wood:
      return wood(x, y);
    case Pattern::plaster:
      return plaster(x, y);
    case Pattern::soil:
      return soil(x, y);
    case Pattern::splinters:
      return splinters(x, y);
    case Pattern::paint:
      return paint(x, y);
    case Pattern::weave:
      return weave(x, y);
    case Pattern::smooth:
      return smooth_sheet(x, y);
    case Pattern::masonry:
      return masonry(x, y);
  }
  return {};
}

std::uint8_t to_byte(float x) { return std::uint8_t(std::clamp(x, 0.0f, 1.0f) * 255.0f + 0.5f); }

}  // namespace

PatternImage make_pattern(Pattern pattern, int size) {
  std::vector<Spot> spots(std::size_t(size) * std::size_t(size));
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      spots[std::size_t(y * size + x)] =
          spot_of(pattern, (float(x) + 0.5f) / float(size), (float(y) + 0.5f) / float(size));
  PatternImage image{size, std::vector<std::uint8_t>(spots.size() * 4)};
  const int mask = size - 1;
  const auto height = [&](int x, int y) {
    return spots[std::size_t((y & mask) * size + (x & mask))].height;
  };
  // Heights are hundredths of a tile: a slope of 1 is a rise of one texel's width in a texel.
  const float scale = 0.01f * float(size) * 0.5f;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const std::size_t at = std::size_t(y * size + x);
      const float sx = (height(x + 1, y) - height(x - 1, y)) * scale;
      const float sy = (height(x, y + 1) - height(x, y - 1)) * scale;
      image.texels[at * 4 + 0] = to_byte(0.5f + 0.25f * sx);
      image.texels[at * 4 + 1] = to_byte(0.5f + 0.25f * sy);
      image.texels[at * 4 + 2] = to_byte(spots[at].bright);
      image.texels[at * 4 + 3] = to_byte(spots[at].mask);
    }
  }
  return image;
}

std::vector<PatternImage> make_patterns(int size, int threads) {
  std::vector<PatternImage> images(kPatternCount);
  parallel_for(kPatternCount, threads,
               [&](std::size_t i) { images[i] = make_pattern(Pattern(i), size); });
  return images;
}

std::vector<PatternImage> make_patterns_once(const DiskCache& cache, int size, int threads) {
  constexpr int kVersion = 4;  // raise it when a pattern changes
  const std::string key = CacheKey("make_patterns", kVersion).add(size).hex();
  if (const auto bytes = cache.find("textures", key)) {
    std::vector<PatternImage> images(kPatternCount);
    CacheReader reader(*bytes);
    bool good = true;
    for (PatternImage& image : images) {
      image.size = size;
      reader.get(image.texels);
      good = good && image.texels.size() == std::size_t(size) * std::size_t(size) * 4;
    }
    if (good && reader.whole()) return images;
  }
  std::vector<PatternImage> images = make_patterns(size, threads);
  CacheWriter writer;
  for (const PatternImage& image : images) writer.put(image.texels);
  cache.store("textures", key, writer.bytes());
  return images;
}

}  // namespace rubble
