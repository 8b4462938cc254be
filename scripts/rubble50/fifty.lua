-- The parts that the missions of Rubble-50 are made of: structures, conditions and carriers.
-- docs/explanation/rubble50.md has the table and the rules.
local function debris(pieces) return { layers = 1, pieces_per_layer = pieces } end

local structures = {}
function structures.heap()
  return rubble.collapse.heap { layers = 3, pieces_per_layer = 70, length = 5, width = 5, height = 4 }
end
function structures.lean_to()
  return rubble.collapse.lean_to { length = 5, height = 2, storeys = 2, debris = debris(80) }
end
function structures.cantilever()
  return rubble.collapse.cantilever { length = 4, height = 2.2, droop_deg = 18, debris = debris(80) }
end
function structures.v_shape() return rubble.collapse.v_shape { length = 8, height = 1.8, debris = debris(80) } end
function structures.a_frame() return rubble.collapse.a_frame { length = 9, height = 2.2, debris = debris(80) } end
function structures.pancake()
  return rubble.collapse.pancake { length = 7, width = 5, storeys = 3, gap = 0.6, tilt_deg = 3, debris = debris(60) }
end
function structures.inclined()
  return rubble.collapse.inclined { length = 5, dip_deg = 20, spread_deg = 10, storeys = 3, debris = debris(60) }
end
function structures.lean_over()
  return rubble.collapse.lean_over {
    length = 3.5, storey_height = 2.4, lean_deg = 40, storeys = 1, width = 5, debris = debris(60),
  }
end
function structures.culvert()
  return rubble.collapse.culvert {
    bore = 0.9, segments = 3, rows = 3, spacing = 0.25, debris = { layers = 2, pieces_per_layer = 80 },
  }
end
function structures.curtain() return rubble.collapse.curtain { length = 5, storeys = 1, debris = debris(40) } end

local lamp = { on = true, intensity_cd = 60 }
local conditions = {
  clear = { light = { type = "sun", elevation_deg = 40, azimuth_deg = 30 } },
  dark = { light = { type = "sun", elevation_deg = -18 }, lamp = lamp },
  smoke = {
    light = { type = "sun", elevation_deg = 25 }, lamp = lamp,
    air = { fog_density = 0.2, fog_intensity = 0.8 },
  },
  dust = {
    light = { type = "sun", elevation_deg = 40 }, lamp = lamp,
    air = {
      fog_density = 0.08, fog_height = 1.5,
      dust = { period = 1.5, position = { 0, 0, 0.5 }, bounds = { 4, 4, 0.5 }, density = 3 },
    },
  },
  wet = { light = { type = "sun", elevation_deg = -3, azimuth_deg = 30 }, lamp = lamp, wetness = 0.8 },
}

-- A robot starts beside the pile and drives at it for ten seconds; what it then does is the test.
local function ridden(robot, ride)
  ride.robot = "base"
  return { robots = { robot }, robot_run = { duration = 10 }, trajectory = { rate_hz = 15, ride = ride } }
end
local function start(structure, x)
  return structure == "lean_over" and x - 2 or x  -- whose debris reaches farther
end
local carriers = {}
function carriers.orbit()
  return { trajectory = rubble.trajectory.orbit { radius_m = 8, height = 2.5, turns = 0.25, speed = 1.2 } }
end
function carriers.push()
  return { trajectory = { rate_hz = 15, waypoints = {
    { t = 0, position = { -8, -1.5, 1.2 }, look_at = { 0, 0, 0.6 } },
    { t = 10, position = { -5.5, 1.5, 0.9 }, look_at = { 0, 0, 0.4 } },
  } } }
end
function carriers.crawler(structure)
  local drive = {
    { t = 0, linear = 0.4, flippers_deg = { 45, 45, 60, 60 } },
    { t = 6, linear = 0.4, angular = 0.3, flippers_deg = { 20, 20, 0, 0 } },
  }
  return ridden(rubble.robot.crawler { name = "base", position = { start(structure, -6.5), 0.3, 0.001 }, drive = drive },
                { position = { 0.3, 0, 0.3 }, rpy_deg = { 0, 10, 0 } })
end
function carriers.rover(structure)
  local drive = { { t = 0, linear = 0.4 } }
  return ridden(rubble.robot.rover { name = "base", position = { start(structure, -6.5), -0.4, 0.001 }, drive = drive },
                { position = { 0.2, 0, 0.3 }, rpy_deg = { 0, 5, 0 } })
end
function carriers.snake(structure)
  local drive = { { t = 0, gait = "sidewinding" } }
  return ridden(rubble.robot.snake { name = "base", position = { start(structure, -6), 1, 0.03 }, drive = drive },
                { position = { 0.05, 0, 0.04 } })
end

-- The keys that structure, condition and carrier bring, and what all fifty have in common.
return function(structure, condition, carrier)
  local keys = {
    pile = structures[structure](),
    camera = { width = 640, height = 480, fov_deg = 80 },
    depth_sensor = { type = "structured_light" },
    outputs = { bag = true, tum = true, rawlog = false, simplemap = false },
  }
  for _, part in ipairs { conditions[condition], carriers[carrier](structure) } do
    for key, value in pairs(part) do keys[key] = value end
  end
  return keys
end
