-- Pieces that hang together: slabs on bars that bend for good and tear.
return rubble.mission {
  seed = 12,
  pile = {
    layers = 1,
    pieces_per_layer = 60,
    spawn_bounds = { 5, 5, 5 },
    spawn_position = { 0, 0, 4 },
    mix = {
      { asset = "hinged_slab", weight = 2 },
      { asset = "chunk_1", weight = 1 },
      { asset = "half_brick", weight = 1 },
      { asset = "cinder_block", weight = 1 },
    },
    placed = {
      -- Its first slab is held; the second droops on the bar.
      { asset = "hinged_slab", position = { -1.5, 0, 2.2 }, fixed = true },
    },
  },
  camera = { width = 320, height = 240, fov_deg = 80 },
  trajectory = { waypoints = { { position = { -5, -3, 3 }, look_at = { 0, 0, 0.8 } } } },
}
