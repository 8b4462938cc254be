-- The ground shakes at 8 m/s2 under thin columns; there are no walls.
return rubble.mission {
  seed = 4,
  pile = rubble.building {
    storeys = 3, bays_x = 2, bays_y = 2, span_x = 5, span_y = 5,
    column = 0.25, piece = 1.3, infill = "none",
    cause = {
      shake = 8, shake_seconds = 12,
    },
  },
  settle = { final_time_limit = 60 },
  voids = { on = true },
  camera = { width = 640, height = 480, fov_deg = 60 },
  trajectory = { waypoints = { { position = { -11.5, -13, 7 }, look_at = { 0, 0, 1.8 } } } },
  outputs = { frames = true },
}
