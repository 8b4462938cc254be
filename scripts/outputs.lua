-- Only a bag, with depth in metres.
return rubble.mission {
  seed = 2,
  start_ns = 1700000000000000000,
  pile = { layers = 1, pieces_per_layer = 20, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 3, 3, 3 } },
  camera = { width = 160, height = 120 },
  outputs = { rawlog = false, stl = false, groundtruth = false, preview = false, depth = "32FC1" },
}
