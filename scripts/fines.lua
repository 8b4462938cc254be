-- Fines: grit, flakes of plaster, glass, paper, dust and cables on what has settled (docs/explanation/fines.md). With
-- `--set fines.amount=0` the same corner of a broken room is bare.
return rubble.mission {
  seed = 3,
  pile = {
    layers = 2, pieces_per_layer = 22, spawn_position = { 0.4, 0.4, 1.6 }, spawn_bounds = { 2.2, 1.6, 1.6 },
    mix = {
      { asset = "chunk_2", weight = 2 }, { asset = "chunk_4", weight = 2 }, { asset = "chunk_5", weight = 2 },
      { asset = "chunk_6", weight = 3 }, { asset = "slab_4" }, { asset = "brick", weight = 3 },
      { asset = "half_brick", weight = 3 }, { asset = "broken_cinder_block" }, { asset = "rebar_bent" },
    },
    placed = {
      { box = { 4.4, 0.2, 1.7 }, position = { 0, 1.6, 0.85 }, broken = { "+z" } },
      { box = { 0.2, 3.4, 1.3 }, position = { 1.9, 0, 0.65 }, material = "brick", broken = { "+z" } },
    },
  },
  fines = { amount = 60000, cloth = 0.00005, cables = 2, pipes = 1 },
  light = { type = "sun", elevation_deg = 40, azimuth_deg = 230 },
  camera = { width = 640, height = 480, fov_deg = 65, channels = { "label", "instance" } },
  outputs = { frames = true },
  trajectory = { rate_hz = 5, waypoints = {
    { t = 0, position = { -1.7, -1.7, 1.15 }, look_at = { 0.5, 0.6, 0.1 } },
    { t = 0.6, position = { -0.7, -0.7, 0.6 }, look_at = { 0.8, 0.8, 0.1 } },
  } },
}
