-- Crushed cars on a plane, to look through their windscreens: see glass_views.json.
return rubble.mission {
  seed = 4,
  packs = { "parking" },
  pile = {
    layers = 0,
    placed = {
      { asset = "car_open", position = { 0, 0, 0.68 } },
      { asset = "car_roof", position = { 3.2, 2.6, 0.6 }, rpy_deg = { 0, 0, 70 } },
      { asset = "car_front", position = { -1.5, 3.4, 0.7 }, rpy_deg = { 0, 0, 200 } },
    },
  },
  light = { type = "sun", elevation_deg = 35, azimuth_deg = 200 },
  lamp = { on = false },
  camera = { width = 960, height = 720, fov_deg = 60 },
  trajectory = { waypoints = { { position = { -3.4, 2.0, 1.5 }, look_at = { -1.7, 3.4, 0.95 } } } },
  outputs = { frames = true },
}
