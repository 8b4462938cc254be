-- rubble.trajectory.join(parts, options): one path from several, one after another. Each part is a path of
-- `rubble.trajectory`, a list of waypoints, or a waypoint. The camera flies from the end of one part to the start of the
-- next at `speed`. Rate, plan, radius and limits are those of the options.
local name = "rubble.trajectory.join"

-- Options of a path that the joined one has of its own, with what a path has where it says nothing.
local given_once = {
  rate_hz = 30, plan = "ghost", radius = 0.1, max_speed = false, max_acceleration = false, max_turn_rate_deg = false,
  max_jerk = false, smoothing = false, rest_at_ends = false,
}

local function fail(text) error(name .. ": " .. text, 3) end

-- Numbers of a position; nil: it is a place in a void, which is known later.
local function vector_of(p)
  local x, y, z = p[1] or p.x, p[2] or p.y, p[3] or p.z
  if type(x) == "number" and type(y) == "number" and type(z) == "number" then return rubble.vec(x, y, z) end
end

local function waypoints_of(i, part, o)
  if type(part) ~= "table" then fail("part " .. i .. " is no path but a " .. type(part)) end
  if part.position then return { part } end
  if not part.waypoints then return part end
  for key, default in pairs(given_once) do
    local value = part[key] or default
    if value ~= default and value ~= (o[key] or default) then
      fail("part " .. i .. " has `" .. key .. "`: give it in the options of " .. name)
    end
  end
  if part.duration or part.ride then fail("part " .. i .. " has a `" .. (part.ride and "ride" or "duration") .. "`, which cannot be joined") end
  return part.waypoints
end

return function(parts, given)
  local o = rubble.options(name, given, rubble.trajectory_options {
    { "speed", 0.5, above = 0, max = 1000, unit = "m/s", doc = "Speed between parts, and where a waypoint has neither `t` nor `speed`." },
    { "interpolation", "spline", choices = { "spline", "linear" }, doc = "As `trajectory.interpolation`." },
  })
  if type(parts) ~= "table" then error(name .. " takes a list of paths first, not a " .. type(parts), 2) end
  local joined, last = {}, nil
  for i, part in ipairs(parts) do
    local before = 0
    for k, w in ipairs(waypoints_of(i, part, o)) do
      if type(w) ~= "table" or not w.position then fail("waypoint " .. k .. " of part " .. i .. " has no position") end
      local here = vector_of(w.position)
      local copy = {}
      for key, value in pairs(w) do copy[key] = value end
      local length = last and here and (here - last):norm()
      if w.t and k > 1 then
        -- The time of a part begins with it: what stays is how fast it goes.
        if not length then fail("waypoint " .. k .. " of part " .. i .. " has a `t` after a place in a void: give a `speed`") end
        if length <= 1e-9 then fail("waypoint " .. k .. " of part " .. i .. " stands still: parts that are joined cannot") end
        if not (w.t > before) then fail("waypoint " .. k .. " of part " .. i .. ": times do not increase") end
        copy.speed = length / (w.t - before)
      elseif not w.speed then
        copy.speed = o.speed
      end
      before, copy.t = w.t or before, nil
      if #joined == 0 then copy.speed = nil end
      -- A part that begins where the last one ended goes on from there.
      if not (length and length <= 1e-9) then joined[#joined + 1] = copy end
      last = here
    end
  end
  if #joined == 0 then error(name .. " has no waypoint", 2) end
  local plan = o.plan
  o.plan = "ghost"  -- the waypoints have speeds already
  local path = rubble.fly(o, joined, o.interpolation)
  path.plan = plan
  return path
end
