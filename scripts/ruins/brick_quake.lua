-- The same kind of house in an earthquake of 5 m/s2.
return rubble.mission {
  seed = 2,
  pile = rubble.building {
    kind = "masonry", storeys = 2, bays_x = 2, bays_y = 2, span_x = 4.5, span_y = 4.5,
    wall = 0.36, piece = 0.9, parapet = 0.6,
    cause = { shake = 5, shake_seconds = 6 },
  },
  settle = { final_time_limit = 90 },
  voids = { on = true },
  camera = { width = 640, height = 480, fov_deg = 60 },
  trajectory = { waypoints = { { position = { -13, -15, 7 }, look_at = { 0, 0, 1.6 } } } },
  outputs = { frames = true },
}
