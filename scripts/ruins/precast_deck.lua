-- A car park of precast parts that loses a corner column of its upper storey: beams and floor units fall off their seats.
return rubble.mission {
  seed = 1,
  packs = { "parking" },
  pile = rubble.building {
    kind = "precast", storeys = 2, bays_x = 3, bays_y = 2, span_x = 6, span_y = 7,
    storey_height = 2.9, column = 0.5, column_bars = 0.025, beam_depth = 0.7, slab = 0.22, piece = 1.8, continuity = 1,
    furniture = { { asset = "car_side", per_bay = 0.8, roof = true } },
    cause = { removed = { { storey = 1, i = 0, j = 0 } } },
  },
  settle = { final_time_limit = 90 },
  voids = { on = true },
  camera = { width = 640, height = 480, fov_deg = 60 },
  trajectory = { waypoints = { { position = { -15, -17, 9 }, look_at = { 0, 0, 2.5 } } } },
  outputs = { frames = true },
}
