-- Steady dropping: each layer falls as soon as the layer before has landed. Only the last one waits for rest.
return rubble.mission {
  seed = 6,
  pile = { layers = 4, pieces_per_layer = 15, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 3, 3, 3 } },
  settle = { schedule = "planes", final_time_limit = 15 },
  camera = { width = 320, height = 240 },
}
