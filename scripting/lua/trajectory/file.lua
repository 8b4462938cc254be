-- rubble.trajectory.file: a recorded path: a TUM file (`t x y z qx qy qz qw` in each line, the optical
-- frame in the world), or a CSV file whose first line names its columns: t, x, y, z and either qx, qy,
-- qz, qw or roll_deg, pitch_deg, yaw_deg of the camera body.
local name = "rubble.trajectory.file"

local function clamped(v) return math.max(-1, math.min(1, v)) end

-- Roll, pitch, yaw of a unit quaternion, in degrees.
local function angles(w, x, y, z)
  return { math.deg(math.atan(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))),
           math.deg(math.asin(clamped(2 * (w * y - z * x)))),
           math.deg(math.atan(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))) }
end

-- The body's rotation from the optical frame's: q * (1, 1, -1, 1) / 2.
local function body_from_optical(w, x, y, z)
  return 0.5 * (w - x + y - z), 0.5 * (w + x + y + z), 0.5 * (-w - x + y + z), 0.5 * (w - x - y + z)
end

return function(given)
  local o = rubble.options(name, given, rubble.trajectory_options {
    { "path", "", doc = "The file, in the folder of the script." },
    { "frame", nil, type = "choice", choices = { "as the format says", "optical", "body" },
      doc = "Frame of the orientations; TUM files have the optical frame, CSV files the body frame." },
    { "every", 1, type = "integer", min = 1, max = 100000, doc = "Takes every n-th pose." },
    { "slower", 1, above = 0, max = 1000, doc = "Factor by which times are stretched." },
  })
  if o.path == "" then
    rubble.reject(name, "path", "the name of a file", o.path)
    return rubble.fly(o, { { position = { 0, 0, 1 } } })
  end
  local file = rubble.read_table(o.path)
  local column = {}
  local is_csv = #file.names > 0
  for i, word in ipairs(is_csv and file.names or { "t", "x", "y", "z", "qx", "qy", "qz", "qw" }) do
    column[word] = i
  end
  for _, word in ipairs { "t", "x", "y", "z" } do
    if not column[word] then error(o.path .. " has no column " .. word, 2) end
  end
  local optical = o.frame == "optical" or (o.frame ~= "body" and not is_csv)
  local waypoints, start = {}, nil
  for i = 1, #file.rows, o.every do
    local row = file.rows[i]
    local function value(word)
      local v = row[column[word]]
      if type(v) ~= "number" then
        error(o.path .. ":" .. file.lines[i] .. ": no number in the column " .. word, 4)
      end
      return v
    end
    start = start or value("t")
    local waypoint = { t = (value("t") - start) * o.slower, position = { value("x"), value("y"), value("z") } }
    if column.qw then
      local w, x, y, z = value("qw"), value("qx"), value("qy"), value("qz")
      local n = math.sqrt(w * w + x * x + y * y + z * z)
      if n < 1e-6 then error(o.path .. ":" .. file.lines[i] .. ": the quaternion is zero", 2) end
      w, x, y, z = w / n, x / n, y / n, z / n
      if optical then w, x, y, z = body_from_optical(w, x, y, z) end
      waypoint.rpy_deg = angles(w, x, y, z)
    elseif column.yaw_deg then
      waypoint.rpy_deg = { column.roll_deg and value("roll_deg") or 0,
                           column.pitch_deg and value("pitch_deg") or 0, value("yaw_deg") }
    end
    waypoints[#waypoints + 1] = waypoint
  end
  if #waypoints == 0 then error(o.path .. " has no pose", 2) end
  return rubble.fly(o, waypoints)
end
