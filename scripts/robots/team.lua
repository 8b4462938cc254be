-- A crawler, a snake and a rover in one mission, each with sensors of its own: cameras with lamps and inertial
-- units on their links, a LiDAR on the rover. A camera that stands beside them sees all three.
return rubble.mission {
  seed = 5,
  pile = {
    layers = 1, pieces_per_layer = 40, spawn_bounds = { 1.6, 1.6, 1 },
    mix = { { asset = "brick" }, { asset = "cinder_block", weight = 0.3 } },
  },
  robots = {
    rubble.robot.crawler {
      name = "tank", position = { -1.9, 0, 0.001 },
      drive = { { t = 0, linear = 0.35, flippers_deg = { 45, 45, 60, 60 } } },
    },
    rubble.robot.snake { name = "snake", position = { -1.6, 1.3, 0.03 }, drive = { { t = 0, gait = "sidewinding" } } },
    rubble.robot.rover {
      name = "scout", position = { -1.6, -1.3, 0.001 }, drive = { { t = 0, linear = 0.4, angular = 0.4 } },
    },
  },
  robot_run = { duration = 4 },
  light = { type = "sun" },
  lamp = { on = true, intensity_cd = 30 },
  cameras = {
    overview = { width = 320, height = 240, fov_deg = 90 },
    tank_front = { ride = { robot = "tank" }, position = { 0.32, 0, 0.3 }, rpy_deg = { 0, 15, 0 },
                   width = 320, height = 240, fov_deg = 90 },
    snake_head = { ride = { robot = "snake", link = "head" }, position = { 0.05, 0, 0 },
                   width = 160, height = 120, fov_deg = 110 },
    scout_front = { ride = { robot = "scout" }, position = { 0.22, 0, 0.25 }, rate_hz = 2,
                    width = 320, height = 240, fov_deg = 90 },
  },
  imus = {
    tank_imu = { ride = { robot = "tank" }, rate_hz = 200 },
    snake_imu = { ride = { robot = "snake", link = "head" }, rate_hz = 100 },
  },
  lidars = { scout_lidar = { model = "utm30lx", ride = { robot = "scout" }, position = { 0, 0, 0.3 }, rate_hz = 5 } },
  trajectory = { rate_hz = 5, waypoints = {
    { t = 0, position = { -2.5, -2.1, 1.2 }, look_at = { -1.2, 0.1, 0.1 } },
    { t = 4, position = { -2, -2.2, 1.2 }, look_at = { -0.7, 0, 0.1 } },
  } },
  outputs = { bag = true, mcap = true, rawlog = true },
}
