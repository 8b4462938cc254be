-- The mission of `make demo`: 1,200 pieces of a collapsed concrete building over a box culvert. The
-- camera comes down over the pile, turns to the culvert's mouth and goes in with its lamp on.

-- What falls. Walls, floors and culverts are only placed.
local mix = {
  { asset = "slab_1", weight = 2 }, { asset = "slab_2", weight = 2 }, { asset = "slab_3", weight = 2 },
  { asset = "slab_4", weight = 1 }, { asset = "slab_5", weight = 2 },
  { asset = "chunk_1", weight = 3 }, { asset = "chunk_2", weight = 3 }, { asset = "chunk_3", weight = 3 },
  { asset = "chunk_4", weight = 4 }, { asset = "chunk_5", weight = 3 }, { asset = "chunk_6", weight = 4 },
  { asset = "cinder_block", weight = 2 }, { asset = "half_cinder_block" },
  { asset = "broken_cinder_block", weight = 2 },
  { asset = "brick", weight = 3 }, { asset = "worn_brick", weight = 2 }, { asset = "half_brick", weight = 2 },
  { asset = "beam", weight = 0.5 }, { asset = "column", weight = 0.5 }, { asset = "pipe_shard" },
  { asset = "rebar_straight" }, { asset = "rebar_bent" }, { asset = "rebar_hook" },
}

-- Three culvert pieces in a row: a void that no pile can close. The first mouth is at x = -4.
local placed = {}
for i = 1, 3 do
  placed[i] = { asset = "box_culvert", position = { -5 + 2 * i, 0, 0.76 } }
end
-- A wall still stands beside it, and a floor slab leans on the wall.
placed[#placed + 1] = { asset = "wall_stub", position = { 0.5, 2.6, 0.72 } }
placed[#placed + 1] = { asset = "floor_slab", position = { 0.4, 3.95, 0.97 },
                        rpy_deg = { -28, 0, 0 }, fixed = false }

return rubble.mission {
  seed = 1,
  pile = {
    layers = 4,
    pieces_per_layer = 300,
    spawn_position = { 0.5, 0, 5 },
    spawn_bounds = { 7, 7, 8 },
    mix = mix,
    placed = placed,
  },
  light = { type = "directional", intensity = 70, rpy_deg = { 0, 42, 35 } },
  lamp = { on = true, intensity_cd = 150 },
  camera = { width = 1024, height = 1024, fov_deg = 80 },
  trajectory = {
    rate_hz = 30,
    waypoints = {
      { t = 0.0, position = { -6.5, -5.5, 3.6 }, look_at = { 0.5, 0, 0.8 } },
      { t = 1.0, position = { -7.0, -2.6, 2.6 }, look_at = { -0.5, 0, 0.8 } },
      { t = 2.0, position = { -6.2, -0.4, 1.3 }, look_at = { -1.5, 0, 0.7 } },
      { t = 2.8, position = { -4.2, 0.0, 0.8 }, look_at = { 2, 0, 0.6 } },
      { t = 4.0, position = { -1.0, 0.0, 0.7 }, look_at = { 4, 0, 0.5 } },
    },
  },
}
