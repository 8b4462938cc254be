-- Voids that a crawler drives through: the piles of `rubble bench navigate` (docs/explanation/autonomy.md).
--   rubble bench navigate scripts/navigate.lua --seeds 1..10
local random = rubble.random("navigate")
-- Blocks on the ground under a slab that leans on a wall; the void runs along Y and is open at both ends.
local blocks = {}
for i = 1, 6 do
  local x, y, z = random:uniform(0.25, 0.5), random:uniform(0.25, 0.5), random:uniform(0.2, 0.4)
  blocks[i] = {
    box = { x, y, z }, rpy_deg = { 0, 0, random:uniform(0, 90) }, fixed = false,
    position = { random:uniform(0.5, 3), -2.5 + (i - 1) + random:uniform(-0.3, 0.3), z / 2 + 0.002 },
  }
end
return rubble.mission {
  seed = 1,
  pile = rubble.join(
    rubble.collapse.lean_to {
      length = 6, width = 6, height = random:uniform(1.8, 2.4), debris = { layers = 1, pieces_per_layer = 15 },
    },
    rubble.collapse.free { pieces = blocks, debris = { layers = 0 } }),
  camera = { width = 320, height = 240, fov_deg = 90 },
  lamp = { on = true },
  trajectory = { rate_hz = 5, waypoints = {
    { t = 0, position = { 1.5, -6, 1 }, look_at = { 1.5, 0, 0.4 } },
    { t = 1, position = { 1.5, -5.8, 1 }, look_at = { 1.5, 0, 0.4 } } } },
}
