-- A ring of rubble, open in the middle.
return rubble.mission {
  seed = 2,
  pile = {
    layers = 2, pieces_per_layer = 60,
    spawn_position = { 0, 0, 3 }, spawn_bounds = { 8, 8, 4 },
    spawn_density = rubble.density.ring { inner = 0.6, outer = 0.95 },
  },
  camera = { width = 320, height = 240 },
  trajectory = { waypoints = { { position = { -8, 0, 6 }, look_at = { 0, 0, 0 } } } },
}
