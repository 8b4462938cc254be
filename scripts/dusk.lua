-- Dusk: the sun stands just below the horizon. Rescuers have put up a floodlight and a bulb, it has
-- rained, and the camera carries a ring of diodes.
return rubble.mission {
  seed = 2,
  pile = { layers = 1, pieces_per_layer = 40, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 } },
  light = { type = "sun", elevation_deg = -3, azimuth_deg = 30 },
  lights = {
    { type = "spot", intensity = 0.5, position = { -4, 3, 3 }, rpy_deg = { 0, 30, -37 }, cone_deg = 50 },
    { type = "point", intensity = 0.05, position = { 1.5, -2, 2 } },
  },
  wetness = 0.8,
  lamp = { shape = "ring", size = 0.1, intensity_cd = 40, cone_deg = 70 },
  camera = { width = 320, height = 240 },
}
