-- The mission of `make demo`: an earthquake brings down a car park, and a crawler drives by its lamp, through dust,
-- into what is left between the cars. Copy this page to start a mission of your own.
--   rubble run scripts/demo.lua --out out/demo
--   rubble run scripts/demo.lua --seed 2 --out out/other   # another ruin: the robot's path may be blocked

-- What falls. Two storeys of a frame whose ground storey is weak; cars stand on both floors.
local building = rubble.building {
  storeys = 2, bays_x = 2, bays_y = 2, span_x = 5.5, span_y = 5, column = 0.3, infill = "none", piece = 1.3,
  furniture = { { asset = "car_side", per_bay = 1.2 } },
  cause = { shake = 7, weak_storey = 0, weakness = 0.1 },
}

-- A robot that follows a path: its points are {x, y}, in metres. `rubble voids out/demo` draws where there is room.
local crawler = rubble.robot.crawler {
  name = "tank", position = { -1.1, -6.8, 0.001 }, rpy_deg = { 0, 0, 90 }, odometry_noise = 0.001,
  lamps = { { position = { 0.28, 0, 0.28 }, rpy_deg = { 0, -5, 0 }, intensity_cd = 200, cone_deg = 120 } },  -- wider than what the camera sees
  control = rubble.robot.follow {
    path = { { -1.1, -6.8 }, { -1.1, -5.8 }, { -0.9, -4.8 }, { -0.4, -3.7 }, { -0.4, -1.5 } }, speed = 0.35,
    flippers = { 0.7, 0.7, 0.7, 0.7 },
  },
}

return rubble.mission {
  seed = 22,
  packs = { "parking" },
  pile = building,
  robots = { crawler },
  robot_run = { duration = 16 },

  -- Dust that hangs in the air, in billows and near the ground. Bursts of dust (`dust`) and wind cost more time a frame.
  air = { fog_density = 0.1, fog_height = 1.5, fog_noise = 0.8 },

  -- What is measured: colour and depth of a camera on a mast, a LiDAR, an inertial unit.
  light = { type = "sun", elevation_deg = -4, azimuth_deg = 230 },  -- dusk
  camera = { width = 480, height = 360, fov_deg = 80, exposure = { mode = "automatic", compensation = -0.5 } },
  lamp = { on = false },
  trajectory = { rate_hz = 1, ride = { robot = "tank", position = { 0.25, 0, 0.35 }, rpy_deg = { 0, -6, 0 } } },
  lidars = { top = { model = "os0", columns = 512, rate_hz = 2, ride = { robot = "tank" }, position = { 0, 0, 0.45 } } },
  imu = { on = true },
  outputs = { bag = true, rawlog = true, simplemap = false },
}
