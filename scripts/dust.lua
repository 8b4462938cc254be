-- Dust bursts out of the pile every second and a half, drifts with the wind and settles, in a thin
-- smoke that billows and lies low.
return rubble.mission {
  seed = 2,
  pile = { layers = 1, pieces_per_layer = 40, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 } },
  air = {
    fog_density = 0.12, fog_height = 1.5, fog_noise = 0.9, wind = { 0.4, 0.1, 0 },
    dust = { period = 1.5, position = { 0, 0, 0.5 }, bounds = { 3, 3, 0.5 }, density = 4 },
  },
  camera = { width = 320, height = 240 },
}
