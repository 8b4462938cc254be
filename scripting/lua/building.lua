-- rubble.building { storeys = 4, cause = { ... }, ... }: a pile that is a building and what becomes of it.
-- The keys are those of `pile.building`; without any it has four storeys. Nothing else is dropped.
return function(given)
  local building = {}
  for key, value in pairs(given or {}) do building[key] = value end
  building.storeys = building.storeys or 4
  return { building = building, layers = 0 }
end
