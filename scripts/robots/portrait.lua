-- The crawler, the rover and the snake side by side: docs/pictures/robots.jpg.
return rubble.mission {
  seed = 4,
  pile = {
    layers = 1, pieces_per_layer = 14, spawn_position = { -1.1, 0, 0.5 }, spawn_bounds = { 0.5, 1.6, 0.5 },
    mix = { { asset = "brick" }, { asset = "cinder_block", weight = 0.3 } },
  },
  robots = {
    rubble.robot.crawler {
      name = "tank", position = { 0, 0.12, 0.001 },
      drive = { { t = 0, linear = 0, flippers_deg = { 32, 32, 50, 50 } } },
    },
    rubble.robot.rover { name = "scout", position = { 0.2, -0.68, 0.001 }, rpy_deg = { 0, 0, 8 } },
    rubble.robot.snake {
      name = "snake", position = { 0.7, -0.42, 0.03 }, rpy_deg = { 0, 0, -100 },
      drive = { { t = 0, gait = "sidewinding" } },
    },
  },
  robot_run = { duration = 1 },
  light = { type = "sun", elevation_deg = 42, azimuth_deg = -50 },
  camera = { width = 960, height = 528, fov_deg = 48 },
  trajectory = { rate_hz = 1, waypoints = {
    { t = 0, position = { 2.1, -0.55, 0.9 }, look_at = { 0.2, -0.12, 0.04 } },
    { t = 1, position = { 2.1, -0.55, 0.9 }, look_at = { 0.2, -0.12, 0.04 } },
  } },
  outputs = { frames = true, bag = false, rawlog = false, simplemap = false },
}
