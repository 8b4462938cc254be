-- A crawler pushes bricks aside in snow: two LiDARs, encoders, contacts and an inertial unit on a body in motion.
return rubble.mission {
  seed = 3,
  pile = { layers = 1, pieces_per_layer = 25, spawn_bounds = { 0.8, 0.8, 1 }, mix = { { asset = "brick" } } },
  robots = {
    rubble.robot.crawler {
      name = "tank", position = { -1.9, 0, 0.001 },
      drive = { { t = 0, linear = 0.8, flippers_deg = { 45, 45, 60, 60 } }, { t = 1, linear = 0.4, angular = 0.8 } },
    },
  },
  robot_run = { duration = 2 },
  air = { snow_mm_h = 5 },
  imu = { on = true },
  camera = { width = 64, height = 48, fov_deg = 90 },
  lidars = {
    top = { model = "vlp16", position = { 0, 0, 0.15 }, returns = "dual" },
    front = { model = "mid360", position = { 0.1, 0, 0 }, rpy_deg = { 0, 20, 0 } },
  },
  trajectory = { rate_hz = 2, ride = { robot = "tank", link = "base_link", position = { 0.3, 0, 0.3 }, rpy_deg = { 0, 15, 0 } } },
  outputs = { mcap = true },
}
