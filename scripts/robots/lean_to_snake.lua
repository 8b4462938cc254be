-- A snake lies across the entrance of the lean-to of first_pile.lua, rolls in and rolls out again. Its waves go on where
-- they are when it turns back: that is what `phase` is for.
local back_at, rate = 12, 4

local make_pile = rubble.include("lean_to_pile.lua")

return rubble.mission {
  seed = 1,
  pile = make_pile(),
  robots = {
    rubble.robot.snake {
      name = "snake", modules = 8, position = { -4.9, -0.6, 0.03 }, rpy_deg = { 0, 0, 90 },
      drive = {
        { t = 0, gait = "rolling", rate = rate },
        { t = back_at, gait = "rolling", rate = -rate, phase = 2 * rate * back_at },
      },
    },
  },
  robot_run = { duration = 30 },
  light = { type = "directional", intensity = 80, rpy_deg = { 0, 38, 40 } },
  lamp = { on = true, intensity_cd = 30 },
  camera = { width = 320, height = 240, fov_deg = 90 },
  trajectory = { rate_hz = 0.5, ride = { robot = "snake", link = "head", position = { 0.06, 0, 0 } } },
}
