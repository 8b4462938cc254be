-- Fines: grit, flakes, dust, paper, cables on a pile that has settled (docs/fines.md). With
-- `--set fines.amount=0` the same pile is bare.
return rubble.mission {
  seed = 7,
  packs = { "concrete", "residential" },
  pile = { layers = 3, pieces_per_layer = 120, spawn_bounds = { 6, 6, 5 } },
  fines = { amount = 40000 },
  light = { type = "sun", elevation_deg = 35 },
  camera = { width = 1024, height = 1024, fov_deg = 70, channels = { "label", "instance" } },
  outputs = { bag = false, rawlog = false, simplemap = false, frames = true },
  trajectory = { rate_hz = 1, waypoints = {
    { t = 0, position = { -4.6, -2.2, 1.5 }, look_at = { -1, 0, 0.4 } },
    { t = 1, position = { -3.4, -2.6, 0.7 }, look_at = { -1.2, -0.6, 0.2 } },
    { t = 2, position = { -3.0, -3.2, 0.35 }, look_at = { -2.0, -2.0, 0.05 } },
  } },
}
