#include "kernel/settling/generator.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/base/random.h"
#include "kernel/geometry/shape.h"
#include "kernel/model/pile.h"
#include "kernel/settling/furnish.h"
#include "kernel/settling/layer_space.h"

namespace rubble {
namespace {

// A place is drawn anew this often before a layer counts as full.
constexpr int kMaxTries = 2000;
// Pieces start this far above the highest terrain below their box; unit: m.
constexpr double kTerrainClearance = 0.5;
// Terrain counts as below the box up to this distance beside it; unit: m.
constexpr double kTerrainMargin = 1.0;

class SpecCheck {
 public:
  void expect(bool fine, const std::string& key, const std::string& expected,
              const std::string& found) {
    if (fine) return;
    Diagnostic d;
    d.key = key;
    d.message = "out of range";
    d.expected = expected;
    d.found = found;
    problems_.push_back(d);
  }
  void expect(bool fine, const std::string& key, const std::string& expected, double found) {
    expect(fine, key, expected, plain_text(found));
  }
  void finish() const {
    if (!problems_.empty()) throw InputError(problems_);
  }

 private:
  std::vector<Diagnostic> problems_;
};

void validate(const PileSpec& spec) {
  SpecCheck check;
  const auto expect_kind = [&](PieceKind kind, const std::string& key) {
    const std::size_t count = kind.is_assembly ? spec.assemblies.size() : spec.types.size();
    check.expect(kind.index >= 0 && std::size_t(kind.index) < count, key + (kind.is_assembly ? ".assembly" : ".type"),
                 "0 to " + std::to_string(std::int64_t(count) - 1), std::to_string(kind.index));
  };
  double total = 0;
  for (std::size_t i = 0; i < spec.mix.size(); ++i) {
    const MixEntry& e = spec.mix[i];
    const std::string key = "mix[" + std::to_string(i) + "]";
    expect_kind(e.kind, key);
    check.expect(e.weight >= 0 && std::isfinite(e.weight), key + ".weight", "0 or more", e.weight);
    check.expect(e.scale_min >= 0.01 && e.scale_min <= e.scale_max, key + ".scale_min",
                 "0.01 to scale_max", e.scale_min);
    check.expect(e.scale_max <= 100, key + ".scale_max", "100 at most", e.scale_max);
    check.expect(e.spread.typical > 0 && e.spread.typical <= 100, key + ".spread.typical",
                 "above 0, to 100", e.spread.typical);
    check.expect(e.spread.deviation > 0 && e.spread.deviation <= 10, key + ".spread.deviation",
                 "above 0, to 10", e.spread.deviation);
    total += e.weight;
  }
  for (std::size_t i = 0; i < spec.placed.size(); ++i) {
    const Placement& p = spec.placed[i];
    const std::string key = "placed[" + std::to_string(i) + "]";
    expect_kind(p.kind, key);
    check.expect(p.scale >= 0.01 && p.scale <= 100, key + ".scale", "0.01 to 100", p.scale);
  }
  for (std::size_t i = 0; i < spec.furniture.size(); ++i) {
    const Furnishing& f = spec.furniture[i];
    const std::string key = "furniture[" + std::to_string(i) + "]";
    expect_kind(f.kind, key);
    check.expect(f.per_bay >= 0 && f.per_bay <= 20, key + ".per_bay", "0 to 20", f.per_bay);
  }
  check.expect(spec.layers >= 0 && spec.layers <= 1000, "layers", "0 to 1000",
               std::to_string(spec.layers));
  check.expect(spec.pieces_per_layer >= 0 && spec.pieces_per_layer <= 100000, "pieces_per_layer",
               "0 to 100000", std::to_string(spec.pieces_per_layer));
  const Vec3& b = spec.spawn_bounds;
  check.expect(b.x > 0, "spawn_bounds.x", "more than 0", b.x);
  check.expect(b.y > 0, "spawn_bounds.y", "more than 0", b.y);
  check.expect(b.z > 0, "spawn_bounds.z", "more than 0", b.z);
  check.expect(spec.layers == 0 || spec.pieces_per_layer == 0 || total > 0, "mix",
               "at least one entry with a weight above 0", total);
  const SpawnDensity& density = spec.spawn_density;
  double weights = 0;
  bool fine = true;
  for (const double w : density.weights) fine = fine && w >= 0 && std::isfinite(w), weights += w;
  check.expect(density.weights.empty() ||
                   (fine && weights > 0 && density.columns > 0 && density.rows > 0 &&
                    density.weights.size() == std::size_t(density.columns) * std::size_t(density.rows)),
               "spawn_density", "columns * rows weights of at least 0, not all of them 0",
               std::to_string(density.weights.size()) + " weights");
  check.finish();
}

[[noreturn]] void fail_full(const PileSpec& spec, int layer, int fitted) {
  Diagnostic d;
  d.key = "pieces_per_layer";
  d.message = "layer " + std::to_string(layer + 1) + " does not fit into the spawn box";
  d.expected = "as many pieces as fit without overlap";
  d.found = std::to_string(spec.pieces_per_layer) + " pieces, of which " + std::to_string(fitted) +
            " fitted";
  d.hint = "enlarge spawn_bounds, drop fewer pieces per layer, or use more layers";
  throw InputError(d);
}

class LayerMaker {
 public:
  LayerMaker(const PileSpec& spec, const ByKind<Shape>& shapes)
      : spec_(spec), shapes_(shapes), random_(spec.seed, "pile") {
    if (!spec.spawn_density.weights.empty()) density_.emplace(spec.spawn_density.weights);
    for (const MixEntry& e : spec.mix) {
      if (e.weight > 0) largest_ = std::max(largest_, double(shapes[e.kind].radius) * e.scale_max);
    }
  }

