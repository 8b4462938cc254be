// Which buildings there can be.
#include <algorithm>
#include <functional>

#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/structure/building.h"
#include "kernel/structure/buildings/parts.h"

namespace rubble {
namespace {

struct Range {
  const char* key;
  double value, low, high;
};

using Fail = std::function<void(const std::string&, const std::string&, const std::string&)>;

void check_ranges(const BuildingSpec& b, const Fail& fail) {
  const CollapseCause& c = b.cause;
  const bool bridge = b.kind == BuildingKind::bridge;
  const Range ranges[] = {
      {"storeys", double(b.storeys), 1, bridge ? 1.0 : 12.0}, {"bays_x", double(b.bays_x), 1, 8},
      {"bays_y", double(b.bays_y), 1, 8},          {"span_x", b.span_x, 2, bridge ? 40.0 : 12.0},
      {"span_y", b.span_y, 2, 12},                 {"storey_height", b.storey_height, 2.2, bridge ? 12.0 : 6.0},
      {"column", b.column, 0.15, bridge ? 2.0 : 1.2}, {"beam_depth", b.beam_depth, 0.15, bridge ? 3.0 : 1.5},
      {"slab", b.slab, 0.1, 0.5},                  {"column_bars", b.column_bars, 0, 0.06},
      {"beam_bars", b.beam_bars, 0, 0.06},         {"slab_bars", b.slab_bars, 0, 0.06},
      {"infill_thickness", b.infill_thickness, 0.08, 0.5}, {"openings", b.openings, 0, 0.8},
      {"piece", b.piece, 0.3, 3},                  {"roughness", b.roughness, 0, 0.45},
      {"parapet", b.parapet, 0, 1.5},              {"wall", b.wall, 0.15, 1},
      {"joist_depth", b.joist_depth, 0.1, 0.5},    {"joist_width", b.joist_width, 0.04, 0.3},
      {"joist_spacing", b.joist_spacing, 0.3, 2},
      {"continuity", b.continuity, 0, 1},          {"vehicle.mass", c.vehicle.mass, 0, 1e5},
      {"vehicle.speed", c.vehicle.speed, 0, 60},   {"vehicle.stiffness", c.vehicle.stiffness, 1e4, 1e7},
      {"vehicle.height", c.vehicle.height, 0.2, 3}, {"vehicle.i", double(c.vehicle.i), 0, double(b.bays_x)},
      {"vehicle.j", double(c.vehicle.j), 0, double(b.bays_y)},
      {"accelerogram_step", c.accelerogram_step, 0.001, 1},
      {"accelerogram", double(c.accelerogram.size()), 0, 200000},
      {"weakness", c.weakness, 0, 1},              {"overload", c.overload, 0, 3000},
      {"shake", c.shake, 0, 20},                   {"shake_hz", c.shake_hz, 0.2, 20},
      {"shake_seconds", c.shake_seconds, 1, 60},   {"blast", c.blast, 0, 1e6},
      {"weak_storey", double(c.weak_storey), -1, b.storeys - 1.0},
      {"overloaded_floor", double(c.overloaded_floor), -1, b.storeys - 1.0},
  };
  for (const Range& r : ranges) {
    if (r.value >= r.low && r.value <= r.high) continue;
    fail(r.key, plain_text(r.low) + (r.low < r.high ? " to " + plain_text(r.high) : ""), plain_text(r.value));
  }
}

void check_lengths(const BuildingSpec& b, const Fail& fail) {
  const auto metres = [](double x) { return brief_text(x) + " m"; };
  if (b.planned() || b.kind == BuildingKind::masonry) return;
  if (b.slab > b.beam_depth) fail("slab", "not more than beam_depth", plain_text(b.slab));
  if (b.kind == BuildingKind::bridge) {
    if (b.storey_height < b.beam_depth + 0.9 * b.column + 0.5) {
      fail("storey_height", "more than " + metres(b.beam_depth + 0.9 * b.column + 0.5) + " for girders, caps and columns",
           metres(b.storey_height));
    }
    return;
  }
  if (b.infill_thickness > b.column) fail("infill_thickness", "not more than column", plain_text(b.infill_thickness));
}

// Each names a bay that has the room.
void check_bays(const BuildingSpec& b, const Fail& fail) {
  const auto check = [&](const char* key, const std::vector<BayPlace>& bays, double x, double y) {
    if (!bays.empty() && (b.planned() || b.kind != BuildingKind::frame)) {
      fail(key, "none, in other buildings than frames", std::to_string(bays.size()));
      return;
    }
    for (std::size_t n = 0; n < bays.size(); ++n) {
      const BayPlace& bay = bays[n];
      const std::string item = std::string(key) + "[" + std::to_string(n + 1) + "]";
      if (bay.i < 0 || bay.i >= b.bays_x || bay.j < 0 || bay.j >= b.bays_y) {
        fail(item, "a bay of the building", "(" + std::to_string(bay.i) + ", " + std::to_string(bay.j) + ")");
      } else if (b.span_x - b.column < x || b.span_y - b.column < y) {
        fail(item, "a bay of " + brief_text(x) + " by " + brief_text(y) + " m between the columns",
             brief_text(b.span_x - b.column) + " by " + brief_text(b.span_y - b.column) + " m");
      }
      for (std::size_t m = 0; m < n; ++m) {
        if (bays[m].i == bay.i && bays[m].j == bay.j) fail(item, "a bay of its own", "that of another one");
      }
    }
  };
  check("stairs", b.stairs, calc_flight(b) + 0.3, 2.4);
  check("cores", b.cores, 3.2, 3.0);
  for (const BayPlace& s : b.stairs) {
    for (const BayPlace& c : b.cores) {
      if (s.i == c.i && s.j == c.j) fail("cores", "bays without stairs", "the bay of a flight of stairs");
    }
  }
  if (b.partitions != Infill::none && (b.planned() || b.kind != BuildingKind::frame)) {
    fail("partitions", "none, in other buildings than frames", "walls");
  }
}

// What causes take away must be there.
void check_places(const BuildingSpec& b, const Fail& fail) {
  const CollapseCause& c = b.cause;
  const auto check = [&](const char* key, int storey, int i, int j, const std::string& part) {
    if (!part.empty() || b.planned()) {
      const bool known = std::any_of(b.plan.parts.begin(), b.plan.parts.end(), [&](const PlanPart& p) {
        return !part.empty() && p.name == part && p.lowest <= storey && storey <= p.highest &&
               (p.kind == PlanKind::wall || p.kind == PlanKind::column);
      });
      if (!known || storey < 0 || storey >= b.storeys) {
        fail(key, "`part`, the name of a wall or column of the plan in storey " + std::to_string(storey),
             part.empty() ? "no name" : "`" + part + "`");
      }
      return;
    }
    const bool pier = b.kind != BuildingKind::bridge || (i > 0 && i < b.bays_x);
    const bool fine = storey >= 0 && storey < b.storeys && i >= 0 && i <= b.bays_x && j >= 0 && j <= b.bays_y && pier;
    if (!fine) {
      fail(key, pier ? "a column of the building" : "a column of a pier: i from 1 to bays_x - 1",
           place_name("column", storey, i, j));
    }
  };
  for (const ColumnPlace& p : c.removed) check("removed", p.storey, p.i, p.j, p.part);
  for (const SinkingFooting& f : c.sinking) {
    check("sinking", 0, f.i, f.j, f.part);
    if (!(f.depth >= 0 && f.depth <= 2)) fail("sinking", "0 to 2 m", plain_text(f.depth));
  }
  if (c.vehicle.mass > 0) check("vehicle", 0, c.vehicle.i, c.vehicle.j, c.vehicle.part);
}

void check_plan(const BuildingSpec& b, const Fail& fail) {
  if (b.plan.parts.empty() && b.plan.heights.empty()) return;
  if (b.plan.parts.empty()) return fail("plan.parts", "walls, columns, slabs", "none");
  if (b.plan.heights.empty() || b.plan.heights.size() > 12) {
    fail("plan.heights", "1 to 12 storeys", std::to_string(b.plan.heights.size()));
  }
  for (const double height : b.plan.heights) {
    if (!(height >= 2 && height <= 12)) fail("plan.heights", "2 to 12 m", plain_text(height));
  }
}

}  // namespace

void validate(const BuildingSpec& b) {
  std::vector<Diagnostic> problems;
  const Fail fail = [&](const std::string& key, const std::string& expected, const std::string& found) {
    problems.push_back({"", 0, "pile.building." + key, "out of range", expected, found, ""});
  };
  check_plan(b, fail);
  check_ranges(b, fail);
  check_lengths(b, fail);
  check_bays(b, fail);
  check_places(b, fail);
  if (!problems.empty()) throw InputError(problems);
}

}  // namespace rubble
