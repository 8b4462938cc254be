-- Rain over a pile by night: drops that cross the light of a street lamp and of the camera's own lamp while the
-- shutter is open.
--
--   rubble run scripts/weather.lua --set air.rain_mm_h=0 --set air.snow_mm_h=2 --set light.sky=overcast
return rubble.mission {
  seed = 5,
  pile = { layers = 1, pieces_per_layer = 60, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4.5, 4.5, 3 } },
  light = { type = "sun", sky = "city_night", elevation_deg = 25 },
  lights = { { type = "spot", intensity = 1.5, position = { 2.5, 4, 7 }, rpy_deg = { 0, 75, -125 }, cone_deg = 150 } },
  lamp = { intensity_cd = 60 },
  wetness = 0.8,
  air = { rain_mm_h = 20, wind = { 0.6, -1.2, 0 } },
  camera = {
    width = 320,
    height = 240,
    exposure = { mode = "automatic", f_number = 1.8, longest_time = 0.016, highest_iso = 6400 },
    optics = { focus_distance = 5, glare = 0.02 },
    sensor = { pixel_samples = 2 },
  },
  trajectory = { rate_hz = 10, waypoints = { { t = 0, position = { -5, -2, 1.5 }, look_at = { 0.5, 0.5, 1.3 } },
                                            { t = 0.2, position = { -4.9, -2, 1.5 }, look_at = { 0.5, 0.5, 1.3 } } } },
}
