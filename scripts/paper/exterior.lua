-- The published demonstration, outside: 126 frames around the pile in daylight.
local demonstration_pile = rubble.include("demonstration_pile.lua")

local trajectory = rubble.trajectory.orbit { centre = { 0, 0, 0.8 }, radius_m = 11, height = 3.5, turns = 0.3 }
trajectory.duration = 125 / 30
return rubble.mission {
  seed = 1,
  pile = demonstration_pile(),
  light = { intensity = 80, rpy_deg = { 0, 45, 40 } },
  lamp = { on = false },
  camera = { width = 1024, height = 1024, fov_deg = 80 },
  trajectory = trajectory,
}
