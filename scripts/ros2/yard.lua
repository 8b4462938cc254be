-- A rover with LiDAR, 2-D scanner, camera and inertial unit in a yard, for the ROS 2 programs that the files beside this one
-- configure (docs/how_to/live.md): `rubble serve` for a robot that they drive, `rubble run --ros2` for a drive with pictures.
local driver = rubble.parameter("driver", "velodyne", { choices = { "velodyne", "ouster", "livox" }, doc = "Whose LiDAR it is." })
local pieces = rubble.parameter("pieces", 60, { type = "integer", min = 1, max = 2000, doc = "Pieces of rubble in the yard." })
local models = { velodyne = "vlp16", ouster = "os1", livox = "mid360" }

local function wall(x, y, length, width)
  return { box = { length, width, 2 }, position = { x, y, 1 }, material = "brick" }
end

return rubble.mission {
  seed = 5,
  pile = {
    layers = 1, pieces_per_layer = pieces, spawn_position = { 1, 1, 2 }, spawn_bounds = { 5, 5, 2 },
    mix = { { asset = "cinder_block" }, { asset = "chunk_1" } },
    placed = { wall(0, 6, 12, 0.2), wall(0, -6, 12, 0.2), wall(6.2, 0, 0.2, 11.7), wall(-6.2, 0, 0.2, 11.7), wall(2, -3, 2, 0.3) },
  },
  robots = { rubble.robot.rover { name = "rover", position = { -5, -4.5, 0.001 }, drive = { { t = 0, linear = 0.4 }, { t = 15, linear = 0.3, angular = 0.4 } } } },
  robot_run = { duration = 30 },
  lidars = {
    top = { model = models[driver], driver = driver, ride = { robot = "rover" }, position = { 0, 0, 0.4 } },
    low = { model = "utm30lx", ride = { robot = "rover" }, position = { 0.15, 0, 0.25 }, rate_hz = 10 },
  },
  imu = { on = true, ride = { robot = "rover" } },
  attitudes = { ahrs = { rate_hz = 200, ride = { robot = "rover" } } },
  camera = { width = 320, height = 240, fov_deg = 80 },
  trajectory = { rate_hz = 10, ride = { robot = "rover", position = { 0.2, 0, 0.3 } } },
  outputs = { mcap = true, bag = false, rawlog = false, simplemap = false, stl = false },
}
