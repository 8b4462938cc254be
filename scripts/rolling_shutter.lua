-- A rolling shutter: the rows are read one after another over 25 ms while the camera turns, so
-- upright edges lean. Depth and channels are those of each row's own time.
return rubble.mission {
  seed = 3,
  pile = { layers = 1, pieces_per_layer = 40, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 } },
  camera = { width = 320, height = 240, shutter = { readout = 0.025 }, channels = { "flow" } },
  trajectory = {
    waypoints = {
      { t = 0, position = { -4, 0, 1.6 }, rpy_deg = { 0, 15, -20 } },
      { t = 1, position = { -3.4, -0.6, 1.6 }, rpy_deg = { 0, 15, 60 } },
    },
  },
}
