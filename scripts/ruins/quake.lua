-- The ground shakes at 6 m/s2 under an open ground storey.
return rubble.mission {
  seed = 1,
  packs = { "residential" },
  pile = rubble.building {
    storeys = 3, bays_x = 2, bays_y = 2, span_x = 5, span_y = 5,
    column = 0.3, piece = 1.3,
    furniture = {
      { asset = "sofa", per_bay = 0.5 }, { asset = "mattress", per_bay = 0.7 },
      { asset = "table", per_bay = 1 }, { asset = "chair", per_bay = 3 },
      { asset = "refrigerator", per_bay = 0.3 },
    },
    cause = {
      shake = 6, weak_storey = 0, weakness = 0.3,
    },
  },
  settle = { final_time_limit = 60 },
  voids = { on = true },
  camera = { width = 640, height = 480, fov_deg = 60 },
  trajectory = { waypoints = { { position = { -11.5, -13, 7 }, look_at = { 0, 0, 1.8 } } } },
  outputs = { frames = true },
}
