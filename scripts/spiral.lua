-- Circles that narrow and sink.
return rubble.mission {
  seed = 2,
  pile = { layers = 1, pieces_per_layer = 60, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 } },
  camera = { width = 320, height = 240 },
  trajectory = rubble.trajectory.spiral { radii = { 7, 3.5 }, heights = { 4, 1 }, turns = 1, speed = 8 },
}
