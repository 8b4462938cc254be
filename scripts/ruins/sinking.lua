-- The footings of one side sink by half a metre, under a frame without walls.
return rubble.mission {
  seed = 10,
  pile = rubble.building {
    storeys = 4, bays_x = 2, bays_y = 2, span_x = 7, span_y = 6,
    column = 0.4, piece = 1.3, infill = "none",
    cause = {
      sinking = { { i = 0, j = 0, depth = 0.5 }, { i = 0, j = 1, depth = 0.5 }, { i = 0, j = 2, depth = 0.5 } },
    },
  },
  settle = { final_time_limit = 60 },
  voids = { on = true },
  camera = { width = 640, height = 480, fov_deg = 60 },
  trajectory = { waypoints = { { position = { -16, -19, 9 }, look_at = { 0, 0, 3.5 } } } },
  outputs = { frames = true },
}
