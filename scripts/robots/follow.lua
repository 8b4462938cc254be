-- Two rovers drive the same square: one is localized by ground truth, the other by its odometry, which drifts
-- because the wheels skid in turns.
local square = { { 0, 0 }, { 1.5, 0 }, { 1.5, 1.5 }, { 0, 1.5 }, { 0, 0.3 } }

local function shifted(by)
  local path = {}
  for i, p in ipairs(square) do path[i] = { p[1] + by[1], p[2] + by[2] } end
  return path
end

return rubble.mission {
  pile = { layers = 0 },
  robots = {
    rubble.robot.rover { name = "guided", position = { 0, 2, 0.001 },
                         control = rubble.robot.follow { path = shifted { 0, 2 } } },
    rubble.robot.rover { name = "reckoning", position = { 0, -2, 0.001 },
                         control = rubble.robot.follow { path = square, by = "odometry" } },
  },
  robot_run = { duration = 28 },
  camera = { width = 320, height = 240, fov_deg = 90 },
  trajectory = { rate_hz = 1, waypoints = {
    { t = 0, position = { -3, 0, 4 }, look_at = { 0.8, 0.5, 0 } },
    { t = 28, position = { -3, 0, 4 }, look_at = { 0.8, 0.5, 0 } },
  } },
}
