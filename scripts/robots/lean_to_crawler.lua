-- A crawler drives into the lean-to of first_pile.lua, over what lies on its floor, and backs out again.
local turned

local function in_and_out(sense)
  local x, aside = sense.truth.position[1], -0.62 - sense.truth.position[2]
  local speed = 0
  if not turned then
    speed = 0.5
    if x > -1.6 then turned = true end
  elseif x > -5.2 then
    speed = -0.5
  end
  local forwards = speed < 0 and -1 or 1
  local turn = forwards * 2 * aside - 1.5 * sense.truth.yaw
  return { linear = speed, angular = speed == 0 and 0 or math.max(-1, math.min(1, turn)),
           flippers = { 0.7, 0.7, 0.7, 0.7 } }
end

local make_pile = rubble.include("lean_to_pile.lua")

return rubble.mission {
  seed = 1,
  pile = make_pile(),
  robots = {
    rubble.robot.crawler { name = "crawler", position = { -5.4, -0.62, 0.001 }, control = in_and_out },
  },
  robot_run = { duration = 17 },
  light = { type = "directional", intensity = 80, rpy_deg = { 0, 38, 40 } },
  lamp = { on = true, intensity_cd = 30 },
  camera = { width = 320, height = 240, fov_deg = 90 },
  trajectory = { rate_hz = 0.5, ride = { robot = "crawler", position = { 0.3, 0, 0.3 }, rpy_deg = { 0, 10, 0 } } },
}
