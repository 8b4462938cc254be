-- rubble.robot_options(model, given, list): an entry of `robots` from a model's own parameters and those
-- that every robot has.
return function(model, given, list)
  local plain = given  -- where it is no table, rubble.options says so
  if type(given) == "table" then
    plain = {}
    for name, value in pairs(given) do plain[name] = value end
    if type(plain.control) == "function" then plain.control = rubble.controller(plain.control) end
  end
  local common = {
    { "name", nil, type = "string", doc = "As `robots[].name`." },
    { "position", { 0, 0, 0 }, min = -1000, max = 1000, unit = "m", doc = "As `robots[].position`." },
    { "rpy_deg", { 0, 0, 0 }, min = -360, max = 360, unit = "degree", doc = "As `robots[].rpy_deg`." },
    { "friction", nil, type = "number", min = 0, max = 2, doc = "As `robots[].friction`." },
    { "start", {}, type = "table", doc = "As `robots[].start`." },
    { "odometry_noise", nil, type = "number", min = 0, max = 0.1, unit = "m", doc = "As `robots[].odometry_noise`." },
    { "lamps", {}, type = "table", doc = "As `robots[].lamps`." },
    { "drive", {}, type = "table", doc = "As `robots[].drive`." },
    { "control", 0, type = "integer", min = 0, max = 1000,
      doc = "A function that returns commands (docs/reference/robots.md)." },
    { "senses", {}, type = "table", doc = "As `robots[].senses`." },
  }
  local all = {}
  for i, entry in ipairs(list) do all[i] = entry end
  for _, entry in ipairs(common) do all[#all + 1] = entry end
  local o = rubble.options("rubble.robot." .. model, plain, all)
  o.model = model
  return o
end
