-- Straight legs at a constant speed instead of a curve; pitch and yaw in degrees, positive pitch
-- looks down. A waypoint with a time but no way to go is a pause.
return rubble.mission {
  seed = 2,
  pile = { layers = 1, pieces_per_layer = 40, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 } },
  camera = { width = 160, height = 120 },
  trajectory = {
    interpolation = "linear",
    rate_hz = 10,
    speed = 4,
    waypoints = {
      { position = { -5, 0, 2 }, rpy_deg = { 0, 20, 0 } },
      { position = { -3, 0, 1.5 }, rpy_deg = { 0, 20, 0 } },
      { t = 1, position = { -3, 0, 1.5 }, rpy_deg = { 0, 20, 30 } },
    },
  },
}
