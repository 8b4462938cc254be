-- rubble.robot.follow_the_gap: a controller that drives a robot with tracks or wheels to a goal, around obstacles that
-- only its scanner sees (Sezer and Gokasan 2012, "A novel obstacle avoidance method: Follow the Gap
-- Method"). Of all directions that the robot fits through, it takes the one nearest to the goal.
local name = "rubble.robot.follow_the_gap"

return function(given)
  local o = rubble.options(name, given, {
    { "goal", {}, type = "table", doc = "Goal, relative to the start of the robot: {ahead, to the left}; unit: m." },
    { "scan", "scan", type = "string", doc = "Name of the 2-D scanner, which faces forwards; one of `senses`." },
    { "half_width", 0.27, min = 0.05, max = 5, unit = "m", doc = "Half the width of the robot, plus clearance." },
    { "look", 1.2, min = 0.2, max = 20, unit = "m", doc = "Length over which a direction must be free." },
    { "speed", 0.35, min = 0.01, max = 5, unit = "m/s", doc = "Forward velocity in free space." },
    { "turn", 1.2, min = 0.05, max = 10, unit = "rad/s", doc = "Largest angular velocity." },
    { "near", 0.3, min = 0.01, max = 10, unit = "m", doc = "Distance at which the goal is reached." },
  })
  local ahead, aside = o.goal[1] or o.goal.x, o.goal[2] or o.goal.y
  if type(ahead) ~= "number" or type(aside) ~= "number" or not (math.abs(ahead) + math.abs(aside) < math.huge) then
    rubble.reject(name, "goal", "a point {ahead, to the left}", o.goal)
    return function() return {} end
  end
  local seen = math.rad(90)  -- on both sides: what is behind that is the robot itself
  local ways = {}
  for i = -25, 25 do
    local angle = math.rad(4 * i)
    ways[#ways + 1] = { angle = angle, c = math.cos(angle), s = math.sin(angle) }
  end

  -- How far the robot gets in each direction: to the first point that is nearer to the line than half its width.
  local function measure(scan)
    local x, y = {}, {}
    for i = 1, #scan.ranges, 2 do
      local angle, range = scan.first_angle + scan.angle_step * (i - 1), scan.ranges[i]
      if math.abs(angle) < seen and range < o.look + o.half_width + 1 then
        x[#x + 1], y[#y + 1] = range * math.cos(angle), range * math.sin(angle)
      end
    end
    for _, way in ipairs(ways) do
      local c, s, free = way.c, way.s, o.look + 1
      for i = 1, #x do
        local along, off = x[i] * c + y[i] * s, y[i] * c - x[i] * s
        if along > 0 and along < free and off < o.half_width and off > -o.half_width then free = along end
      end
      way.free = free
    end
  end

  -- Dead reckoning: the way by odometry, the heading by the gyroscope.
  local px, py, yaw, last = 0, 0, 0, 0
  local command = {}
  return function(sense)
    if not sense.odometry then error(name .. ": this robot has no odometry", 2) end
    if not sense.lidars then error(name .. ": this robot senses no LiDAR: senses = { \"" .. o.scan .. "\" }", 2) end
    local dt = sense.t - last
    last = sense.t
    yaw = yaw + sense.imu.gyroscope[3] * dt
    px = px + sense.odometry.linear * dt * math.cos(yaw)
    py = py + sense.odometry.linear * dt * math.sin(yaw)
    local scan = sense.lidars[o.scan]
    if not scan then return command end  -- nothing new
    if not scan.ranges then error(name .. ": " .. o.scan .. " is not a 2-D scanner", 2) end
    local dx, dy = ahead - px, aside - py
    local far = math.sqrt(dx * dx + dy * dy)
    if far < o.near then
      command = {}
      return command
    end
    local bearing = math.atan(dy, dx) - yaw
    bearing = bearing - 2 * math.pi * math.floor(bearing / (2 * math.pi) + 0.5)
    measure(scan)
    local wanted, best, cheapest = math.min(o.look, far), nil, math.huge
    for _, way in ipairs(ways) do
      -- Where nothing is free far enough, the farthest counts most.
      local off = math.abs(way.angle - bearing)
      local cost = math.min(off, 2 * math.pi - off) + 4 * math.max(0, wanted - way.free)
      if cost < cheapest then best, cheapest = way, cost end
    end
    local slow = math.max(0, 1 - math.abs(best.angle) / 0.9)
    slow = slow * math.min(1, math.max(0, ways[26].free - 0.15) / 0.6)
    command = { linear = o.speed * slow, angular = math.max(-o.turn, math.min(o.turn, 2.5 * best.angle)) }
    return command
  end
end
