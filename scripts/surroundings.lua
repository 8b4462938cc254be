-- A pile in its street: kerbs, fronts, trees, parked cars, lamps, a skyline. The seed draws all of them.
--
--   rubble run scripts/surroundings.lua --set light.sky=city_night --set camera.exposure.mode=automatic
return rubble.mission {
  seed = 21,
  surroundings = { type = "street", storeys = { 2, 5 }, reach = 70 },
  light = { type = "sun", elevation_deg = 30, azimuth_deg = 250 },
  pile = { layers = 2, pieces_per_layer = 120, spawn_bounds = { 7, 7, 5 } },
  lamp = { on = false },
  camera = {
    width = 1024,
    height = 768,
    fov_deg = 70,
    exposure = { mode = "ideal", f_number = 1.8, compensation = -0.7, longest_time = 0.03, highest_iso = 6400 },
    channels = { "label", "instance" },
  },
  outputs = { rawlog = false, simplemap = false, bag = false, stl = false, frames = true },
  trajectory = {
    rate_hz = 1,
    interpolation = "linear",
    waypoints = {
      { t = 0, position = { 13, -14, 1.7 }, look_at = { -20, -13, 3 } },    -- along the street
      { t = 1, position = { -1, 10, 1.7 }, look_at = { 0.5, -6, 2.2 } },    -- over the pile, to the fronts
      { t = 2, position = { -14, -18, 14 }, look_at = { 3, -1, 0 } },       -- from a drone
      { t = 3, position = { 4.5, -10.2, 1.7 }, look_at = { -2.5, 2, 1.2 } },  -- from the pavement
    },
  },
}
