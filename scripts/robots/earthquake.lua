-- A crawler explores a house that an earthquake brought down: smoke between the pieces, a camera, a LiDAR and an inertial
-- unit on its body, odometry as noisy as that of real tracks. It drives to the far side of the ruin by what its scanner sees;
-- what it touches can move.
--   rubble run scripts/robots/earthquake.lua --set goal=8 --seed 3
local storeys = rubble.parameter("storeys", 2, { type = "integer", min = 1, max = 4, doc = "Storeys of the house." })
local goal = rubble.parameter("goal", 9, { min = 1, max = 20, unit = "m", doc = "How far it shall get." })
local seconds = rubble.parameter("seconds", 40, { min = 1, max = 600, unit = "s", doc = "Time of the drive." })

return rubble.mission {
  seed = 4,
  packs = { "residential" },
  pile = rubble.building {
    storeys = storeys, bays_x = 2, bays_y = 1, span_x = 4, span_y = 4, column = 0.25, piece = 1.3, continuity = 0.3,
    infill = "brick", openings = 0.5,
    furniture = { { asset = "table", per_bay = 1 }, { asset = "chair", per_bay = 2 }, { asset = "mattress", per_bay = 0.5 } },
    cause = { shake = 8, shake_seconds = 8, weak_storey = 0, weakness = 0.3 },
  },
  settle = { final_time_limit = 60 },
  air = { fog_density = 0.05, fog_height = 1.5, fog_noise = 0.8 },
  robots = {
    rubble.robot.crawler {
      name = "tank", position = { -7, -0.6, 0.001 }, odometry_noise = 0.001, lamps = { {} }, senses = { "scan" },
      control = rubble.robot.follow_the_gap { goal = { goal, 0 }, speed = 0.4 },
    },
  },
  robot_run = { duration = seconds },
  lidars = { scan = { model = "utm30lx", rate_hz = 10, ride = { robot = "tank" }, position = { 0.2, 0, 0.3 } } },
  imu = { on = true },
  camera = { width = 320, height = 240, fov_deg = 90 },
  lamp = { on = true, intensity_cd = 40 },
  trajectory = { rate_hz = 5, ride = { robot = "tank", position = { 0.25, 0, 0.35 } } },
  outputs = { bag = true, mcap = true, rawlog = true, simplemap = false },
}
