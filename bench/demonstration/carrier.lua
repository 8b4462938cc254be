-- A robot goes straight over a bed of bricks: how its camera shakes there is added to the planned way of the
-- demonstration (carriers.py).
local robot = rubble.parameter("robot", "crawler", { choices = { "crawler", "snake", "vine" }, doc = "What goes over the bricks." })
local seconds = rubble.parameter("seconds", 12, { min = 1, max = 60, unit = "s", doc = "Time of the drive." })

local robots = {
  crawler = function()
    return rubble.robot.crawler {
      name = "carrier", position = { -3.6, 0, 0.001 }, drive = { { t = 0, linear = 0.5, flippers_deg = { 40, 40, 40, 40 } } },
    }
  end,
  snake = function()
    return rubble.robot.snake { name = "carrier", position = { -3.6, 0, 0.03 }, drive = { { t = 0, gait = "serpenoid" } } }
  end,
  vine = function()
    return rubble.robot.vine {
      name = "carrier", position = { -3.6, 0, 0.2 }, length = 6, pressure = 15e3, drive = { { t = 0, growth = 0.3 } },
    }
  end,
}
return rubble.mission {
  seed = 1,
  pile = {
    layers = 1, pieces_per_layer = 120, spawn_position = { 0, 0, 0.6 }, spawn_bounds = { 5, 1.4, 0.6 },
    mix = { { asset = "brick" }, { asset = "half_brick" }, { asset = "chunk_6" } },
  },
  robots = { robots[robot]() },
  robot_run = { duration = seconds },
  camera = { width = 32, height = 32 },
  trajectory = { waypoints = { { position = { -4, -3, 2 }, look_at = { 0, 0, 0 } } } },
  outputs = { rawlog = false, bag = false, simplemap = false, stl = false, preview = false },
}
