-- A lorry of 30 t drives diagonally into a corner column at 16 m/s.
return rubble.mission {
  seed = 9,
  pile = rubble.building {
    storeys = 3, bays_x = 2, bays_y = 2, span_x = 5, span_y = 5,
    column = 0.3, piece = 1.3,
    cause = {
      vehicle = { mass = 30000, speed = 16, direction_deg = 45 },
    },
  },
  settle = { final_time_limit = 120 },
  voids = { on = true },
  camera = { width = 640, height = 480, fov_deg = 60 },
  trajectory = { waypoints = { { position = { -13, -15, 8 }, look_at = { 0, 0, 3.5 } } } },
  outputs = { frames = true },
}
