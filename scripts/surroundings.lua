-- A pile in its street: kerbs, fronts, trees, parked cars, lamps, a skyline. The seed draws all of them.
--
--   rubble run scripts/surroundings.lua --set light.sky=city_night
return rubble.mission {
  seed = 21,
  surroundings = { type = "street", storeys = { 2, 5 } },
  fines = { amount = 20000 },
  light = { type = "sun", sky = "cloudy", cloud_cover = 0.35, elevation_deg = 38, azimuth_deg = 250 },
  pile = { layers = 3, pieces_per_layer = 170, spawn_bounds = { 7, 7, 5 } },
  settle = { final_time_limit = 30 },
  lamp = { on = false },
  camera = { width = 1280, height = 960, fov_deg = 70, channels = { "label", "instance" } },
  outputs = { rawlog = false, simplemap = false, bag = false, stl = false, frames = true },
  trajectory = {
    rate_hz = 1,
    interpolation = "linear",
    waypoints = {
      { t = 0, position = { -8, -10, 1.7 }, look_at = { 1, 0, 1.6 } },
      { t = 1, position = { 9.5, -7, 1.7 }, look_at = { -4, 1, 1.5 } },
      { t = 2, position = { -2, 12, 1.7 }, look_at = { 0, -6, 2 } },
      { t = 3, position = { -17, -13, 9 }, look_at = { 3, -2, 1 } },
    },
  },
}
