-- What a snake among many contacts costs: it writhes in a trough of 1,219 loose blocks of 5 cm, and says how many pairs
-- of one of its links and a block touch. The stage `robots` of the run says how long its 8 s took:
--
--   build/release/rubble run bench/snake_bed.lua --threads 1 --out out/snake_bed
local edge, spacing = 0.05, 0.0505
local placed = {}
local function add(x, y, z)
  placed[#placed + 1] = { box = { edge, edge, edge }, position = { x, y, z }, fixed = false }
end
for i = -26, 26 do
  for j = -9, 9 do add(i * spacing, j * spacing, edge / 2) end
  for _, side in ipairs { 1, -1 } do
    for layer = 1, 2 do add(i * spacing, 0.085 * side, (layer + 0.5) * edge + 0.0005 * layer) end
  end
end

local calls, sum = 0, 0
local function writhe(sense)
  calls, sum = calls + 1, sum + #sense.contacts
  if calls % 60 == 0 then print(string.format("contacts: %.1f", sum / calls)) end
  local angles = {}
  for i = 1, 15 do angles[i] = i % 2 == 1 and 0.35 * math.sin(3 * sense.t + 0.8 * i) or 0 end
  return { joints = angles }
end

return rubble.mission {
  seed = 4,
  pile = { layers = 0, placed = placed },
  robots = { rubble.robot.snake { name = "snake", position = { 0.6, 0, 0.115 }, control = writhe } },
  robot_run = { duration = 8 },
  camera = { width = 16, height = 16 },
  trajectory = { rate_hz = 0.2, ride = { robot = "snake" } },
  outputs = { bag = false, rawlog = false, simplemap = false },
}
