-- A bridge of three spans whose first pier is knocked away: spans break, and hang from their seats and bars.
return rubble.mission {
  seed = 1,
  packs = { "parking" },
  pile = rubble.building {
    kind = "bridge", storeys = 1, bays_x = 3, bays_y = 2, span_x = 14, span_y = 2.6,
    storey_height = 6.5, column = 0.9, beam_depth = 1.2, slab = 0.22, parapet = 0.9, piece = 1.4,
    furniture = { { asset = "car_side", per_bay = 0.4, roof = true } },
    cause = { removed = {
      { storey = 0, i = 1, j = 0 }, { storey = 0, i = 1, j = 1 }, { storey = 0, i = 1, j = 2 },
    } },
  },
  settle = { final_time_limit = 90 },
  voids = { on = true },
  camera = { width = 640, height = 480, fov_deg = 60 },
  trajectory = { waypoints = { { position = { -26, -26, 13 }, look_at = { -4, 0, 1 } } } },
  outputs = { frames = true },
}
