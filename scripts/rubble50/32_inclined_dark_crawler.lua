-- Rubble-50, mission 32: docs/explanation/rubble50.md. Made by tools/rubble50.py.
local keys = rubble.include("fifty.lua")("inclined", "dark", "crawler")
return rubble.mission {
  seed = 32,
  pile = keys.pile,
  light = keys.light, lamp = keys.lamp, air = keys.air, wetness = keys.wetness,
  robots = keys.robots, robot_run = keys.robot_run, trajectory = keys.trajectory,
  camera = keys.camera, depth_sensor = keys.depth_sensor, imu = { on = true },
  settle = { final_time_limit = 60 },
  outputs = keys.outputs,
}
