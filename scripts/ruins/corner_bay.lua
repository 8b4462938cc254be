-- The four columns of a corner bay are gone, with bars of half the usual amount.
return rubble.mission {
  seed = 6,
  pile = rubble.building {
    storeys = 3, bays_x = 2, bays_y = 2, span_x = 5, span_y = 5,
    column = 0.3, piece = 1.3, beam_bars = 0.005, slab_bars = 0.003, infill = "none",
    cause = {
      removed = {
        { storey = 0, i = 0, j = 0 }, { storey = 0, i = 1, j = 0 },
        { storey = 0, i = 0, j = 1 }, { storey = 0, i = 1, j = 1 },
      },
    },
  },
  settle = { final_time_limit = 60 },
  voids = { on = true },
  camera = { width = 640, height = 480, fov_deg = 60 },
  trajectory = { waypoints = { { position = { -13, -15, 8 }, look_at = { 0, 0, 3.5 } } } },
  outputs = { frames = true },
}
