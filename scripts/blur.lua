-- A camera that turns fast in poor light: long exposures blur, and the sensor is noisy.
return rubble.mission {
  seed = 3,
  pile = { layers = 1, pieces_per_layer = 40, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 } },
  light = { intensity = 0.02 },
  camera = {
    width = 320,
    height = 240,
    shutter = { motion_blur = true },
    exposure = { mode = "fixed", time = 0.02, iso = 1600, f_number = 2 },
    sensor = { full_well = 9000, read_noise = 5, bits = 10, vignette = 1 },
  },
  trajectory = {
    waypoints = {
      { t = 0, position = { -4, 0, 1.6 }, rpy_deg = { 0, 15, -20 } },
      { t = 1, position = { -3.4, -0.6, 1.6 }, rpy_deg = { 0, 15, 60 } },
    },
  },
}
