-- A vine robot pushes away the block that holds rows of bricks on a slope of 40 degrees, and a slide follows.
local placed = {
  { box = { 2.4, 0.5, 0.1 }, position = { 0, 0, 0.84 }, rpy_deg = { 0, 40, 0 } },
  { asset = "cinder_block", position = { 1.12, 0, 0.1 }, fixed = false },
}
-- Rows along the slope, each brick flat on it, 1 mm above it.
local down, up = { math.cos(math.rad(40)), -math.sin(math.rad(40)) }, { math.sin(math.rad(40)), math.cos(math.rad(40)) }
for row = 0, 6 do
  for column = -1, 1, 2 do
    local s, h = 1.0 - 0.225 * row, 0.05 + 0.034
    placed[#placed + 1] = {
      asset = "brick", fixed = false,
      position = { s * down[1] + h * up[1], 0.055 * column, 0.84 + s * down[2] + h * up[2] },
      rpy_deg = { 0, 40, 0 },
    }
  end
end

return rubble.mission {
  seed = 1,
  pile = { layers = 0, placed = placed },
  robots = {
    rubble.robot.vine { name = "vine", position = { 1.14, -1, 0.1 }, rpy_deg = { 0, 0, 90 }, length = 2.2,
                        pressure = 30e3, drive = { { t = 0, growth = 0.25 } } },
  },
  robot_run = { duration = 8 },
  camera = { width = 480, height = 360, fov_deg = 60 },
  trajectory = { rate_hz = 5, waypoints = {
    { t = 0, position = { 2.7, -1.1, 1.2 }, look_at = { 0.8, 0, 0.3 } },
    { t = 8, position = { 2.7, -1.1, 1.2 }, look_at = { 0.8, 0, 0.3 } },
  } },
}
