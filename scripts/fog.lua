-- Fog so thick that the pile fades: a tenth of the light is left after 8 m.
return rubble.mission {
  seed = 2,
  pile = { layers = 1, pieces_per_layer = 40, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 } },
  air = { fog_density = 0.29, fog_intensity = 0.9 },
  camera = { width = 320, height = 240 },
}
