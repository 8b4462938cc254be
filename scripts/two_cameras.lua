-- Two cameras on one rig: each with its own place, lens, size, rate and names, and an inertial unit
-- with a lever arm.
return rubble.mission {
  seed = 3,
  pile = { layers = 1, pieces_per_layer = 40, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 } },
  cameras = {
    front = {
      width = 160,
      height = 120,
      fov_deg = 80,
      rate_hz = 12,
      position = { 0.1, 0, 0 },
    },
    left = {
      width = 96,
      height = 96,
      rate_hz = 8,
      position = { 0, 0.1, 0.02 },
      rpy_deg = { 0, 20, 90 },
      lens = { model = "fisheye", k1 = 0.02 },
      fov_deg = 150,
      channels = { "instance", "position" },
      topic = "/side/left",
    },
  },
  imu = { on = true, position = { -0.05, 0, 0.02 } },
  trajectory = {
    waypoints = {
      { t = 0, position = { -4, 0, 2 }, look_at = { 0, 0, 0.3 } },
      { t = 1, position = { -3.6, -0.5, 1.8 }, look_at = { 0, 0, 0.3 } },
    },
  },
}
