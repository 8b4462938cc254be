-- A blast of 20 kN s/m2 at one metre, beside a long side: the walls there are blown in, and the building comes down.
return rubble.mission {
  seed = 8,
  pile = rubble.building {
    storeys = 3, bays_x = 2, bays_y = 2, span_x = 5, span_y = 5,
    column = 0.3, piece = 1.3,
    cause = {
      blast = 20000, blast_at = { 0, -6.5, 1 },
    },
  },
  settle = { final_time_limit = 60 },
  voids = { on = true },
  camera = { width = 640, height = 480, fov_deg = 60 },
  trajectory = { waypoints = { { position = { -13, -15, 8 }, look_at = { 0, 0, 3.5 } } } },
  outputs = { frames = true },
}
