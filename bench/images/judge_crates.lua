-- Painted blocks for the judged views: the images and colours of users' files, as our exporter hands them on.
return rubble.mission {
  seed = 7,
  packs = { "judge_pack" },
  pile = { layers = 2, pieces_per_layer = 9, spawn_position = { 0, 0, 1.6 }, spawn_bounds = { 1.4, 1.4, 1.6 } },
  light = { rpy_deg = { 0, 48, 60 } },
  camera = { fov_deg = 45 },
  trajectory = { waypoints = { { position = { -2.4, -0.6, 2.3 }, look_at = { 0, 0, 0.2 } } } },
}
