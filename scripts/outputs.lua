-- All formats of docs/reference/formats.md, with all channels.
return rubble.mission {
  seed = 2,
  start_ns = 1700000000000000000,
  pile = { layers = 1, pieces_per_layer = 20, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 3, 3, 3 } },
  camera = { width = 160, height = 120, channels = { "normals", "instance", "label", "flow" } },
  imu = { on = true, rate_hz = 200 },
  trajectory = {
    waypoints = {
      { t = 0, position = { -4, 0, 2 }, look_at = { 0, 0, 0.3 } },
      { t = 0.2, position = { -3.6, -0.5, 1.8 }, look_at = { 0, 0, 0.3 } },
    },
  },
  outputs = {
    mcap = true, tum = true, euroc = true, colmap = true, frames = true,
    kitti_odometry = true, nerfstudio = true, coco = true, webdataset = true, lerobot = true,
    meshes = { "ply", "obj", "glb", "sdf" },
    depth = "32FC1",
  },
}
