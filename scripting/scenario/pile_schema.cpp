#include "scripting/scenario/pile_schema.h"

namespace rubble {
namespace {

Schema mix_material_schema(MixMaterial& m) {
  Schema k;
  k.value("material", m.material, "A name in materials.lua; it gives density, friction and look.")
      .must();
  k.value("weight", m.weight, "How often, relative to the others.").between(0, 1e9);
  return k;
}

void add_pile(Schema& k, PileScenario& p) {
  k.group("pile", "What is dropped, and where.");
  k.value("pile.spawn_position", p.spawn_position,
          "Centre of the box that a layer's pieces are drawn in; Z is up.")
      .between(-1000, 1000)
      .unit("m");
  k.value("pile.spawn_bounds", p.spawn_bounds, "Full edge lengths of that box.")
      .above(0, 1000)
      .unit("m");
  k.group("pile.spawn_density",
          "Where above the box's footprint pieces are drawn: a grid of weights, as rubble.density "
          "makes it; none: evenly.");
  k.value("pile.spawn_density.columns", p.spawn_density.columns, "Cells along X.").between(0, 256);
  k.value("pile.spawn_density.rows", p.spawn_density.rows, "Cells along Y.").between(0, 256);
  k.value("pile.spawn_density.weights", p.spawn_density.weights,
          "Of each cell, row by row from the lowest y, each from the lowest x.")
      .between(0, 1e9);
  k.value("pile.layers", p.layers, "Layers, dropped one after another.").between(0, 1000);
  k.value("pile.pieces_per_layer", p.pieces_per_layer, "Pieces in each layer.").between(0, 100000);
  k.list("pile.mix", p.mix, "What is dropped; none: every asset of the packs, by its own weight.");
  k.item("pile.mix[].asset", p.mix, &MixItem::asset, "Name of an asset.").must();
  k.item("pile.mix[].weight", p.mix, &MixItem::weight, "How often, relative to the others.")
      .between(0, 1e9);
  k.item("pile.mix[].scale", p.mix, &MixItem::scale,
         "Size, between {min, max}; not given: the asset's own range and spread.")
      .between(0.01, 100);
  k.add("pile.mix[].spread",
        "How sizes lie in `scale`: evenly, or about `typical`, cut off at the ends.",
        [&p](std::size_t i) {
          return Schema::choice_slot(p.mix[i].spread.kind, {"uniform", "normal", "lognormal"});
        });
  k.add("pile.mix[].typical", "Mean of the normal, median of the lognormal spread.",
        [&p](std::size_t i) { return Slot(&p.mix[i].spread.typical); })
      .above(0, 100);
  k.add("pile.mix[].deviation",
        "Standard deviation of the size (normal) or of its natural logarithm (lognormal).",
        [&p](std::size_t i) { return Slot(&p.mix[i].spread.deviation); })
      .above(0, 10);
  k.add("pile.mix[].materials",
        "Drawn for every piece, by their weights; none: what the pack says.", [&p](std::size_t i) {
          return Schema::table_list(p.mix[i].materials, mix_material_schema);
        });
  k.list("pile.placed", p.placed, "Pieces that stand or lie there before the first layer.");
  k.item("pile.placed[].asset", p.placed, &PlacedItem::asset, "Name of an asset.");
  k.item("pile.placed[].box", p.placed, &PlacedItem::box,
         "Instead of an asset: full edge lengths of a box about its middle.")
      .between(0.02, 100)
      .unit("m");
  k.item("pile.placed[].material", p.placed, &PlacedItem::material,
         "Of a box: a name in materials.lua.");
  k.item("pile.placed[].broken", p.placed, &PlacedItem::broken,
         "Of a box: the faces that look broken off, such as {\"+x\", \"-y\"}.");
  k.item("pile.placed[].position", p.placed, &PlacedItem::position,
         "Where the origin of the asset or box is, in the world.")
      .between(-1000, 1000)
      .unit("m");
  k.item("pile.placed[].rpy_deg", p.placed, &PlacedItem::rpy_deg,
         "Roll, pitch and yaw: Rz(yaw) Ry(pitch) Rx(roll).")
      .between(-360, 360)
      .unit("degree");
  k.item("pile.placed[].scale", p.placed, &PlacedItem::scale, "Size.").between(0.01, 100);
  k.item("pile.placed[].fixed", p.placed, &PlacedItem::fixed,
         "Immovable, as a wall; false: it settles with the rest.");
}

void add_terrain(Schema& k, TerrainScenario& t) {
  k.group("pile.terrain",
          "What pieces lie on besides the ground z = 0, fixed: heights on a grid, as rubble.terrain "
          "makes them, or a mesh; neither: the ground alone.");
  k.value("pile.terrain.columns", t.columns, "Corners of the grid along X.").between(0, 1024);
  k.value("pile.terrain.rows", t.rows, "Corners of the grid along Y.").between(0, 1024);
  k.value("pile.terrain.spacing", t.spacing, "Of neighbouring corners.").between(0.01, 100).unit("m");
  k.value("pile.terrain.heights", t.heights,
          "Of each corner above `position`, row by row from the lowest y, each from the lowest x.")
      .between(-1000, 1000)
      .unit("m");
  k.value("pile.terrain.file", t.file,
          "Instead of a grid: a mesh in any usual format, relative to the script; pieces lie on the "
          "side that its triangles face.");
  k.value("pile.terrain.metres_per_unit", t.metres_per_unit, "Of the file.").above(0, 1000);
  k.choice("pile.terrain.up", t.up, {"y", "z"}, "Of the file.");
  k.value("pile.terrain.position", t.position, "Of the grid's middle, or of the mesh's origin.")
      .between(-1000, 1000)
      .unit("m");
  k.value("pile.terrain.friction", t.friction, "Coulomb, against concrete.").between(0, 2);
  k.value("pile.terrain.look", t.look,
          "Of the grid, and of surfaces of the mesh that are no look themselves.");
}

void add_building(Schema& k, BuildingSpec& b) {
  k.group("pile.building",
          "A frame of reinforced concrete that collapses before the first layer falls: about the origin, "
          "on the ground z = 0. rubble.building makes a pile of it.");
  k.value("pile.building.storeys", b.storeys, "0: there is no building.").between(0, 12);
  k.value("pile.building.bays_x", b.bays_x, "Bays along X.").between(1, 8);
  k.value("pile.building.bays_y", b.bays_y, "Bays along Y.").between(1, 8);
  k.value("pile.building.span_x", b.span_x, "Between column axes along X.").between(2, 12).unit("m");
  k.value("pile.building.span_y", b.span_y, "Between column axes along Y.").between(2, 12).unit("m");
  k.value("pile.building.storey_height", b.storey_height, "Floor to floor.").between(2.2, 6).unit("m");
  k.value("pile.building.column", b.column, "Edge of the columns; beams are as wide.").between(0.15, 1.2).unit("m");
  k.value("pile.building.beam_depth", b.beam_depth, "With the slab.").between(0.15, 1.5).unit("m");
  k.value("pile.building.slab", b.slab, "Thickness.").between(0.1, 0.5).unit("m");
  k.value("pile.building.column_bars", b.column_bars, "Steel, as a share of the section.").between(0, 0.06);
  k.value("pile.building.beam_bars", b.beam_bars, "Steel, as a share of the section.").between(0, 0.06);
  k.value("pile.building.slab_bars", b.slab_bars, "Steel, as a share of the section.").between(0, 0.06);
  k.value("pile.building.continuity", b.continuity,
          "Share of the bars that hold pieces together when the concrete between them has failed, until "
          "they tear; 0: what breaks falls.")
      .between(0, 1);
  k.choice("pile.building.infill", b.infill, {"none", "brick", "block"},
           "Walls between the outer columns.");
  k.value("pile.building.infill_thickness", b.infill_thickness, "Of these walls.").between(0.08, 0.5).unit("m");
  k.value("pile.building.openings", b.openings, "Of each wall's length, what is a window.").between(0, 0.8);
  k.value("pile.building.piece", b.piece, "Pieces that members break into are about this long.")
      .between(0.3, 3)
      .unit("m");
  k.value("pile.building.roughness", b.roughness, "How far cuts leave a regular grid.").between(0, 0.45);
}

void add_vehicle(Schema& k, StrikingVehicle& v) {
  k.group("pile.building.cause.vehicle", "Drives into a column of the ground storey; mass 0: there is none.");
  k.value("pile.building.cause.vehicle.mass", v.mass, "Of the vehicle.").between(0, 100000).unit("kg");
  k.value("pile.building.cause.vehicle.speed", v.speed, "At the impact.").between(0, 60).unit("m/s");
  k.value("pile.building.cause.vehicle.direction_deg", v.direction_deg, "In which it drives, from X towards Y.")
      .between(-360, 360)
      .unit("degree");
  k.value("pile.building.cause.vehicle.stiffness", v.stiffness, "Of its front.").between(1e4, 1e7).unit("N/m");
  k.value("pile.building.cause.vehicle.height", v.height, "Of its bumper.").between(0.2, 3).unit("m");
  k.value("pile.building.cause.vehicle.i", v.i, "The column, along X, from 0 at the lowest x.").between(0, 8);
  k.value("pile.building.cause.vehicle.j", v.j, "The column, along Y, from 0 at the lowest y.").between(0, 8);
}

void add_cause(Schema& k, CollapseCause& c) {
  k.group("pile.building.cause", "Why it collapses; none: it stands.");
  k.list("pile.building.cause.removed", c.removed, "Columns that are gone at once.");
  k.item("pile.building.cause.removed[].storey", c.removed, &ColumnPlace::storey, "From 0 at the ground.")
      .between(0, 11);
  k.item("pile.building.cause.removed[].i", c.removed, &ColumnPlace::i, "Along X, from 0 at the lowest x.")
      .between(0, 8);
  k.item("pile.building.cause.removed[].j", c.removed, &ColumnPlace::j, "Along Y, from 0 at the lowest y.")
      .between(0, 8);
  k.value("pile.building.cause.weak_storey", c.weak_storey, "Whose columns are weak; -1: none.").between(-1, 11);
  k.value("pile.building.cause.weakness", c.weakness, "Share of their strength that these columns keep.")
      .between(0, 1);
  k.value("pile.building.cause.overloaded_floor", c.overloaded_floor,
          "Floor 0 is the slab above the ground storey; -1: none.")
      .between(-1, 11);
  k.value("pile.building.cause.overload", c.overload, "What this floor carries more.").between(0, 3000).unit("kg/m2");
  k.value("pile.building.cause.shake", c.shake, "Largest acceleration of the ground.").between(0, 20).unit("m/s2");
  k.value("pile.building.cause.shake_hz", c.shake_hz, "About which its frequencies lie.").between(0.2, 20).unit("Hz");
  k.value("pile.building.cause.shake_seconds", c.shake_seconds, "How long it shakes.").between(1, 60).unit("s");
  k.value("pile.building.cause.shake_direction_deg", c.shake_direction_deg, "From X towards Y.")
      .between(-360, 360)
      .unit("degree");
  k.value("pile.building.cause.accelerogram", c.accelerogram,
          "Instead of a synthetic motion: accelerations at even steps, scaled so that the largest is `shake`.")
      .between(-1e6, 1e6);
  k.value("pile.building.cause.accelerogram_step", c.accelerogram_step, "Between accelerations.")
      .between(0.001, 1)
      .unit("s");
  k.value("pile.building.cause.blast", c.blast, "Impulse per area at 1 m, less with the square of the distance.")
      .between(0, 1e6)
      .unit("N s/m2");
  k.value("pile.building.cause.blast_at", c.blast_at, "Where.").between(-1000, 1000).unit("m");
  add_vehicle(k, c.vehicle);
  k.list("pile.building.cause.sinking", c.sinking, "Footings of ground columns that sink, within 2 s.");
  k.item("pile.building.cause.sinking[].i", c.sinking, &SinkingFooting::i, "Along X, from 0 at the lowest x.")
      .between(0, 8);
  k.item("pile.building.cause.sinking[].j", c.sinking, &SinkingFooting::j, "Along Y, from 0 at the lowest y.")
      .between(0, 8);
  k.item("pile.building.cause.sinking[].depth", c.sinking, &SinkingFooting::depth, "How far it sinks.")
      .between(0, 2)
      .unit("m");
}

}  // namespace

void add_victim_keys(Schema& k, VictimScenario& v) {
  k.group("victims",
          "People in the voids of the settled pile, as rigid figures: for missions that search for them "
          "(docs/search.md).");
  k.value("victims.count", v.count, "How many.").between(0, 50);
  k.choice("victims.difficulty", v.difficulty, {"easy", "medium", "hard"},
           "How far from the entrances: the nearest, the middle or the farthest third of the places.");
  k.value("victims.radius", v.radius, "Of the robot that gets near each of them and sees it.")
      .between(0.05, 1)
      .unit("m");
}

void add_pile_keys(Schema& keys, PileScenario& pile) {
  add_pile(keys, pile);
  add_terrain(keys, pile.terrain);
  add_building(keys, pile.building);
  add_cause(keys, pile.building.cause);
}

}  // namespace rubble
