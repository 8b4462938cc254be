-- A cellar for the judged views: walls of three colours, a hole in the roof, and debris on the floor.
local function wall(size, position, material)
  return { box = size, position = position, material = material }
end
local placed = {
  -- Walls and roof reach into each other a little, so that no light comes through between them.
  wall({ 0.2, 3.4, 2.2 }, { -1.6, 0, 1.1 }, "brick"),
  wall({ 3.4, 0.2, 2.2 }, { 0, 1.6, 1.1 }, "drywall"),
  wall({ 0.2, 3.4, 2.2 }, { 1.6, 0, 1.1 }, "reinforced_concrete"),
  wall({ 3.4, 0.2, 2.2 }, { 0, -1.6, 1.1 }, "timber"),
  wall({ 3.4, 1.7, 0.2 }, { 0, 0.85, 2.28 }, "reinforced_concrete"),
  wall({ 1.7, 1.72, 0.2 }, { 0.85, -0.85, 2.28 }, "reinforced_concrete"),
  -- The piece of roof that fell in, and what came with it.
  { box = { 0.9, 0.7, 0.15 }, position = { -0.1, 0.5, 0.3 }, rpy_deg = { 20, 10, 70 },
    broken = { "+x", "-y" }, fixed = false },
  { box = { 1.6, 0.12, 0.05 }, position = { 0.1, 0.3, 0.8 }, rpy_deg = { 0, 12, 30 }, material = "timber",
    fixed = false },
}
local fallen = { "brick", "chunk_4", "half_brick", "brick", "cinder_block", "half_brick", "chunk_5" }
local random = rubble.random("debris")
for i = 0, 34 do
  placed[#placed + 1] = {
    asset = fallen[i % #fallen + 1], fixed = false,
    position = { -1 + 0.5 * (i % 5), -1 + 0.5 * (i // 5 % 5), 1 + 0.4 * (i // 25) },
    rpy_deg = { random:uniform(-60, 60), random:uniform(-60, 60), random:uniform(0, 360) },
  }
end
return rubble.mission {
  seed = 4,
  pile = { layers = 0, placed = placed },
  light = { rpy_deg = { 0, 48, 60 } },
  camera = { fov_deg = 75 },
  trajectory = { waypoints = { { position = { 1.25, -1.25, 1.5 }, look_at = { -0.5, 0.9, 0.15 } } } },
}
