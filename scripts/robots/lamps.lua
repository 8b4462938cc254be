-- Dusk: a crawler drives into a lean-to by its headlamp, a rover with two lamps follows. The camera stands
-- beside and has no lamp of its own.
local make_pile = rubble.include("lean_to_pile.lua")
local rover_lamps = {}
for _, side in ipairs { 1, -1 } do
  rover_lamps[#rover_lamps + 1] = { position = { 0.24, 0.1 * side, 0.13 }, rpy_deg = { 0, 5, 12 * side }, intensity_cd = 60 }
end
local watch = { position = { -7.6, -2.0, 1.7 }, look_at = { -3.2, -0.6, 0.5 } }

return rubble.mission {
  seed = 1,
  pile = make_pile(),
  robots = {
    rubble.robot.crawler { position = { -4.3, -0.7, 0.001 }, lamps = { { rpy_deg = { 0, 4, 0 } } }, drive = { { linear = 0.25 } } },
    rubble.robot.rover { position = { -5.9, -0.4, 0.001 }, rpy_deg = { 0, 0, -8 }, lamps = rover_lamps, drive = { { linear = 0.25 } } },
  },
  robot_run = { duration = 4 },
  light = { type = "sun", elevation_deg = -5, azimuth_deg = 200 },
  lamp = { on = false },
  camera = { width = 1200, height = 675, fov_deg = 62, exposure = { mode = "fixed", time = 0.02, iso = 1600, f_number = 2 } },
  trajectory = {
    rate_hz = 0.5,
    waypoints = {
      { t = 0, position = watch.position, look_at = watch.look_at }, { t = 4, position = watch.position, look_at = watch.look_at },
    },
  },
}
