-- In smoke under a leaning slab with a lamp: colour with a sensor's faults, every channel, all that is recorded.
return rubble.mission {
  seed = 7,
  pile = rubble.collapse.lean_to {},
  light = { type = "sun" },
  lamp = { on = true },
  air = { fog_density = 0.15, fog_noise = 0.7, wind = { 0.3, 0.1, 0 } },
  imu = { on = true },
  camera = {
    width = 96, height = 72, fov_deg = 80,
    channels = { "normals", "instance", "label", "flow", "position" },
    exposure = { mode = "automatic", f_number = 1.8, longest_time = 0.02, highest_iso = 3200 },
  },
  trajectory = { rate_hz = 5, waypoints = {
    { t = 0, position = { -1.6, -1.2, 0.5 }, look_at = { 0.6, 0.2, 0.5 } },
    { t = 0.4, position = { -1.3, -1, 0.55 }, look_at = { 0.6, 0.2, 0.4 } },
  } },
  outputs = { mcap = true, depth = "32FC1" },
}
