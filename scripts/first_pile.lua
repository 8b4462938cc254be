-- A pile of loose pieces: two floor slabs of a collapsed building lean on what is left of a
-- wall, 1,200 pieces have come down over them, and a camera flies over the pile and into the void
-- beneath (the collapse mode that rescue services call a lean-to).

-- What falls. Walls, floors and culverts are only placed.
local mix = {
  { asset = "slab_1", weight = 1.5 }, { asset = "slab_2", weight = 1.5 }, { asset = "slab_3" },
  { asset = "slab_4" }, { asset = "slab_5", weight = 1.5 },
  { asset = "chunk_1", weight = 3 }, { asset = "chunk_2", weight = 3 },
  { asset = "chunk_3", weight = 3 }, { asset = "chunk_4", weight = 4 },
  { asset = "chunk_5", weight = 3 }, { asset = "chunk_6", weight = 4 },
  { asset = "cinder_block", weight = 3 }, { asset = "half_cinder_block", weight = 2 },
  { asset = "broken_cinder_block", weight = 3 },
  { asset = "brick", weight = 5 }, { asset = "worn_brick", weight = 4 },
  { asset = "half_brick", weight = 4 },
  { asset = "beam", weight = 0.5 }, { asset = "column", weight = 0.5 },
  { asset = "pipe_shard", weight = 0.5 },
  { asset = "rebar_straight" }, { asset = "rebar_bent" }, { asset = "rebar_hook" },
}

-- The wall runs along X and turns a corner. Each slab has one long edge on it, the other on the
-- floor: under them is a void of triangular section, 1.3 m high at the wall.
local placed = {
  { asset = "wall_stub", position = { -3.05, -1.32, 0.7 } },
  { asset = "wall_stub", position = { 0.0, -1.3, 0.7 } },
  { asset = "wall_stub", position = { 3.05, -1.28, 0.7 }, rpy_deg = { 3, 0, -1 } },
  { asset = "wall_stub", position = { 4.75, 0.3, 0.7 }, rpy_deg = { 0, 0, 90 } },
  { asset = "floor_slab", position = { -2.15, -0.12, 0.68 }, rpy_deg = { -27.3, 0, 1 }, built_in = true },
  { asset = "floor_slab", position = { 2.1, -0.08, 0.69 }, rpy_deg = { -26.8, 0.5, -1 }, built_in = true },
}
-- What lay in the room already: it settles before the first layer comes.
local lying = { "chunk_4", "brick", "cinder_block", "chunk_6", "half_brick", "worn_brick", "chunk_1" }
local random = rubble.random("room")
for i = 0, 10 do
  placed[#placed + 1] = {
    asset = lying[i % #lying + 1], fixed = false,
    position = { -2.6 + 0.6 * i, i % 2 == 0 and -0.15 or -0.9, 0.3 },
    rpy_deg = { random:uniform(-60, 60), random:uniform(-60, 60), random:uniform(0, 360) },
  }
end

return rubble.mission {
  seed = 1,
  pile = {
    layers = 4,
    pieces_per_layer = 300,
    spawn_position = { 1.2, 0.3, 6 },
    spawn_bounds = { 7, 5, 8 },
    mix = mix,
    placed = placed,
  },
  light = { type = "directional", intensity = 80, rpy_deg = { 0, 38, 40 } },
  lamp = { on = true, intensity_cd = 60 },
  camera = { width = 1024, height = 1024, fov_deg = 80 },
  trajectory = {
    rate_hz = 30,
    waypoints = {
      { t = 0.0, position = { -5.6, -4.6, 2.3 }, look_at = { 0.6, 0, 0.8 } },
      { t = 1.0, position = { -7.2, -1.6, 1.7 }, look_at = { -0.5, -0.2, 0.8 } },
      { t = 1.9, position = { -5.9, -0.6, 0.9 }, look_at = { -1.5, -0.6, 0.6 } },
      { t = 2.8, position = { -3.6, -0.7, 0.62 }, look_at = { 1, -0.6, 0.4 } },
      { t = 4.0, position = { -0.8, -0.72, 0.58 }, look_at = { 3, -0.55, 0.35 } },
    },
  },
}
