-- Ground truth beside colour and depth: normals, piece numbers, classes (labels.csv names them),
-- optical flow to the next frame, and how much of the sky each surface sees.
return rubble.mission {
  seed = 3,
  pile = { layers = 1, pieces_per_layer = 40, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 } },
  camera = {
    width = 160,
    height = 120,
    channels = { "normals", "instance", "label", "flow", "sky_visibility" },
  },
  trajectory = {
    waypoints = {
      { t = 0, position = { -4, 0, 2 }, look_at = { 0, 0, 0.3 } },
      { t = 4 / 30, position = { -3.6, -0.5, 1.8 }, look_at = { 0, 0, 0.3 } },
    },
  },
}
