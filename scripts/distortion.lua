-- A calibrated camera with the distortion of a cheap wide lens, as OpenCV and ROS state it.
return rubble.mission {
  seed = 3,
  pile = { layers = 1, pieces_per_layer = 40, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 } },
  camera = {
    width = 320,
    height = 240,
    lens = { model = "plumb_bob", fx = 190, fy = 191, cx = 161.3, cy = 118.9,
             k1 = -0.29, k2 = 0.09, p1 = 0.0004, p2 = -0.0003, k3 = -0.012 },
  },
  trajectory = {
    waypoints = {
      { t = 0, position = { -4, 0, 2 }, look_at = { 0, 0, 0.3 } },
      { t = 0.5, position = { -3.6, -0.5, 1.8 }, look_at = { 0, 0, 0.3 } },
    },
  },
}
