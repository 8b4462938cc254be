-- The sun from a direction that follows from the seed: try --seed 2, 3, 4.
return rubble.mission {
  seed = 1,
  pile = { layers = 1, pieces_per_layer = 40, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 } },
  light = { random_rotation = true },
  camera = { width = 320, height = 240 },
}
