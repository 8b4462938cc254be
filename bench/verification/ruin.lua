-- Solution verification: a small building whose ground storey gives way.
return rubble.mission {
  seed = 1,
  packs = { "residential" },
  pile = rubble.building {
    storeys = 2, bays_x = 1, bays_y = 1, span_x = 4, span_y = 4, storey_height = 2.8,
    column = 0.3, beam_depth = 0.35, slab = 0.15, piece = 1.2,
    column_bars = 0.01, beam_bars = 0.008, slab_bars = 0.004,
    infill = "brick", openings = 0.4,
    furniture = { { asset = "table", per_bay = 1 }, { asset = "chair", per_bay = 2 } },
    cause = { weak_storey = 0, weakness = 0.03 },
  },
  settle = { final_time_limit = 60 },
}
