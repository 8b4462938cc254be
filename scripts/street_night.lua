-- A moonless night under the glow of a town: two street lamps of 15 lx light the pile, and the camera's own
-- lamp is off. Exposure and noise are those of a real sensor.
return rubble.mission {
  seed = 5,
  pile = { layers = 1, pieces_per_layer = 40, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 } },
  light = { type = "sun", sky = "city_night" },
  lights = {
    { type = "spot", intensity = 0.75, position = { 3, 4.5, 7 }, rpy_deg = { 0, 62, -125 }, cone_deg = 150 },
    { type = "spot", intensity = 0.75, position = { 22, -6, 7 }, rpy_deg = { 0, 85, 0 }, cone_deg = 150 },
  },
  lamp = { on = false },
  camera = {
    width = 320,
    height = 240,
    exposure = { mode = "automatic", f_number = 1.8, longest_time = 0.03, highest_iso = 3200 },
    optics = { glare = 0.02, point_spread = 0.5 },
    sensor = { pixel_samples = 2, prnu = 0.01, hot_pixels = 1e-4 },
  },
  trajectory = { waypoints = { { position = { -4.5, -1.5, 1.3 }, look_at = { 0, 0, 1 } } } },
}
