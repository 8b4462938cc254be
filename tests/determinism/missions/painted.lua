-- Meshes of a user with a picture of their own (glTF), and a car's glass, under a cloudy sky, by a lens with drops on it.
return rubble.mission {
  seed = 4,
  packs = { "pack", "concrete", "parking" },
  pile = {
    layers = 1, pieces_per_layer = 12, spawn_position = { 0, 0, 2.2 }, spawn_bounds = { 3, 3, 2 },
    mix = { { asset = "painted_block" }, { asset = "brick" } },
    placed = { { asset = "car_open", position = { 0.5, 1.6, 0.8 } } },
  },
  light = { type = "sun", sky = "cloudy", cloud_cover = 0.4, elevation_deg = 25, azimuth_deg = 220 },
  camera = {
    width = 96, height = 72,
    exposure = { mode = "automatic", f_number = 4, longest_time = 0.01 },
    optics = { point_spread = 0.6, glare = 0.03, focus_distance = 3, focal_length = 0.008, lateral_colour = 0.8, dirt = 0.3, drops = 4 },
    sensor = { mosaic = "rggb", prnu = 0.01, dsnu = 2, hot_pixels = 2e-3, jpeg_quality = 85, vignette = 1 },
  },
  trajectory = { waypoints = { { position = { -3, -1, 1.2 }, look_at = { 0.3, 0.6, 0.6 } } } },
}
