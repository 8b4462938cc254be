-- A real camera: a lens with glare, bloom, colour fringes, defocus and rain on its front, before a sensor
-- with a Bayer mosaic, fixed-pattern noise and hot pixels, whose images are compressed. The sun stands low
-- before it.
return rubble.mission {
  seed = 3,
  pile = { layers = 1, pieces_per_layer = 40, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 } },
  light = { type = "sun", elevation_deg = 14, azimuth_deg = 8 },
  camera = {
    width = 320,
    height = 240,
    exposure = { mode = "automatic", f_number = 1.8, longest_time = 0.01 },
    optics = {
      point_spread = 0.6,
      glare = 0.03,
      focus_distance = 3,
      focal_length = 0.008,
      lateral_colour = 0.8,
      dirt = 0.3,
      drops = 4,
    },
    sensor = {
      pixel_samples = 2,
      mosaic = "rggb",
      prnu = 0.01,
      dsnu = 2,
      hot_pixels = 2e-4,
      jpeg_quality = 85,
      vignette = 1,
    },
  },
  trajectory = { waypoints = { { position = { -4, -1, 1.2 }, look_at = { 0, 0, 0.9 } } } },
}
