-- A circle about the pile, looking at its middle.
return rubble.mission {
  seed = 2,
  pile = { layers = 1, pieces_per_layer = 60, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 } },
  camera = { width = 320, height = 240 },
  trajectory = rubble.trajectory.orbit { radius_m = 5, height = 2, turns = 0.5, speed = 4 },
}
