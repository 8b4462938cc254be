-- A car park whose middle storey gives way: decks with cars fall onto decks with cars.
return rubble.mission {
  seed = 2,
  packs = { "parking" },
  pile = rubble.building {
    storeys = 3, bays_x = 2, bays_y = 2, span_x = 7, span_y = 7, storey_height = 2.8,
    column = 0.35, beam_depth = 0.5, slab = 0.2, piece = 1.6, infill = "none",
    furniture = { { asset = "car_side", per_bay = 1.5, roof = true } },
    cause = { weak_storey = 1, weakness = 0.05 },
  },
  settle = { final_time_limit = 120 },
  voids = { on = true },
  camera = { width = 640, height = 480, fov_deg = 60 },
  trajectory = { waypoints = { { position = { -16, -18, 9 }, look_at = { 0, 0, 3 } } } },
  outputs = { frames = true },
}
