-- A brick house with timber floors: an excavation beside it takes two pieces of its outer wall at a corner.
return rubble.mission {
  seed = 1,
  packs = { "residential" },
  pile = rubble.building {
    kind = "masonry", storeys = 3, bays_x = 2, bays_y = 2, span_x = 4.5, span_y = 4.5,
    wall = 0.36, piece = 0.9, parapet = 0.6,
    furniture = {
      { asset = "sofa", per_bay = 0.4 }, { asset = "mattress", per_bay = 0.5 },
      { asset = "table", per_bay = 0.7 }, { asset = "chair", per_bay = 2 },
    },
    cause = { removed = { { storey = 0, i = 0, j = 0 }, { storey = 0, i = 1, j = 0 } } },
  },
  settle = { final_time_limit = 90 },
  voids = { on = true },
  camera = { width = 640, height = 480, fov_deg = 60 },
  trajectory = { waypoints = { { position = { -15, -17, 9 }, look_at = { 0, 0, 2.2 } } } },
  outputs = { frames = true },
}
