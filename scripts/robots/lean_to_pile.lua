-- A function that makes the pile of scripts/first_pile.lua, for missions with robots: two slabs that lean on a wall, and 1,200 pieces over them.
-- The void under the slabs opens to -X.
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
local placed = {
  { asset = "wall_stub", position = { -3.05, -1.32, 0.7 } },
  { asset = "wall_stub", position = { 0.0, -1.3, 0.7 } },
  { asset = "wall_stub", position = { 3.05, -1.28, 0.7 }, rpy_deg = { 3, 0, -1 } },
  { asset = "wall_stub", position = { 4.75, 0.3, 0.7 }, rpy_deg = { 0, 0, 90 } },
  { asset = "floor_slab", position = { -2.15, -0.12, 0.68 }, rpy_deg = { -27.3, 0, 1 } },
  { asset = "floor_slab", position = { 2.1, -0.08, 0.69 }, rpy_deg = { -26.8, 0.5, -1 } },
}
local lying = { "chunk_4", "brick", "cinder_block", "chunk_6", "half_brick", "worn_brick", "chunk_1" }

return function()
  local random = rubble.random("room")
  for i = 0, 10 do
    placed[#placed + 1] = {
      asset = lying[i % #lying + 1], fixed = false,
      position = { -2.6 + 0.6 * i, i % 2 == 0 and 0.25 or -0.95, 0.3 },
      rpy_deg = { random:uniform(-60, 60), random:uniform(-60, 60), random:uniform(0, 360) },
    }
  end
  return {
    layers = 4, pieces_per_layer = 300, spawn_position = { 1.2, 0.3, 6 }, spawn_bounds = { 7, 5, 8 },
    mix = mix, placed = placed,
  }
end
