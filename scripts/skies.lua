-- Broken clouds over a pile in Munich, on a summer's afternoon: the sun stands where place and time say.
-- X is east and Y is north. Other skies: light.sky = "hazy", "overcast", "moonlit", "city_night".
return rubble.mission {
  seed = 5,
  pile = { layers = 1, pieces_per_layer = 40, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 } },
  light = {
    type = "sun",
    sky = "cloudy",
    cloud_cover = 0.45,
    latitude_deg = 48.14,
    longitude_deg = 11.58,
    time = "2026-06-21T14:30:00Z",
  },
  camera = { width = 320, height = 240 },
  trajectory = { waypoints = { { position = { -4.5, -1.5, 1.3 }, look_at = { 0, 0, 1.4 } } } },
}
