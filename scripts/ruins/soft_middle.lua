-- A soft storey between two sound ones.
return rubble.mission {
  seed = 2,
  pile = rubble.building {
    storeys = 4, bays_x = 2, bays_y = 2, span_x = 5, span_y = 5,
    column = 0.3, piece = 1.3,
    cause = {
      weak_storey = 1, weakness = 0.05,
    },
  },
  settle = { final_time_limit = 60 },
  voids = { on = true },
  camera = { width = 640, height = 480, fov_deg = 60 },
  trajectory = { waypoints = { { position = { -12, -13.5, 8 }, look_at = { 0, 0, 2 } } } },
  outputs = { frames = true },
}
