-- A crawler with a camera, a lamp and an inertial unit on its body, driven over bricks in the dark. Its
-- encoders, motor torques, contacts and odometry are in the bag and in the MCAP file with the pictures.
return rubble.mission {
  seed = 11,
  pile = {
    layers = 1, pieces_per_layer = 40, spawn_bounds = { 1.6, 1.6, 1 },
    mix = { { asset = "brick" }, { asset = "cinder_block", weight = 0.3 } },
  },
  robots = {
    rubble.robot.crawler {
      name = "tank", position = { -1.8, 0, 0.001 },
      drive = {
        { t = 0, linear = 0.4, flippers_deg = { 45, 45, 60, 60 } },
        { t = 4, linear = 0.3, angular = 0.6, flippers_deg = { 20, 20, 0, 0 } },
      },
    },
  },
  robot_run = { duration = 6 },
  light = { type = "sun" },
  lamp = { on = true },
  camera = { width = 320, height = 240, fov_deg = 90 },
  imu = { on = true },
  trajectory = {
    rate_hz = 10,
    -- On a mast in front of the body, a little nose down.
    ride = { robot = "tank", link = "base_link", position = { 0.3, 0, 0.3 }, rpy_deg = { 0, 15, 0 } },
  },
  outputs = { bag = true, mcap = true, rawlog = true, euroc = true, simplemap = false },
}
