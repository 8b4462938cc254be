-- Small and quick, for a first look and for tests: 40 pieces, 5 frames of 160x120.
return rubble.mission {
  seed = 1,
  pile = { layers = 2, pieces_per_layer = 20, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 3, 3, 3 } },
  camera = { width = 160, height = 120, fov_deg = 70 },
  trajectory = {
    waypoints = {
      { t = 0, position = { -4, 0, 2 }, look_at = { 0, 0, 0.3 } },
      { t = 4 / 30, position = { -3.6, -0.5, 1.8 }, look_at = { 0, 0, 0.3 } },
    },
  },
}
