-- The film of the demo (tools/draw_film.py), in two parts: a camera outside records how the building comes down; then it
-- watches the robot, whose own camera sees the way in.
--   rubble run scripts/film.lua --set part=way --out out/film/way
local part = rubble.parameter("part", "collapse", { choices = { "collapse", "way" }, doc = "Part of the film." })
local mission = rubble.include("demo.lua")
mission.outputs = { frames = true, bag = false, rawlog = false, simplemap = false }

local outside = { width = 640, height = 360, fov_deg = 60, exposure = { mode = "automatic" } }
if part == "collapse" then
  mission.robots, mission.robot_run, mission.lidars, mission.imu = nil, nil, nil, nil
  mission.camera = outside
  mission.record_settling = { rate_hz = 24 }  -- shown at half speed
  mission.trajectory = { waypoints = { { position = { -9.5, -12.5, 3 }, look_at = { 0, 0, 2.2 } } } }
  return mission
end

local ride = mission.trajectory.ride
local front = mission.camera
front.ride, front.position, front.rpy_deg = { robot = ride.robot }, ride.position, ride.rpy_deg
mission.camera, mission.lidars, mission.imu = nil, nil, nil
mission.cameras = { front = front, outside = outside }
mission.trajectory = {
  rate_hz = 12,
  waypoints = {
    { t = 0, position = { -7.5, -10, 1.9 }, look_at = { -3, -5.5, 0.6 } },
    { t = mission.robot_run.duration, position = { -4.6, -7.6, 0.9 }, look_at = { -1.6, -3.6, 0.5 } },
  },
}
return mission
