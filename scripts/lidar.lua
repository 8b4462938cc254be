-- LiDARs on the rig of a camera: a spinning one on top, a non-repeating one in front, a 2-D scanner low.
-- docs/reference/lidar.md says what each key does. The ground is as rough as a gravel yard: on a plane, scans look alike
-- from everywhere.
return rubble.mission {
  seed = 3,
  pile = { layers = 1, pieces_per_layer = 40, spawn_position = { 0, 0, 2.5 }, spawn_bounds = { 4, 4, 3 },
           terrain = rubble.terrain.rough { class = "C", level = 3, length = 40, width = 40 } },
  camera = { width = 160, height = 120, fov_deg = 80 },
  lidars = {
    top = { model = "vlp16", position = { 0, 0, 0.15 }, returns = "dual" },
    front = { model = "mid360", position = { 0.1, 0, 0 }, rpy_deg = { 0, 20, 0 } },
    low = { model = "utm30lx", position = { 0.1, 0, -0.1 } },
  },
  imu = { on = true },
  trajectory = {
    rate_hz = 10,
    waypoints = {
      { t = 0, position = { -4, 0, 1 }, look_at = { 0, 0, 0.3 } },
      { t = 1, position = { -3.2, -0.6, 0.8 }, look_at = { 0, 0, 0.3 } },
    },
  },
  outputs = { mcap = true, pcd = true, kitti = true },
}
