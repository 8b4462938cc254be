-- A building that comes down: its ground storey is open, and the columns there keep a tenth of their
-- strength. What follows is computed: bonds that break, floors that fall on floors and on the furniture of the
-- rooms, a heap at rest, and a flight around it.
return rubble.mission {
  seed = 11,
  packs = { "residential" },
  pile = rubble.building {
    storeys = 3, bays_x = 2, bays_y = 2, span_x = 4.5, span_y = 4.5, storey_height = 3,
    column = 0.3, beam_depth = 0.4, slab = 0.15, piece = 1.2,
    column_bars = 0.01, beam_bars = 0.008, slab_bars = 0.004,
    infill = "brick", openings = 0.4,
    furniture = {
      { asset = "sofa", per_bay = 0.5 }, { asset = "mattress", per_bay = 0.7 },
      { asset = "table", per_bay = 1 }, { asset = "chair", per_bay = 3 },
      { asset = "refrigerator", per_bay = 0.3 },
    },
    cause = { weak_storey = 0, weakness = 0.1 },
  },
  settle = { final_time_limit = 60 },
  voids = { on = true },
  camera = { width = 640, height = 480, fov_deg = 70 },
  trajectory = rubble.trajectory.orbit { radius_m = 13, height = 5, turns = 0.3, speed = 6 },
}
