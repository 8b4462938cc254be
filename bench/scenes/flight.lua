-- What bench/scenes/run draws in the pile of any mission: 41 frames on the way from before the widest entrance of the deepest
-- void to its end, by day and by a lamp.
local void = rubble.find_void { radius = 0.15, by = "depth" }

return rubble.mission {
  light = { type = "sun", elevation_deg = 40, azimuth_deg = 30 },
  lamp = { on = true, intensity_cd = 60 },
  camera = { width = 640, height = 480, fov_deg = 90 },
  trajectory = {
    plan = "avoid", radius = 0.12, duration = 4, rate_hz = 10,
    waypoints = { { position = void.approach }, { position = void.deepest } },
  },
  outputs = { rawlog = false, simplemap = false, bag = false, stl = false, groundtruth = false, preview = false },
}
