-- Small, with all recorders, a robot, a LiDAR and an inertial unit: what tools/package_arm64.sh tries under an emulator. Its pieces
-- have no joints: Debian's Simbody for arm64 rounds otherwise (docs/explanation/determinism.md).
return rubble.mission {
  seed = 5,
  packs = { "concrete", "residential" },
  pile = { layers = 1, pieces_per_layer = 20, spawn_bounds = { 2, 2, 1 } },
  robots = { rubble.robot.rover { name = "rover", position = { -3, 0, 0.001 }, drive = { { t = 0, linear = 0.4 } } } },
  robot_run = { duration = 1 },
  camera = { width = 96, height = 72, fov_deg = 80 },
  depth_sensor = { type = "structured_light" },
  lidars = { points = { model = "vlp16", ride = { robot = "rover" }, position = { 0, 0, 0.4 } } },
  imu = { on = true },
  lamp = { on = true },
  trajectory = { rate_hz = 4, ride = { robot = "rover", position = { 0.2, 0, 0.3 } } },
  outputs = { bag = true, mcap = true, rawlog = true, tum = true, stl = true, pcd = true, kitti = true },
}
