-- Automatic exposure that lags: the camera turns from the sky to the ground and back, and some
-- frames are too bright or too dark.
return rubble.mission {
  seed = 3,
  pile = { layers = 1, pieces_per_layer = 40, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 } },
  camera = {
    width = 320,
    height = 240,
    exposure = { mode = "automatic", f_number = 4, longest_time = 0.01, time_constant = 0.15 },
  },
  trajectory = {
    waypoints = {
      { t = 0, position = { -4, 0, 1.6 }, rpy_deg = { 0, -35, 0 } },
      { t = 0.4, position = { -4, 0, 1.6 }, rpy_deg = { 0, 40, 0 } },
      { t = 1, position = { -4, 0, 1.6 }, rpy_deg = { 0, 40, 5 } },
      { t = 1.3, position = { -4, 0, 1.6 }, rpy_deg = { 0, -35, 5 } },
      { t = 2, position = { -4, 0, 1.6 }, rpy_deg = { 0, -35, 0 } },
    },
  },
}
