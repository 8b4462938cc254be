-- A rover and a crawler driven by functions of the script: the rover turns away from what it touches,
-- the crawler keeps a course by its gyroscope.
local function bump_and_turn()
  local until_then = -1
  return function(sense)
    for _, contact in ipairs(sense.contacts) do
      -- Something in front, not the ground below.
      if contact.normal[1] < -0.5 then until_then = sense.t + 1.5 end
    end
    if sense.t < until_then then return { linear = -0.3, angular = 1.5 } end
    return { linear = 0.5 }
  end
end

local function straight_on()
  local yaw, last = 0, 0
  return function(sense)
    yaw = yaw + sense.imu.gyroscope[3] * (sense.t - last)
    last = sense.t
    return { linear = 0.3, angular = -2 * yaw, flippers = { 0.9, 0.9, 0.9, 0.9 } }
  end
end

return rubble.mission {
  seed = 4,
  pile = {
    layers = 1, pieces_per_layer = 20, spawn_bounds = { 1.5, 1.5, 1 },
    mix = { { asset = "brick" }, { asset = "cinder_block" } },
  },
  robots = {
    rubble.robot.rover { name = "bumper", position = { -2, 0, 0.001 }, control = bump_and_turn() },
    rubble.robot.crawler { name = "tank", position = { 0, -2, 0.001 }, control = straight_on() },
  },
  robot_run = { duration = 6, control_hz = 30 },
  camera = { width = 320, height = 240, fov_deg = 80 },
  trajectory = { rate_hz = 5, waypoints = {
    { t = 0, position = { -3, -3, 2.5 }, look_at = { 0, 0, 0.1 } },
    { t = 6, position = { 3, -3, 2.5 }, look_at = { 0, 0, 0.1 } },
  } },
}
