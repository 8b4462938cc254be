-- A fisheye of 190 degrees (Kannala-Brandt). Depth is along the optical axis, so pixels
-- at 90 degrees from the axis and beyond have none.
return rubble.mission {
  seed = 3,
  pile = { layers = 1, pieces_per_layer = 40, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 } },
  camera = {
    width = 320,
    height = 320,
    fov_deg = 190,
    lens = { model = "fisheye", k1 = -0.012, k2 = 0.004 },
  },
  trajectory = {
    waypoints = {
      { t = 0, position = { -4, 0, 2 }, look_at = { 0, 0, 0.3 } },
      { t = 0.5, position = { -3.6, -0.5, 1.8 }, look_at = { 0, 0, 0.3 } },
    },
  },
}
