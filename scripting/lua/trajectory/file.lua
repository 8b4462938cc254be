-- rubble.trajectory.file: a recorded path: a file in the format of TUM, EuRoC or KITTI, or one whose first
-- line names its columns: t, x, y, z and either qx, qy, qz, qw or roll_deg, pitch_deg, yaw_deg. The detected
-- format is printed.
local name = "rubble.trajectory.file"

return function(given)
  local o = rubble.options(name, given, rubble.trajectory_options {
    { "path", "", doc = "The file, in the folder of the script." },
    { "frame", nil, type = "choice", choices = { "as the format says", "optical", "body" },
      doc = "Frame of the orientations; TUM and KITTI files have the optical frame, others the body frame." },
    { "columns", "", doc = "Names of the columns of a file that does not name them: \"t [ns],x,y,z,qx,qy,qz,qw\"." },
    { "interval", nil, type = "number", above = 0, max = 1000, unit = "s",
      doc = "Time between two poses of a file without stamps, such as KITTI's (0.1)." },
    { "every", 1, type = "integer", min = 1, max = 100000, doc = "Takes every n-th pose." },
    { "slower", 1, above = 0, max = 1000, doc = "Factor by which times are stretched." },
  })
  if o.path == "" then
    rubble.reject(name, "path", "the name of a file", o.path)
    return rubble.fly(o, { { position = { 0, 0, 1 } } })
  end
  local file = rubble.read_trajectory(o.path, { frame = o.frame, columns = o.columns })
  print(o.path .. ": read as " .. file.format)
  for _, note in ipairs(file.notes) do print(o.path .. ": " .. note) end
  if not file.stamped and not o.interval then
    error(o.path .. " has no stamps: give `interval`, the time between two poses in seconds (KITTI: 0.1)", 2)
  end
  local slower = o.slower * (file.stamped and 1 or o.interval)
  local waypoints = {}
  for i = 1, #file.poses, o.every do
    local waypoint = file.poses[i]
    waypoint.t = waypoint.t * slower
    waypoints[#waypoints + 1] = waypoint
  end
  return rubble.fly(o, waypoints)
end
