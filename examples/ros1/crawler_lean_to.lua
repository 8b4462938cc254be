-- A crawler before a lean-to, with an OS0 LiDAR of 32 rings, 512 columns and 5 scans a second: the world for
-- ros1_navigator (docs/explanation/autonomy.md). The void is 5 m long, along Y, and open at both ends; bricks lie in it, and blocks
-- stand in the way, elsewhere for each seed. The goal is 8.5 m ahead of the start, behind the lean-to.
local random = rubble.random("blocks")
local blocks = {}
for i = 1, 4 do
  local x, y, z = random:uniform(0.25, 0.45), random:uniform(0.25, 0.45), random:uniform(0.2, 0.35)
  blocks[i] = {
    box = { x, y, z }, rpy_deg = { 0, 0, random:uniform(0, 90) }, fixed = false,
    position = { random:uniform(0.4, 2.6), -3.1 + 1.3 * i + random:uniform(-0.3, 0.3), z / 2 + 0.002 },
  }
end

return rubble.mission {
  seed = 1,
  pile = rubble.join(
    rubble.collapse.lean_to {
      length = 5, width = 5, height = 2.1, debris = { layers = 1, pieces_per_layer = 12, margin = -0.4 },
    },
    rubble.collapse.free { pieces = blocks, debris = { layers = 0 } }),
  robots = {
    rubble.robot.crawler {
      name = "crawler", position = { 1.6, -4.2, 0.001 }, rpy_deg = { 0, 0, 90 },
    },
  },
  lidars = {
    points = { model = "os0", channels = 32, columns = 512, rate_hz = 5, ride = { robot = "crawler" }, position = { 0, 0, 0.4 } },
  },
  camera = { width = 160, height = 120, fov_deg = 90 },
  trajectory = { rate_hz = 10, ride = { robot = "crawler", position = { 0.3, 0, 0.3 } } },
  lamp = { on = true, intensity_cd = 30 },
  light = { type = "directional", intensity = 80, rpy_deg = { 0, 38, 40 } },
}
