-- A snake of 16 modules sidewinds over the ground beside a small pile.
return rubble.mission {
  seed = 2,
  pile = { layers = 1, pieces_per_layer = 40, spawn_bounds = { 2, 2, 1 } },
  robots = {
    rubble.robot.snake {
      position = { -2.4, 1, 0.03 },
      drive = {
        { t = 0, gait = "sidewinding" },
        { t = 5, gait = "rolling" },
      },
    },
  },
  robot_run = { duration = 8 },
  camera = { width = 320, height = 240, fov_deg = 70 },
  trajectory = { rate_hz = 5, waypoints = {
    { t = 0, position = { -4, -2, 1.5 }, look_at = { -2, 0.8, 0.1 } },
    { t = 8, position = { -4, -1, 1.5 }, look_at = { -2, 0.8, 0.1 } },
  } },
}
