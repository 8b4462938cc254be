-- rubble.collapse.inclined: a stack of floors with a common dip and slightly different slopes. Their
-- lower edges lie on one another against the remains of a wall; their upper edges lie on stubs of the
-- beams that carried them. The voids are stacked wedges: the lowest has the height length * sin(dip),
-- each further one the section length^2 / 2 * sin(spread / (storeys - 1)).
--
-- The origin is below the edge that the lowest floor rests on; the floors go down along X.
local name = "rubble.collapse.inclined"

return function(given)
  local o = rubble.options(name, given, rubble.structure_options {
    { "length", 5, min = 1, max = 50, unit = "m", doc = "Length of a floor, from the upper wall down." },
    { "width", 6, min = 0.3, max = 50, unit = "m", doc = "Width of the floors and walls." },
    { "thickness", 0.2, min = 0.05, max = 2, unit = "m", doc = "Thickness of a floor." },
    { "dip_deg", 20, min = 10, max = 45, unit = "degree", doc = "Dip of the lowest floor." },
    { "spread_deg", 6, min = 0.5, max = 20, unit = "degree", doc = "Difference of dip between the lowest and the highest floor." },
    { "storeys", 3, type = "integer", min = 1, max = 10, doc = "Number of floors." },
    { "bearing", 0.1, min = 0.02, max = 2, unit = "m", doc = "Length of each floor that lies on its stub." },
    { "wall_thickness", 0.3, min = 0.1, max = 5, unit = "m", doc = "Thickness of the walls." },
  })
  local step = o.storeys > 1 and o.spread_deg / (o.storeys - 1) or 0
  local clear, placed = o.length - o.bearing, {}
  local first = math.rad(o.dip_deg)
  local foot_x, foot_z = clear * math.cos(first), 0
  -- The lower wall, clear of the floors' upper edges there: the steepest reaches farthest.
  local toe = foot_x + o.thickness * math.sin(math.rad(o.dip_deg + o.spread_deg)) + 0.004
  local back, top = -o.bearing - 0.1, 0  -- the upper wall, clear of the floors' ends
  for k = 0, o.storeys - 1 do
    local angle = math.rad(o.dip_deg + k * step)
    local down, up = math.cos(angle), math.sin(angle)
    local x, z = foot_x - clear * down, foot_z + clear * up  -- the stub's upper edge
    -- The stub under a floor is as high as the wedge there allows; the lowest is the wall itself.
    local room = k == 0 and z or clear * math.sin(math.rad(step)) - o.bearing * up
    if k > 0 and room < 0.02 then
      rubble.reject(name, "spread_deg", "a spread that parts the upper edges", o.spread_deg)
      break
    end
    placed[#placed + 1] = rubble.wall {
      x0 = back, x1 = x, width = o.width, height = z,
      bottom = k == 0 and 0 or z - math.min(0.15, 0.7 * room), broken = k > 0 and { "+x" } or nil,
    }
    top = z + o.bearing * up + o.thickness
    placed[#placed + 1] = rubble.slab {
      from = { x - o.bearing * down, 0, z + o.bearing * up + 0.002 },
      size = { o.length, o.width, o.thickness }, pitch_deg = math.deg(angle), broken = { "+x" }, fixed = false,
    }
    -- The next one's foot is straight above this one's.
    foot_z = foot_z + (o.thickness + 0.004) / down
  end
  placed[#placed + 1] = rubble.wall {
    x0 = back - o.wall_thickness, x1 = back, width = o.width, height = top + 0.3, broken = { "+z" },
  }
  placed[#placed + 1] = rubble.wall {
    x0 = toe, x1 = toe + o.wall_thickness, width = o.width, height = foot_z + 0.05, broken = { "+z" },
  }
  return rubble.assemble(o, placed)
end
