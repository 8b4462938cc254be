-- The pile seen settling: a camera beside it stands and watches the layers fall onto a wall, then it
-- flies around what came to rest. All of it is one recording: flow and piece numbers follow what
-- falls, and track.bin and track.glb say who moved when (docs/explanation/moving_worlds.md).
return rubble.mission {
  seed = 5,
  pile = {
    layers = 2,
    pieces_per_layer = 60,
    spawn_position = { 0, 0, 4.5 },
    spawn_bounds = { 4, 4, 5 },
    mix = {
      { asset = "chunk_1" }, { asset = "chunk_3" }, { asset = "chunk_4" }, { asset = "chunk_6" },
      { asset = "slab_4", weight = 0.4 }, { asset = "cinder_block" }, { asset = "brick", weight = 2 },
    },
    placed = {
      { asset = "wall_stub", position = { 0, 1.2, 0.7 } },
      { asset = "floor_slab", position = { 0, 0, 1.35 }, rpy_deg = { 12, 0, 0 }, fixed = false },
    },
  },
  camera = { width = 320, height = 240, fov_deg = 70, channels = { "instance", "flow" } },
  light = { type = "sun", elevation_deg = 42, azimuth_deg = 250 },
  record_settling = { rate_hz = 15, to = 8, position = { -6, -4.5, 2.2 }, look_at = { 0, 0, 1.1 } },
  trajectory = {
    rate_hz = 15,
    waypoints = {
      { t = 0, position = { -6, -4.5, 2.2 }, look_at = { 0, 0, 0.6 } },
      { t = 1, position = { 0, -6.5, 2 }, look_at = { 0, 0, 0.6 } },
    },
  },
  outputs = { frames = true, mcap = true, track = true },
}
