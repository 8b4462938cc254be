-- A tracked crawler drives into a heap of bricks, climbs with its flippers and pushes some aside.
return rubble.mission {
  seed = 3,
  pile = {
    layers = 2, pieces_per_layer = 60, spawn_bounds = { 1.6, 1.6, 1 },
    mix = { { asset = "brick" } },
  },
  robots = {
    rubble.robot.crawler {
      position = { -2.2, 0, 0.001 },
      drive = {
        { t = 0, linear = 0.4, flippers_deg = { 50, 50, 60, 60 } },
        { t = 4, linear = 0.4, flippers_deg = { 0, 0, -20, -20 } },
      },
    },
  },
  robot_run = { duration = 8 },
  camera = { width = 320, height = 240, fov_deg = 70 },
  trajectory = { rate_hz = 5, waypoints = {
    { t = 0, position = { -2.5, -2.5, 1.6 }, look_at = { -0.6, 0, 0.1 } },
    { t = 8, position = { -1.5, -2.8, 1.6 }, look_at = { 0, 0, 0.1 } },
  } },
}
