-- A crawler drives from the open under a fallen slab, up to a wall. Its range finders see the wall come, its bumper feels it,
-- its GNSS receiver loses the sky. Readings are in sensors/NAME.csv, in the bag, in the MCAP file and in the rawlog.
local on_robot = { robot = "tank" }

return rubble.mission {
  seed = 6,
  pile = {
    layers = 0,
    placed = {
      { box = { 6, 5, 0.2 }, position = { 5.5, 0, 1.3 } },  -- the slab
      { box = { 0.3, 0.3, 1.2 }, position = { 3, 2, 0.6 } }, { box = { 0.3, 0.3, 1.2 }, position = { 3, -2, 0.6 } },
      { box = { 0.3, 5, 1.2 }, position = { 6, 0, 0.6 } },  -- the wall
    },
  },
  robots = { rubble.robot.crawler { name = "tank", position = { 0, 0, 0.001 }, drive = { { t = 0, linear = 0.6 } } } },
  robot_run = { duration = 10 },
  range_finders = {
    tof = { ride = on_robot, position = { 0.4, 0, 0.2 } },
    sonar = { ride = on_robot, position = { 0.4, 0, 0.25 }, radiation = "ultrasound", max_range = 5, rate_hz = 10 },
  },
  bumpers = { bow = { ride = on_robot, links = { "front_left_flipper", "front_right_flipper" }, threshold = 20 } },
  attitudes = { ahrs = { ride = on_robot } },
  barometers = { baro = { ride = on_robot, altitude = 40 } },
  magnetometers = { mag = { ride = on_robot } },
  batteries = { pack = { ride = on_robot } },
  gnss = { gps = { ride = on_robot, position = { -0.2, 0, 0.45 } } },
  imu = { on = true, ride = on_robot },
  camera = { width = 160, height = 120, fov_deg = 90 },
  trajectory = { rate_hz = 2, ride = { robot = "tank", position = { 0.3, 0, 0.35 } } },
  outputs = { mcap = true },
}
