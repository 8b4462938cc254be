#include "scripting/scenario/part_schemas.h"

namespace rubble {
namespace {

Schema mix_material_schema(MixMaterial& m) {
  Schema k;
  k.value("material", m.material, "A name in materials.lua; it gives density, friction and look.")
      .must();
  k.value("weight", m.weight, "Relative frequency of the material.").between(0, 1e9);
  return k;
}

void add_pile(Schema& k, PileScenario& p) {
  k.group("pile", "The falling pieces and the structure.");
  k.value("pile.spawn_position", p.spawn_position,
          "Centre of the box in which pieces start; Z is up.")
      .between(-1000, 1000)
      .unit("m");
  k.value("pile.spawn_bounds", p.spawn_bounds, "Full edge lengths of the box in which pieces start.")
      .above(0, 1000)
      .unit("m");
  k.group("pile.spawn_density",
          "Horizontal distribution of the starting positions: a grid of weights, as rubble.density makes it. Not "
          "given: uniform.");
  k.value("pile.spawn_density.columns", p.spawn_density.columns, "Number of cells along X.").between(0, 256);
  k.value("pile.spawn_density.rows", p.spawn_density.rows, "Number of cells along Y.").between(0, 256);
  k.value("pile.spawn_density.weights", p.spawn_density.weights,
          "Weight of each cell, row by row from the lowest y, and in each row from the lowest x.")
      .between(0, 1e9);
  k.value("pile.layers", p.layers, "Number of layers, dropped one after another.").between(0, 1000);
  k.value("pile.pieces_per_layer", p.pieces_per_layer, "Number of pieces in each layer.").between(0, 100000);
  k.value("pile.snapshot", p.snapshot,
          "A saved moment of this pile that settling goes on from: a `.state` file of `rubble inspect`, relative to the "
          "script. Not given: from the start.");
  k.list("pile.mix", p.mix,
          "The assets that layers are drawn from; empty: every asset of the packs, by its own weight.");
  k.item("pile.mix[].asset", p.mix, &MixItem::asset, "Name of an asset.").must();
  k.item("pile.mix[].weight", p.mix, &MixItem::weight, "Relative frequency of the asset.")
      .between(0, 1e9);
  k.item("pile.mix[].scale", p.mix, &MixItem::scale,
         "Size, between {min, max}; not given: the range and distribution of the asset.")
      .between(0.01, 100);
  k.add("pile.mix[].spread",
        "Distribution of sizes, truncated to `scale`.",
        [&p](std::size_t i) {
          return Schema::choice_slot(p.mix[i].spread.kind, {"uniform", "normal", "lognormal"});
        });
  k.add("pile.mix[].typical", "Mean of the normal distribution, median of the lognormal one.",
        [&p](std::size_t i) { return Slot(&p.mix[i].spread.typical); })
      .above(0, 100);
  k.add("pile.mix[].deviation",
        "Standard deviation of the size (normal) or of its natural logarithm (lognormal).",
        [&p](std::size_t i) { return Slot(&p.mix[i].spread.deviation); })
      .above(0, 10);
  k.add("pile.mix[].materials",
        "Materials, drawn for every piece by their weights; empty: that of the pack.", [&p](std::size_t i) {
          return Schema::table_list(p.mix[i].materials, mix_material_schema);
        });
  k.list("pile.placed", p.placed, "Single pieces that are placed before the first layer falls.");
  k.item("pile.placed[].asset", p.placed, &PlacedItem::asset, "Name of an asset.");
  k.item("pile.placed[].box", p.placed, &PlacedItem::box,
         "Instead of an asset: full edge lengths of a box. Its origin is at its centre.")
      .between(0.02, 100)
      .unit("m");
  k.item("pile.placed[].material", p.placed, &PlacedItem::material,
         "Material of a box: a name in materials.lua.");
  k.item("pile.placed[].broken", p.placed, &PlacedItem::broken,
         "Faces of a box that look broken off, such as {\"+x\", \"-y\"}.");
  k.item("pile.placed[].position", p.placed, &PlacedItem::position,
         "Position of the origin of the asset or box in the world.")
      .between(-1000, 1000)
      .unit("m");
  k.item("pile.placed[].rpy_deg", p.placed, &PlacedItem::rpy_deg,
         "Roll, pitch and yaw: Rz(yaw) Ry(pitch) Rx(roll).")
      .between(-360, 360)
      .unit("degree");
  k.item("pile.placed[].scale", p.placed, &PlacedItem::scale, "Size of the piece relative to the asset.").between(0.01, 100);
  k.item("pile.placed[].fixed", p.placed, &PlacedItem::fixed,
         "true: immovable, like a wall; false: it settles with the other pieces.");
  k.item("pile.placed[].built_in", p.placed, &PlacedItem::built_in,
         "The fixed piece reaches into other fixed pieces on purpose, like a slab into its wall: no warning says so.");
}

void add_terrain(Schema& k, TerrainScenario& t) {
  k.group("pile.terrain",
          "Fixed terrain on the ground z = 0: heights on a grid, as rubble.terrain makes them, or a mesh.");
  k.value("pile.terrain.columns", t.columns, "Number of grid points along X.").between(0, 1024);
  k.value("pile.terrain.rows", t.rows, "Number of grid points along Y.").between(0, 1024);
  k.value("pile.terrain.spacing", t.spacing, "Distance of neighbouring grid points.").between(0.01, 100).unit("m");
  k.value("pile.terrain.heights", t.heights,
          "Height of each grid point above `position`, row by row from the lowest y, and in each row from "
          "the lowest x.")
      .between(-1000, 1000)
      .unit("m");
  k.value("pile.terrain.file", t.file,
          "Instead of a grid: a mesh in any common format, relative to the script. Pieces lie on the front side of "
          "its triangles.");
  k.value("pile.terrain.metres_per_unit", t.metres_per_unit, "Length unit of the file, in metres.").above(0, 1000);
  k.choice("pile.terrain.up", t.up, {"y", "z"}, "The axis of the file that points up.");
  k.value("pile.terrain.position", t.position,
          "Position of the centre of the grid, or of the origin of the mesh.")
      .between(-1000, 1000)
      .unit("m");
  k.value("pile.terrain.friction", t.friction, "Coulomb coefficient against concrete.").between(0, 2);
  k.value("pile.terrain.look", t.look,
          "Look of the grid, and of mesh surfaces whose name is not a look. Empty: the colours of the file, "
          "otherwise `ground`.");
}

void add_building(Schema& k, BuildingSpec& b) {
  k.group("pile.building",
          "A building, centred at the origin on the ground z = 0, that collapses before the first layer falls. "
          "Terrain may lie beside it, not in it. "
          "rubble.building makes a pile of it.");
  k.choice("pile.building.kind", b.kind, {"frame", "masonry", "precast", "bridge"},
           "`frame`: columns, beams and slabs of reinforced concrete, cast in place. `masonry`: walls on all grid "
           "lines, timber floors. `precast`: beams on corbels, hollow floor units. `bridge`: girders along X on "
           "piers and abutments.");
  k.value("pile.building.storeys", b.storeys, "Number of storeys; 0: no building.").between(0, 12);
  k.value("pile.building.bays_x", b.bays_x, "Number of bays along X.").between(1, 8);
  k.value("pile.building.bays_y", b.bays_y, "Number of bays along Y.").between(1, 8);
  k.value("pile.building.span_x", b.span_x, "Distance of column axes along X; above 12 m for bridges only.").between(2, 40).unit("m");
  k.value("pile.building.span_y", b.span_y, "Distance of column axes along Y; of a bridge: of its girders.").between(2, 12).unit("m");
  k.value("pile.building.storey_height", b.storey_height, "Distance from floor to floor; of a bridge: height of its deck.").between(2.2, 12).unit("m");
  k.value("pile.building.column", b.column, "Edge length of the columns' section; beams have the same width, girders half of it.").between(0.15, 2).unit("m");
  k.value("pile.building.beam_depth", b.beam_depth, "Depth of the beams, including the slab.").between(0.15, 3).unit("m");
  k.value("pile.building.slab", b.slab, "Thickness of the slabs.").between(0.1, 0.5).unit("m");
  k.value("pile.building.column_bars", b.column_bars, "Reinforcement of columns, as a share of the section.").between(0, 0.06);
  k.value("pile.building.beam_bars", b.beam_bars, "Reinforcement of beams, as a share of the section.").between(0, 0.06);
  k.value("pile.building.slab_bars", b.slab_bars, "Reinforcement of slabs, as a share of the section.").between(0, 0.06);
  k.value("pile.building.continuity", b.continuity,
          "Share of the bars that hold pieces together after the concrete has failed, until the bars tear.")
      .between(0, 1);
  k.choice("pile.building.infill", b.infill, {"none", "brick", "block"},
           "Material of the walls between the outer columns, or of masonry (none: brick).");
  k.value("pile.building.infill_thickness", b.infill_thickness, "Thickness of the infill.").between(0.08, 0.5).unit("m");
  k.value("pile.building.openings", b.openings, "Share of windows in the length of each wall.").between(0, 0.8);
  k.value("pile.building.piece", b.piece, "Approximate length of the pieces that members break into.")
      .between(0.3, 3)
      .unit("m");
  k.value("pile.building.roughness", b.roughness,
          "How irregular the cuts between pieces are; 0: a regular grid.").between(0, 0.45);
  k.choice("pile.building.partitions", b.partitions, {"none", "brick", "block"},
           "Material of partition walls with doors between the inner columns of a frame.");
  k.value("pile.building.parapet", b.parapet, "Height of parapets; 0: none.").between(0, 1.5).unit("m");
  const auto bays = [&k](const std::string& key, std::vector<BayPlace>& member, const std::string& doc) {
    k.list("pile.building." + key, member, doc);
    k.item("pile.building." + key + "[].i", member, &BayPlace::i, "Number of the bay along X, from 0 at the lowest x.").between(0, 7);
    k.item("pile.building." + key + "[].j", member, &BayPlace::j, "Number of the bay along Y, from 0 at the lowest y.").between(0, 7);
  };
  bays("stairs", b.stairs, "Bays of a frame with a flight of stairs from floor to floor, and openings in the slabs.");
  bays("cores", b.cores, "Bays of a frame with a lift shaft of reinforced walls.");
  k.value("pile.building.wall", b.wall, "Thickness of masonry walls that carry floors.").between(0.15, 1).unit("m");
  k.value("pile.building.joist_depth", b.joist_depth, "Depth of the joists of timber floors.").between(0.1, 0.5).unit("m");
  k.value("pile.building.joist_width", b.joist_width, "Width of the joists.").between(0.04, 0.3).unit("m");
  k.value("pile.building.joist_spacing", b.joist_spacing, "Largest distance of the axes of the joists.").between(0.3, 2).unit("m");
}

void add_plan(Schema& k, BuildingPlan& plan) {
  k.group("pile.building.plan",
          "A building of your own instead of a kind, as rubble.read_plan reads it from a file (docs/explanation/collapse.md).");
  k.value("pile.building.plan.heights", plan.heights, "Heights of the storeys from floor to floor, from the ground.")
      .between(2, 12)
      .unit("m");
  k.list("pile.building.plan.parts", plan.parts, "Parts of the plan. Where two walls meet, the first one is "
                                                 "continuous.");
  const auto item = [&](const std::string& key, auto PlanPart::*member, const std::string& doc) -> Key& {
    return k.item("pile.building.plan.parts[]." + key, plan.parts, member, doc);
  };
  k.add("pile.building.plan.parts[].kind", "Kind of part. A door is a window with `bottom = 0`.",
        [&plan](std::size_t i) {
          return Schema::choice_slot(plan.parts[i].kind, {"wall", "column", "beam", "slab", "joists", "window", "hole"});
        })
      .must();
  item("name", &PlanPart::name, "Name for errors and causes.");
  item("lowest", &PlanPart::lowest, "Lowest storey with this part, from 0.").between(0, 11);
  item("highest", &PlanPart::highest, "Highest storey with this part.").between(0, 11);
  item("x1", &PlanPart::x1, "First end of its line, or corner of its rectangle, along X.").between(-500, 500).unit("m");
  item("y1", &PlanPart::y1, "The same along Y.").between(-500, 500).unit("m");
  item("x2", &PlanPart::x2, "Second end of its line, or opposite corner, along X.").between(-500, 500).unit("m");
  item("y2", &PlanPart::y2, "The same along Y.").between(-500, 500).unit("m");
  item("thickness", &PlanPart::thickness, "Thickness of a wall or slab, width of a beam, depth of joists.").between(0.02, 3).unit("m");
  item("depth", &PlanPart::depth, "Depth of a beam, below the ceiling.").between(0.05, 3).unit("m");
  item("bottom", &PlanPart::bottom, "Lower edge of a window or wall above the floor.").between(0, 12).unit("m");
  item("top", &PlanPart::top, "Upper edge; 0: at the ceiling.").between(0, 12).unit("m");
  k.add("pile.building.plan.parts[].material", "Material of the part.", [&plan](std::size_t i) {
    return Schema::choice_slot(plan.parts[i].material, {"concrete", "brick", "block", "timber"});
  });
  item("bars", &PlanPart::bars, "Reinforcement as a share of the section; below 0: as in a frame.").between(-1, 0.06);
}

void add_furniture(Schema& k, std::vector<FurnitureItem>& items) {
  k.list("pile.building.furniture", items,
         "Objects on the floors before the collapse: furniture, appliances, or the cars of a car park.");
  k.item("pile.building.furniture[].asset", items, &FurnitureItem::asset, "Name of an asset.").must();
  k.item("pile.building.furniture[].per_bay", items, &FurnitureItem::per_bay,
         "Mean number in each bay of each floor. Objects without room are left out.")
      .between(0, 20);
  k.item("pile.building.furniture[].roof", items, &FurnitureItem::roof, "Also on the roof.");
}

void add_vehicle(Schema& k, StrikingVehicle& v) {
  k.group("pile.building.cause.vehicle",
          "A vehicle that hits a column of the ground storey; `mass = 0`: none.");
  k.value("pile.building.cause.vehicle.mass", v.mass, "Mass of the vehicle.").between(0, 100000).unit("kg");
  k.value("pile.building.cause.vehicle.speed", v.speed, "Speed at the impact.").between(0, 60).unit("m/s");
  k.value("pile.building.cause.vehicle.direction_deg", v.direction_deg,
          "Direction of driving, from X towards Y.")
      .between(-360, 360)
      .unit("degree");
  k.value("pile.building.cause.vehicle.stiffness", v.stiffness, "Stiffness of the front.").between(1e4, 1e7).unit("N/m");
  k.value("pile.building.cause.vehicle.height", v.height, "Height of the bumper.").between(0.2, 3).unit("m");
  k.value("pile.building.cause.vehicle.i", v.i, "Number of the column along X, from 0 at the lowest x.").between(0, 8);
  k.value("pile.building.cause.vehicle.j", v.j, "Number of the column along Y, from 0 at the lowest y.").between(0, 8);
  k.value("pile.building.cause.vehicle.part", v.part, "Of a plan: name of the wall or column, instead of i and j.");
}

void add_cause(Schema& k, CollapseCause& c) {
  k.group("pile.building.cause", "The cause of the collapse. Without a cause, the building stands.");
  k.list("pile.building.cause.removed", c.removed, "Columns that are removed at once.");
  k.item("pile.building.cause.removed[].storey", c.removed, &ColumnPlace::storey,
          "Storey of the column, from 0 at the ground.")
      .between(0, 11);
  k.item("pile.building.cause.removed[].i", c.removed, &ColumnPlace::i,
          "Number of the column along X, from 0 at the lowest x.")
      .between(0, 8);
  k.item("pile.building.cause.removed[].j", c.removed, &ColumnPlace::j,
          "Number of the column along Y, from 0 at the lowest y.")
      .between(0, 8);
  k.item("pile.building.cause.removed[].part", c.removed, &ColumnPlace::part,
         "Of a plan: name of the wall or column, instead of i and j.");
  k.value("pile.building.cause.weak_storey", c.weak_storey, "Soft storey: no infill, and weak columns or "
                                                            "load-bearing walls; -1: none.").between(-1, 11);
  k.value("pile.building.cause.weakness", c.weakness, "Remaining share of strength in the soft storey.")
      .between(0, 1);
  k.value("pile.building.cause.overloaded_floor", c.overloaded_floor,
          "Floor with an additional load; 0: the slab above the ground storey; -1: none.")
      .between(-1, 11);
  k.value("pile.building.cause.overload", c.overload,
          "Additional load of `overloaded_floor`. Its pieces carry it as their own mass, so thin boards take less.")
      .between(0, 3000)
      .unit("kg/m2");
  k.value("pile.building.cause.shake", c.shake, "Peak ground acceleration.").between(0, 20).unit("m/s2");
  k.value("pile.building.cause.shake_hz", c.shake_hz, "Centre of the frequency range of the motion.").between(0.2, 20).unit("Hz");
  k.value("pile.building.cause.shake_seconds", c.shake_seconds, "Duration of the motion.").between(1, 60).unit("s");
  k.value("pile.building.cause.shake_direction_deg", c.shake_direction_deg,
          "Direction of the motion, from X towards Y.")
      .between(-360, 360)
      .unit("degree");
  k.value("pile.building.cause.accelerogram", c.accelerogram,
          "Instead of a synthetic motion: accelerations at equal time steps, scaled to a peak of `shake`.")
      .between(-1e6, 1e6);
  k.value("pile.building.cause.accelerogram_step", c.accelerogram_step,
          "Time step of `accelerogram`.")
      .between(0.001, 1)
      .unit("s");
  k.value("pile.building.cause.blast", c.blast,
          "Impulse per area at a distance of 1 m; it decreases with the square of the distance.")
      .between(0, 1e6)
      .unit("N s/m2");
  k.value("pile.building.cause.blast_at", c.blast_at, "Position of the blast.").between(-1000, 1000).unit("m");
  add_vehicle(k, c.vehicle);
  k.list("pile.building.cause.sinking", c.sinking,
         "Footings of ground columns that sink into the ground within 2 s. What stands on them alone goes down with them; "
         "what the rest of the building holds up stays.");
  k.item("pile.building.cause.sinking[].i", c.sinking, &SinkingFooting::i,
          "Number of the column along X, from 0 at the lowest x.")
      .between(0, 8);
  k.item("pile.building.cause.sinking[].j", c.sinking, &SinkingFooting::j,
          "Number of the column along Y, from 0 at the lowest y.")
      .between(0, 8);
  k.item("pile.building.cause.sinking[].part", c.sinking, &SinkingFooting::part,
         "Of a plan: name of the wall or column, instead of i and j.");
  k.item("pile.building.cause.sinking[].depth", c.sinking, &SinkingFooting::depth, "Depth of the sinking; 0: none.")
      .between(0, 2)
      .unit("m");
}

}  // namespace

void add_victim_keys(Schema& k, VictimScenario& v) {
  k.group("victims",
          "Victims in the voids of the settled pile, as rigid figures (docs/explanation/search.md).");
  k.value("victims.count", v.count, "Number of victims.").between(0, 50);
  k.choice("victims.difficulty", v.difficulty, {"easy", "medium", "hard"},
           "Distance from the entrances: nearest, middle or farthest third of the possible places.");
  k.value("victims.radius", v.radius, "Radius of a robot that can reach and see each victim.")
      .between(0.05, 1)
      .unit("m");
}

void add_fine_keys(Schema& k, FinesSpec& f) {
  k.group("fines",
          "Fines on the settled pile, as true geometry: grit, plaster, glass, paper, cloth, drifts of dust, hanging "
          "cables and pipes (docs/explanation/fines.md).");
  k.value("fines.amount", f.amount, "Number of loose pieces; 0: no fines of any kind.").between(0, 1000000);
  k.value("fines.grit", f.grit, "Share of grit: broken concrete, brick, block or wood, like the pieces near it.")
      .between(0, 1000);
  k.value("fines.plaster", f.plaster, "Share of flakes of plaster, 8 to 110 mm long.").between(0, 1000);
  k.value("fines.glass", f.glass, "Share of shards of glass, 4 to 80 mm long.").between(0, 1000);
  k.value("fines.paper", f.paper, "Share of sheets of paper, A4 and smaller, whole or torn.").between(0, 1000);
  k.value("fines.cloth", f.cloth, "Share of pieces of cloth, 0.24 to 0.76 m long.").between(0, 1000);
  k.value("fines.size", f.size, "Longest side of grit: {smallest, largest}.").between(0.002, 0.2).unit("m");
  k.value("fines.exponent", f.exponent,
          "Exponent n of the size distribution of grit: the number of pieces longer than d is proportional to d^-n.")
      .between(1, 4);
  k.value("fines.drifts", f.drifts, "Number of drifts of dust, most of them at the foot of walls.").between(0, 2000);
  k.value("fines.cables", f.cables, "Number of hanging cables.").between(0, 500);
  k.value("fines.pipes", f.pipes, "Number of hanging pipes.").between(0, 500);
}

void check_fines(const FinesSpec& f, std::vector<Diagnostic>& mistakes) {
  if (f.amount > 0 && f.grit + f.plaster + f.glass + f.paper + f.cloth <= 0)
    mistakes.push_back({"", 0, "fines.grit", "no kind of loose piece has a share",
                        "a share above 0 of grit, plaster, glass, paper or cloth", "0 of each",
                        "with fines.amount = 0 there are no fines"});
}

void add_pile_keys(Schema& keys, PileScenario& pile) {
  add_pile(keys, pile);
  add_terrain(keys, pile.terrain);
  add_building(keys, pile.building);
  add_plan(keys, pile.building.plan);
  add_furniture(keys, pile.furniture);
  add_cause(keys, pile.building.cause);
}

}  // namespace rubble
