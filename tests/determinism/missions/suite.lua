-- Whole missions whose outputs have golden hashes: each kind of sensor, light and weather, small.
-- tests/determinism/missions_test.cpp runs them, and `make determinism` on other processors and with other libraries; the
-- contract is docs/explanation/determinism.md. Where results were meant to change:
--
--   cmake --build build/release --target update_golden
local function append(list, ...)
  for _, more in ipairs { ... } do list[#list + 1] = more end
  return list
end

-- Files that zlib or libpng compresses are left out: their bytes, though not what they hold, depend on its version.
local function run(name, mission, ...)
  return { name = name, mission = mission, golden = "all", expect = { settled = { 0, 1 } },
           set = append({ "outputs.preview=false", "outputs.simplemap=false", "outputs.stl=false" }, ...) }
end
local function small(name, ...)
  local entry = run(name, "../../../scripts/" .. name .. ".lua", "camera.width=96", "camera.height=72", "pile.layers=1",
                    "pile.pieces_per_layer=12", "outputs.frames=false")
  append(entry.set, ...)
  return entry
end

return suite {
  runs = {
    run("void_lamp", "void_lamp.lua"),
    run("painted", "painted.lua"),
    run("scanning_crawler", "scanning_crawler.lua"),
    small("channels"),
    small("weather", "camera.optics.drops=3"),
    small("fisheye", "camera.height=96", "trajectory.rate_hz=2"),
    small("distortion", "camera.lens.fx=57", "camera.lens.fy=57.3", "camera.lens.cx=48.4", "camera.lens.cy=35.7",
          "trajectory.rate_hz=2"),
    small("rolling_shutter", "trajectory.rate_hz=2"),
    small("blur", "trajectory.rate_hz=2"),
    small("events", "camera.width=64", "camera.height=48", "trajectory.rate_hz=2"),
    small("stereo", "trajectory.rate_hz=2"),
    small("depth_sensor", "trajectory.rate_hz=2"),
    small("time_of_flight", "trajectory.rate_hz=2"),
    small("lidar", "trajectory.rate_hz=2", "outputs.pcd=false", "outputs.kitti=false"),
    small("dust", "camera.width=64", "camera.height=48", "trajectory.rate_hz=1"),
    small("surroundings", "trajectory.rate_hz=0.5"),
    small("record_settling", "record_settling.rate_hz=3", "record_settling.to=2", "trajectory.rate_hz=2"),
    small("reference", "camera.samples=2"),
  },
}
