-- A robot drives through a walled yard with rubble and walls left standing, for SLAM programs that read rawlogs
-- (docs/how_to/mrpt_slam.md). Choose robot, LiDAR and time by --set robot=rover, --set lidar=vlp16, --set seconds=60.
local robot = rubble.parameter("robot", "crawler", { choices = { "crawler", "rover" }, doc = "What drives." })
local lidar = rubble.parameter("lidar", "utm30lx", { choices = { "utm30lx", "vlp16" }, doc = "What scans." })
local pieces = rubble.parameter("pieces", 30, { type = "integer", min = 0, max = 2000, doc = "Pieces of rubble in the yard." })
local seconds = rubble.parameter("seconds", 50, { min = 1, max = 600, unit = "s", doc = "Time of the drive." })

local function wall(x, y, length, width)
  return { box = { length, width, 2 }, position = { x, y, 1 }, material = "brick" }
end
-- Along the wall in the south, around the corner, and along the wall in the east. The rover's four wheels skid: it turns
-- by less than half of what it is told.
local turn = robot == "rover" and 6.6 or 3
local drive = { { t = 0, linear = 0.5 }, { t = 18, linear = 0.2, angular = 0.5 }, { t = 18 + turn, linear = 0.5 },
                { t = 35 + turn, linear = 0.2, angular = 0.5 }, { t = 35 + 2 * turn, linear = 0.5 } }

return rubble.mission {
  seed = 5,
  pile = {
    layers = pieces > 0 and 1 or 0, pieces_per_layer = pieces, spawn_position = { 0, 0, 1.5 }, spawn_bounds = { 5, 5, 1.5 },
    mix = { { asset = "cinder_block" }, { asset = "chunk_1" } },
    placed = {
      wall(0, 6, 12, 0.2), wall(0, -6, 12, 0.2), wall(6.2, 0, 0.2, 11.7), wall(-6.2, 0, 0.2, 11.7),
      wall(3, 4.5, 1, 2), wall(-2, 3, 0.3, 3), wall(1.5, -3.2, 2, 0.3),
    },
  },
  robots = { rubble.robot[robot] { name = "tank", position = { -5, -5, 0.001 }, odometry_noise = 0.001, drive = drive } },
  robot_run = { duration = seconds },
  lidars = { low = { model = lidar, ride = { robot = "tank" }, position = { 0.1, 0, 0.3 }, rate_hz = 10 } },
  imus = { inertial = { ride = { robot = "tank" } } },
  camera = { width = 160, height = 120, fov_deg = 90 },
  trajectory = { rate_hz = 2, ride = { robot = "tank", position = { 0.25, 0, 0.35 } } },
  lamp = { on = true },
  outputs = { rawlog = true, bag = false, simplemap = false, stl = false, preview = false },
}
