-- A rover drives through a lean-to, past blocks that lie in its way, to a goal 6.5 m ahead. It knows only
-- what its 2-D scanner, wheels and gyroscope measure. The recording has the same scans.
local pile = rubble.collapse.lean_to {
  length = 3, width = 4, height = 1.7, debris = { layers = 1, pieces_per_layer = 30, margin = -0.4 },
}
for i, at in ipairs { { 0.75, -1.1 }, { 1.5, 0.15 }, { 0.7, 1.3 } } do
  pile.placed[#pile.placed + 1] = {
    asset = "cinder_block", position = { at[1], at[2], 0.11 }, rpy_deg = { 0, 0, 40 * i }, fixed = false,
  }
end

return rubble.mission {
  seed = 4,
  pile = pile,
  robots = {
    rubble.robot.rover {
      name = "rover", position = { 1.1, -3.6, 0.001 }, rpy_deg = { 0, 0, 90 },
      senses = { "scan" }, control = rubble.robot.follow_the_gap { goal = { 6.5, 0 } },
    },
  },
  robot_run = { duration = 30 },
  lidars = { scan = { model = "utm30lx", rate_hz = 10, ride = { robot = "rover" }, position = { 0.25, 0, 0.15 } } },
  camera = { width = 320, height = 240, fov_deg = 90 },
  trajectory = { rate_hz = 0.5, ride = { robot = "rover", position = { 0.2, 0, 0.25 } } },
  lamp = { on = true, intensity_cd = 30 },
  light = { type = "directional", intensity = 80, rpy_deg = { 0, 38, 40 } },
}
