-- A camera with a body of 15 cm that must not touch anything. If you move the last waypoint into the
-- heap, the run stops and states the time and the place of the contact.
return rubble.mission {
  seed = 2,
  pile = { layers = 1, pieces_per_layer = 60, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 } },
  camera = { width = 320, height = 240 },
  trajectory = {
    plan = "refuse", radius = 0.15,
    waypoints = {
      { t = 0, position = { -5, -1, 1.5 }, look_at = { 0, 0, 0.3 } },
      { t = 1, position = { -4, 0, 1.8 }, look_at = { 0, 0, 0.3 } },
    },
  },
}
