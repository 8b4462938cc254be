-- The reference renderer: colours by path tracing, denoised. Depth and channels are the same as otherwise.
return rubble.mission {
  seed = 2,
  pile = { layers = 1, pieces_per_layer = 40, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 } },
  light = { type = "sun", elevation_deg = 20, azimuth_deg = 250 },
  camera = { width = 320, height = 240, quality = "reference", samples = 16, denoise = true },
  trajectory = { waypoints = { { position = { -4, -1, 1.2 }, look_at = { 0, 0, 0.3 } } } },
}
