// What a frame may have beside columns, beams, slabs and outer walls: partition walls, parapets, stairs, lift
// shafts.
#include <algorithm>
#include <cmath>

#include "kernel/structure/buildings/parts.h"

namespace rubble {
namespace {

constexpr double kPartition = 0.12;     // thickness of partition walls; unit: m
constexpr double kParapet = 0.15;       // thickness of parapets; unit: m
constexpr double kMostRise = 0.19;      // of a step; unit: m
constexpr double kGoing = 0.26;         // of a step; unit: m
constexpr double kFlightWidth = 1.1;    // clear width of stairs; unit: m
constexpr double kFlightClear = 0.05;   // beside it; unit: m
constexpr double kHeadroom = 2.0;       // below the edge of an opening for stairs; unit: m
constexpr double kStairBars = 0.008;    // share of the section; unit: 1
constexpr double kShaft = 0.2;          // thickness of the walls of a shaft; unit: m
constexpr double kShaftLength = 2.4;    // outside, along X; unit: m
constexpr double kShaftWidth = 2.2;     // outside, along Y; unit: m
constexpr double kShaftApart = 0.4;     // from the beams; unit: m
constexpr double kShaftBars = 0.008;    // share of the section; unit: 1

const StructuralMaterial& concrete() { return find_structural_material("concrete", "building.material"); }

BuildingPart make_part(const std::string& name, MemberKind kind, const Aabb& box, const StructuralMaterial& material,
                       int storey, int rank) {
  BuildingPart part;
  part.member.name = name;
  part.member.kind = kind;
  part.member.material = material;
  part.member.place.storey = storey;
  part.rank = rank;
  set_box(part.member, box);
  return part;
}

int count_risers(const BuildingSpec& b) { return int(std::ceil(b.storey_height / kMostRise - 1e-9)); }

}  // namespace

double calc_flight(const BuildingSpec& b) { return count_risers(b) * kGoing; }

void add_partitions(const BuildingSpec& b, std::vector<BuildingPart>& parts) {
  if (b.partitions == Infill::none) return;
  const auto add = [&](int k, int i, int j, bool along_x) {
    const double from = (along_x ? x_of(b, i) : y_of(b, j)) + b.column / 2;
    const double to = (along_x ? x_of(b, i + 1) : y_of(b, j + 1)) - b.column / 2;
    const double across = along_x ? y_of(b, j) : x_of(b, i), half = kPartition / 2;
    const double low = k * b.storey_height, high = low + b.storey_height - b.beam_depth;
    const auto box = [&](double u, double v, double z0, double z1) {
      return along_x ? Aabb{{u, across - half, z0}, {v, across + half, z1}}
                     : Aabb{{across - half, u, z0}, {across + half, v, z1}};
    };
    BuildingPart wall = make_part(place_name(along_x ? "partition along X" : "partition along Y", k, i, j),
                                  MemberKind::wall, box(from, to, low, high), material_of(b.partitions), k, kWallRank);
    const double middle = (from + to) / 2;
    wall.holes = {box(middle - kDoorWidth / 2, middle + kDoorWidth / 2, low, std::min(high, low + kDoorHeight))};
    wall.member.stiffness = kInfillStiffness;
    wall.member.place.infill = true;
    parts.push_back(wall);
  };
  for (int k = 0; k < b.storeys; ++k) {
    for (int j = 1; j < b.bays_y; ++j) {
      for (int i = 0; i < b.bays_x; ++i) add(k, i, j, true);
    }
    for (int j = 0; j < b.bays_y; ++j) {
      for (int i = 1; i < b.bays_x; ++i) add(k, i, j, false);
    }
  }
}

void add_parapet(const BuildingSpec& b, double width, std::vector<BuildingPart>& parts) {
  if (!(b.parapet > 0)) return;
  const double low = b.storeys * b.storey_height, high = low + b.parapet;
  const double half = width / 2, x0 = x_of(b, 0), x1 = x_of(b, b.bays_x), y0 = y_of(b, 0), y1 = y_of(b, b.bays_y);
  const bool brick = b.infill != Infill::none;
  const StructuralMaterial& material = brick ? material_of(b.infill) : concrete();
  const auto add = [&](const char* name, const Aabb& box) {
    BuildingPart part = make_part(name, MemberKind::wall, box, material, b.storeys, kWallRank);
    if (!brick) part.member.bars = make_bars(0.003, kDowels, 0.04);
    part.member.stiffness = kInfillStiffness;  // it has joints
    parts.push_back(part);
  };
  for (const bool lower : {true, false}) {
    const double y = lower ? y0 - half : y1 + half - kParapet, x = lower ? x0 - half : x1 + half - kParapet;
    add("parapet along X", {{x0 - half, y, low}, {x1 + half, y + kParapet, high}});
    add("parapet along Y", {{x, y0 - half + kParapet, low}, {x + kParapet, y1 + half - kParapet, high}});
  }
}

// A straight flight in every storey but the last, of steps that are cast in one. It starts on the floor
// below its opening and ends at the edge of the opening.
void add_stairs(const BuildingSpec& b, const BayPlace& bay, std::vector<BuildingPart>& parts,
                std::vector<Aabb>& openings) {
  const int risers = count_risers(b);
  const double rise = b.storey_height / risers, length = calc_flight(b);
  const double x0 = x_of(b, bay.i) + b.column / 2, x1 = x_of(b, bay.i + 1) - b.column / 2;
  const double end = x1 - (x1 - x0 - length) / 2, start = end - length;
  const double y1 = y_of(b, bay.j + 1) - b.column / 2, y0 = y1 - kFlightWidth - 2 * kFlightClear;
  // Steps that are lower than this have headroom below the slab.
  const int under = std::max(2, int(std::floor((b.storey_height - b.slab - kHeadroom) / rise)));
  for (int k = 0; k + 1 < b.storeys; ++k) {
    const double floor = k * b.storey_height, top = floor + b.storey_height;
    openings.push_back({{start + under * kGoing, y0, top - b.slab - 0.01}, {end, y1, top + 0.01}});
    for (int m = 1; m <= risers; ++m) {
      const Aabb box{{start + (m - 1) * kGoing, y0 + kFlightClear, floor + std::max(0, m - 2) * rise},
                     {start + m * kGoing, y1 - kFlightClear, floor + m * rise}};
      BuildingPart step = make_part(place_name("stairs", k, bay.i, bay.j), MemberKind::beam, box, concrete(), k, kBeamRank);
      step.member.bars = make_bars(kStairBars, kDowels, 0.04);
      parts.push_back(step);
    }
  }
}

// Four walls with a door in every storey, closed above the roof.
void add_core(const BuildingSpec& b, const BayPlace& bay, std::vector<BuildingPart>& parts,
              std::vector<Aabb>& openings) {
  const double x0 = x_of(b, bay.i) + b.column / 2 + kShaftApart, y0 = y_of(b, bay.j) + b.column / 2 + kShaftApart;
  const double x1 = x0 + kShaftLength, y1 = y0 + kShaftWidth, t = kShaft, roof = b.storeys * b.storey_height;
  openings.push_back({{x0, y0, 0}, {x1, y1, roof + 0.01}});
  for (int k = 0; k < b.storeys; ++k) {
    const double low = k * b.storey_height, high = low + b.storey_height;
    const auto add = [&](const Aabb& box) -> BuildingPart& {
      BuildingPart wall = make_part(place_name("shaft", k, bay.i, bay.j), MemberKind::wall, box, concrete(), k, kWallRank);
      wall.member.bars = make_bars(kShaftBars, kDowels, 0.04);
      parts.push_back(wall);
      return parts.back();
    };
    add({{x0, y0, low}, {x0 + t, y1, high}});
    const double middle = (y0 + y1) / 2;
    add({{x1 - t, y0, low}, {x1, y1, high}}).holes = {
        {{x1 - t, middle - kDoorWidth / 2, low}, {x1, middle + kDoorWidth / 2, low + kDoorHeight}}};
    add({{x0 + t, y0, low}, {x1 - t, y0 + t, high}});
    add({{x0 + t, y1 - t, low}, {x1 - t, y1, high}});
  }
  BuildingPart lid = make_part(place_name("roof of the shaft", b.storeys - 1, bay.i, bay.j), MemberKind::slab,
                               {{x0 + t, y0 + t, roof - b.slab}, {x1 - t, y1 - t, roof}}, concrete(), b.storeys - 1, kSlabRank);
  lid.member.bars = make_bars(b.slab_bars, kDowels, 0.03);
  parts.push_back(lid);
}

}  // namespace rubble
