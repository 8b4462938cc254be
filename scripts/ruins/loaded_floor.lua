-- The first floor of four carries 2.5 t on each square metre.
return rubble.mission {
  seed = 3,
  pile = rubble.building {
    storeys = 4, bays_x = 2, bays_y = 2, span_x = 5, span_y = 5,
    column = 0.3, piece = 1.3,
    cause = {
      overloaded_floor = 1, overload = 2500,
    },
  },
  settle = { final_time_limit = 60 },
  voids = { on = true },
  camera = { width = 640, height = 480, fov_deg = 60 },
  trajectory = { waypoints = { { position = { -12, -13.5, 8 }, look_at = { 0, 0, 2 } } } },
  outputs = { frames = true },
}
