-- A rover drives into the lean-to of first_pile.lua and backs out again.
local turned

local function in_and_out(sense)
  local x, aside = sense.truth.position[1], -0.62 - sense.truth.position[2]
  for _, contact in ipairs(sense.contacts) do
    if contact.link == "base_link" and contact.normal[1] < -0.5 then turned = true end
  end
  if x > -2.4 then turned = true end
  local speed = not turned and 0.4 or x > -5.2 and -0.4 or 0
  local forwards = speed < 0 and -1 or 1
  local turn = forwards * 2 * aside - 1.5 * sense.truth.yaw
  return { linear = speed, angular = speed == 0 and 0 or math.max(-1, math.min(1, turn)) }
end

local make_pile = rubble.include("lean_to_pile.lua")

return rubble.mission {
  seed = 1,
  pile = make_pile(),
  robots = {
    rubble.robot.rover { name = "rover", position = { -5.4, -0.62, 0.001 }, control = in_and_out },
  },
  robot_run = { duration = 17 },
  light = { type = "directional", intensity = 80, rpy_deg = { 0, 38, 40 } },
  lamp = { on = true, intensity_cd = 30 },
  camera = { width = 320, height = 240, fov_deg = 90 },
  trajectory = { rate_hz = 0.5, ride = { robot = "rover", position = { 0.22, 0, 0.25 }, rpy_deg = { 0, 5, 0 } } },
}
