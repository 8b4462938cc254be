-- What pieces are made of. density: kg/m3; friction: Coulomb coefficient against concrete (the
-- friction of a pair is the geometric mean of the two). look: of surfaces that name none themselves.
return materials {
  { name = "reinforced_concrete", density = 2400, friction = 0.80, look = "concrete_cast",
    source = "density: 145-150 pcf tables; friction: concrete on concrete, dry (PCI)" },
  { name = "brick", density = 1900, friction = 0.65, look = "brick",
    source = "1600-2080 kg/m3 tables; engineering-constants sheets" },
  { name = "cinder_block", density = 1900, friction = 0.65, look = "cinder_block",
    source = "solid part; 1360-2160 kg/m3 tables" },
  { name = "steel", density = 7850, friction = 0.57, look = "steel_galvanised",
    source = "0.57-0.70 on concrete: Rabbat and Russell 1985" },
  { name = "timber", density = 500, friction = 0.50, look = "timber",
    source = "softwood 465-545 kg/m3; on masonry: DM-7" },
  { name = "plywood", density = 577, friction = 0.50, look = "timber", source = "tables; OSB alike" },
  { name = "drywall", density = 769, friction = 0.50, look = "plaster", source = "density: tables; friction: our choice" },
  { name = "glass", density = 2500, friction = 0.40, look = "steel_galvanised", source = "2190-2560 kg/m3; sliding" },
  { name = "vehicle", density = 120, friction = 0.60, look = "steel_galvanised",
    source = "density over the bounding volume: our choice; tyre and steel on concrete" },
  { name = "furniture", density = 200, friction = 0.50, look = "timber", source = "in bulk: our choice" },
}