  Layer make(int number) {
    std::vector<double> weights;
    for (const MixEntry& e : spec_.mix) weights.push_back(e.weight);
    const WeightedChoice choice(weights);
    LayerSpace space(shapes_, largest_);
    Layer layer;
    for (int i = 0; i < spec_.pieces_per_layer; ++i) {
      const MixEntry& entry = spec_.mix[choice.draw(random_)];
      Placement piece;
      piece.kind = entry.kind;
      piece.scale = draw_size(entry.spread, entry.scale_min, entry.scale_max, random_);
      if (!find_place(space, piece)) fail_full(spec_, number, i);
      space.add(piece);
      layer.pieces.push_back(piece);
    }
    return layer;
  }

 private:
  // Centres of mass lie inside the box's footprint; no piece reaches below its bottom.
  bool find_place(const LayerSpace& space, Placement& piece) {
    const Shape& shape = shapes_[piece.kind];
    const double radius = double(shape.radius) * piece.scale;
    const Vec3 half = spec_.spawn_bounds * 0.5;
    const double highest = std::max(radius, spec_.spawn_bounds.z - radius);
    for (int attempt = 0; attempt < kMaxTries; ++attempt) {
      Pose& pose = piece.world_from_body;
      pose.rotation = random_.rotation();
      const Vec3 place = draw_place(half);
      const Vec3 centre{spec_.spawn_position.x + place.x, spec_.spawn_position.y + place.y,
                        random_.uniform(radius, highest)};
      pose.translation =
          centre - pose.rotation.rotate(shape.volume.centre_of_mass * piece.scale);
      if (space.is_free(piece)) return true;
    }
    return false;
  }

  // Relative to the middle of the box; z is 0.
  Vec3 draw_place(const Vec3& half) {
    if (!density_) {
      const double x = random_.uniform(-half.x, half.x);
      return {x, random_.uniform(-half.y, half.y), 0};
    }
    const SpawnDensity& grid = spec_.spawn_density;
    const int cell = density_->draw(random_);
    const double column = cell % grid.columns + random_.uniform();
    const double row = cell / grid.columns + random_.uniform();
    return {half.x * (2 * column / grid.columns - 1), half.y * (2 * row / grid.rows - 1), 0};
  }

  const PileSpec& spec_;
  const ByKind<Shape>& shapes_;
  std::optional<WeightedChoice> density_;
  RandomStream random_;
  double largest_ = 0.01;
};

// What lies highest of the terrain under the spawn box, and the clearance above it.
double lowest_spawn(const PileSpec& spec, const ByKind<Shape>& shapes) {
  double top = -1e300;
  const Vec3 half = spec.spawn_bounds * 0.5;
  for (const Placement& placement : spec.placed) {
    const Shape& shape = shapes[placement.kind];
    if (!shape.surface) continue;
    const Pose& pose = placement.world_from_body;
    for (const Vec3& corner : shape.surface->corners()) {
      const Vec3 p = pose * (corner * placement.scale);
      const Vec3 from_middle = p - spec.spawn_position;
      const double margin = kTerrainMargin;
      if (std::abs(from_middle.x) > half.x + margin || std::abs(from_middle.y) > half.y + margin) {
        continue;
      }
      top = std::max(top, p.z);
    }
  }
  return top + kTerrainClearance;
}

}  // namespace

Pile generate_pile(const PileSpec& spec) {
  validate(spec);
  ByKind<Shape> shapes;
  ByKind<Aabb> bounds;
  for (std::size_t i = 0; i < spec.types.size(); ++i) {
    shapes.types.push_back(compile_shape(spec.types[i], "types[" + std::to_string(i) + "]"));
    bounds.types.push_back(calc_bounds(spec.types[i]));
  }
  for (std::size_t i = 0; i < spec.assemblies.size(); ++i) {  // they take room as one rigid piece
    const std::string key = "assemblies[" + std::to_string(i) + "]";
    validate(spec.assemblies[i], int(spec.types.size()), key);
    const PieceType rigid = make_rigid_type(spec.assemblies[i], spec.types);
    shapes.assemblies.push_back(compile_shape(rigid, key));
    bounds.assemblies.push_back(calc_bounds(rigid));
  }
  Pile pile;
  pile.types = spec.types;
  pile.assemblies = spec.assemblies;
  pile.placed = spec.placed;
  for (const Placement& placement : furnish(spec, bounds)) pile.placed.push_back(placement);
  pile.building = spec.building;
  pile.building_first_type = spec.building_first_type;
  pile.structures = spec.structures;
  pile.spawn_bottom = std::max(spec.spawn_position.z - spec.spawn_bounds.z / 2,
                               lowest_spawn(spec, shapes));
  LayerMaker maker(spec, shapes);
  for (int layer = 0; layer < spec.layers; ++layer) pile.layers.push_back(maker.make(layer));
  return pile;
}

}  // namespace rubble
