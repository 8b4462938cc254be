#include "assets/generator/pieces.h"
#include "assets/generator/shapes.h"
#include "kernel/base/portable_math.h"

namespace rubble::generator {
namespace {

constexpr double kHalfSheet = 0.00625;  // half of 12.5 mm; unit: m
constexpr Surface kPaper = Surface::drywall;
constexpr Surface kGypsum = Surface::drywall_core;

// A strip of the paper face that hangs on beyond the break, curling up or down.
Sheet paper_strip(const Vec3& from, const Vec3& to, const Vec3& outward, double side,
                  RandomStream& random) {
  const int columns = 7, rows = 5;
  Sheet strip{columns, rows, {}, 0.0012, kPaper, kGypsum};
  const double length = random.uniform(0.045, 0.09), curl = random.uniform(0.3, 1.4) * side;
  std::vector<double> teeth;
  for (int c = 0; c < columns; ++c) teeth.push_back(random.uniform(0.35, 1));
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const double out = length * teeth[std::size_t(c)] * r / (rows - 1) - 0.03;
      const double up = out < 0 ? 0 : curl * out * out / length;
      strip.points.push_back(from + (to - from) * (double(c) / (columns - 1)) + outward * out +
                             Vec3{0, 0, side * (kHalfSheet - 0.0016) + up});
    }
  }
  return strip;
}

// Strips along a straight break of the outline.
void add_paper(Recipe& r, const Cell& cell, const Face& edge, RandomStream& random) {
  Vec3 middle = edge.normal * edge.offset;
  const Vec3 along = normalized(cross(edge.normal, Vec3{0, 0, 1}));
  const double left = exit_distance(cell, middle * 0.999, along);
  const double right = exit_distance(cell, middle * 0.999, -along);
  double at = -right + 0.02;
  while (at < left - 0.06) {
    const double width = std::fmin(random.uniform(0.05, 0.16), left - at);
    const bool torn_clean = random.uniform() < 0.35;
    const double side = random.uniform() < 0.5 ? 1 : -1;
    const Sheet strip = paper_strip(middle + along * (at + width), middle + along * at, edge.normal,
                                    side, random);
    if (!torn_clean) r.sheets.push_back(strip);
    at += width * random.uniform(1.0, 1.3);
  }
}

Cell cut(Cell cell, const Vec3& normal, double offset) {
  cell.push_back({normal, offset, kGypsum});
  return cell;
}

struct Board {
  const char* name;
  double half_x, half_y;
  std::vector<Vec3> breaks;  // x, y: normal; z: distance from the middle
  bool hole;
  double weight;
};

Recipe board(const Board& shape) {
  RandomStream random = piece_stream(shape.name);
  Recipe r = plain_recipe(shape.name, random, "drywall", drywall_wear(), 0.005);
  Cell cell = box_cell({-shape.half_x, -shape.half_y, -kHalfSheet}, {shape.half_x, shape.half_y, kHalfSheet},
                       kPaper);
  for (const Vec3& b : shape.breaks) {
    cell.push_back({normalized(Vec3{b.x, b.y, random.uniform(-0.2, 0.2)}), b.z, kGypsum});
  }
  for (std::size_t i = 6; i < cell.size(); ++i) add_paper(r, cell, cell[i], random);
  r.solid.cells = {cell};
  r.regions = {cell};
  if (shape.hole) {  // punched through by something that fell
    const Vec3 middle{-0.15, 0.05, 0};
    Cell hole{{{0, 0, 1}, 0.1, kGypsum}, {{0, 0, -1}, 0.1, kGypsum}};
    for (int i = 0; i < 6; ++i) {
      const portable::SinCos turn = portable::sincos(1.047 * i + random.uniform(-0.25, 0.25));
      const Vec3 n{turn.cos, turn.sin, 0};
      hole.push_back({n, dot(n, middle) + random.uniform(0.06, 0.11), kGypsum});
    }
    const Cell left = cut(cell, {1, 0, 0}, middle.x - 0.085), right = cut(cell, {-1, 0, 0}, -middle.x - 0.085);
    const Cell between = cut(cut(cell, {-1, 0, 0}, 0.086 - middle.x), {1, 0, 0}, middle.x + 0.086);
    r.regions = {left, right, cut(between, {0, 1, 0}, middle.y - 0.08),
                 cut(between, {0, -1, 0}, -middle.y - 0.08)};
    r.solid.hollows = {hole};
  }
  r.triangles = {3400, 1100, 400};
  r.max_edge = 0.2;
  r.weight = shape.weight;
  r.tags = {"drywall", "sheet"};
  return r;
}

}  // namespace

std::vector<Recipe> drywall_pieces() {
  return {board({"drywall_sheet", 0.8, 0.6, {{1, 0.2, 0.74}, {1, -0.5, 0.78}}, true, 0.4}),
          board({"drywall_torn",
                 0.45,
                 0.32,
                 {{1, 0.3, 0.38}, {-1, 0.5, 0.36}, {-0.2, 1, 0.26}},
                 false,
                 1.0}),
          board({"drywall_shard", 0.25, 0.16, {{1, 0.6, 0.2}, {-0.7, 1, 0.13}, {-1, -0.3, 0.2}},
                 false, 1.2})};
}

}  // namespace rubble::generator
