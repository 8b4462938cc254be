-- Five of nine ground columns are gone; there are no walls.
return rubble.mission {
  seed = 5,
  pile = rubble.building {
    storeys = 3, bays_x = 2, bays_y = 2, span_x = 5, span_y = 5,
    column = 0.3, piece = 1.3, infill = "none",
    cause = {
      removed = {
        { storey = 0, i = 0, j = 0 }, { storey = 0, i = 0, j = 1 }, { storey = 0, i = 0, j = 2 },
        { storey = 0, i = 1, j = 0 }, { storey = 0, i = 1, j = 1 },
      },
    },
  },
  settle = { final_time_limit = 120 },
  voids = { on = true },
  camera = { width = 640, height = 480, fov_deg = 60 },
  trajectory = { waypoints = { { position = { -13, -15, 8 }, look_at = { 0, 0, 3.5 } } } },
  outputs = { frames = true },
}
