-- rubble.terrain.rough: open ground as rough as real ground, by the classes of ISO 8608: the power spectral density of the
-- height along any line is G (n / n0)^-2 m3 over the spatial frequency n, n0 = 0.1 cycles/m. On the perfect plane that a
-- mission has without it, scans look alike from everywhere, and LiDAR odometry loses its way. Level within `level` of
-- the middle, where a building or a pile can stand on z = 0; the lowest point is at z = 0.

-- Unevenness G of the classes at n0: geometric means of ISO 8608; unit: m3. A and B are roads, C to E gravel, tracks and
-- fields, F and G broken ground.
local unevenness = { A = 16e-6, B = 64e-6, C = 256e-6, D = 1024e-6, E = 4096e-6, F = 16384e-6, G = 65536e-6 }
local waves = 48
local golden = 0.3819660112501051 -- share of a turn by which directions of waves follow each other
local transition = 4 -- between level and rough ground; unit: m

return function(given)
  local o = rubble.options("rubble.terrain.rough", given, {
    { "class", "D", choices = { "A", "B", "C", "D", "E", "F", "G" }, doc = "Class of ISO 8608: A smooth road, C gravel, D to E tracks and fields, G broken ground." },
    { "longest", 20, min = 1, max = 500, unit = "m", doc = "Longest wavelength; longer ones are hills." },
    { "level", 0, min = 0, max = 500, unit = "m", doc = "Radius around the middle that is level, at z = 0." },
    { "length", 80, min = 1, max = 1000, unit = "m", doc = "Length along X." },
    { "width", 80, min = 1, max = 1000, unit = "m", doc = "Width along Y." },
    { "spacing", 0.4, min = 0.05, max = 50, unit = "m", doc = "Edge length of the square cells of the grid; the shortest wavelength is twice as long." },
    { "x", 0, min = -1000, max = 1000, unit = "m", doc = "Position of the centre along X." },
    { "y", 0, min = -1000, max = 1000, unit = "m", doc = "Position of the centre along Y." },
    { "friction", 0.8, min = 0, max = 2, doc = "Coulomb coefficient against concrete." },
    { "look", "ground", doc = "Look of the surface, such as ground or concrete_cast." },
  })
  if 2 * o.spacing >= o.longest then
    rubble.reject("rubble.terrain.rough", "spacing", "less than half of `longest`, " .. o.longest / 2 .. " m: else no wave fits the grid", o.spacing)
    o.longest = 4 * o.spacing
  end
  -- One draw of the mission's seed; the numbers that follow from it are of Knuth's MMIX generator.
  local state = rubble.random("rubble.terrain.rough"):integer(1, 2147483647)
  local function draw()
    state = state * 6364136223846793005 + 1442695040888963407
    return (state >> 11) / 9007199254740992
  end
  -- Waves in all directions whose radial density is C / n^2 have the density 2 C / (pi n^2) along any line.
  local low, high = 1 / o.longest, 1 / (2 * o.spacing)
  local factor, octaves = math.pi / 2 * unevenness[o.class] * 0.01, math.log(high / low) / waves
  local list = {}
  for i = 1, waves do
    local from, to = low * math.exp(octaves * (i - 1)), low * math.exp(octaves * i)
    local n, angle = from * math.exp(octaves * draw()), 2 * math.pi * (i + draw()) * golden
    list[i] = { amplitude = math.sqrt(2 * factor * (1 / from - 1 / to)), phase = 2 * math.pi * draw(),
                kx = 2 * math.pi * n * math.cos(angle), ky = 2 * math.pi * n * math.sin(angle) }
  end
  -- cos(kx x + ky y + phase) from what belongs to the column and to the row: rows come one after the other.
  local columns, row_y, row, column = {}, nil, nil, nil
  local shares, lowest = {}, math.huge
  local terrain = rubble.terrain.from(function(x, y)
    if y ~= row_y then
      row_y, row, column = y, {}, 0
      for i, w in ipairs(list) do
        local angle = w.ky * y + w.phase
        row[2 * i - 1], row[2 * i] = w.amplitude * math.cos(angle), w.amplitude * math.sin(angle)
      end
    end
    column = column + 1
    local at = columns[column]
    if not at then
      at = {}
      for i, w in ipairs(list) do at[2 * i - 1], at[2 * i] = math.cos(w.kx * x), math.sin(w.kx * x) end
      columns[column] = at
    end
    local sum, dx, dy = 500, x - o.x, y - o.y -- from() takes no height below 0
    for i = 1, 2 * waves, 2 do sum = sum + row[i] * at[i] - row[i + 1] * at[i + 1] end
    local share = o.level == 0 and 1 or math.max(0, math.min(1, (math.sqrt(dx * dx + dy * dy) - o.level) / transition))
    shares[#shares + 1], lowest = share * share * (3 - 2 * share), math.min(lowest, sum)
    return sum
  end, { length = o.length, width = o.width, spacing = o.spacing, x = o.x, y = o.y, friction = o.friction, look = o.look })
  for i, share in ipairs(shares) do terrain.heights[i] = (terrain.heights[i] - lowest) * share end
  return terrain
end
