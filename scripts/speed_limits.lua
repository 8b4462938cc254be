-- Limits on speed, acceleration and turning: the path is unchanged, and the camera flies it more
-- slowly where a limit is reached.
return rubble.mission {
  seed = 2,
  pile = { layers = 1, pieces_per_layer = 60, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 } },
  camera = { width = 320, height = 240 },
  trajectory = {
    max_speed = 2.5, max_acceleration = 4, max_turn_rate_deg = 60,
    waypoints = {
      { t = 0, position = { -5, 0, 2 }, look_at = { 0, 0, 0.3 } },
      { t = 1, position = { 0, -4, 1.5 }, look_at = { 0, 0, 0.3 } },
      { t = 1.5, position = { 1, -4, 1.5 }, look_at = { 0, 0, 0.3 } },
    },
  },
}
