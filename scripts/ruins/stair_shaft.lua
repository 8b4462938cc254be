-- A frame with a stair and a lift shaft. Its open ground storey gives way in an earthquake.
return rubble.mission {
  seed = 2,
  packs = { "residential" },
  pile = rubble.building {
    storeys = 3, bays_x = 3, bays_y = 2, span_x = 5, span_y = 5, column = 0.3, piece = 1.3, slab = 0.22,
    partitions = "brick", parapet = 0.9, stairs = { { i = 0, j = 0 } }, cores = { { i = 1, j = 1 } },
    furniture = { { asset = "table", per_bay = 0.5 } },
    cause = { shake = 6, weak_storey = 0, weakness = 0.1 },
  },
  settle = { final_time_limit = 90 },
  voids = { on = true },
  camera = { width = 640, height = 480, fov_deg = 60 },
  trajectory = { waypoints = { { position = { -14, -15, 9 }, look_at = { 0, 0, 3 } } } },
  outputs = { frames = true },
}
