-- rubble.building { storeys = 4, cause = { ... }, ... }: a pile that is a building and what becomes of it.
-- The keys are those of `pile.building`; without any it has four storeys, with a plan as many as the plan.
-- Nothing else is dropped.
return function(given)
  if given ~= nil and type(given) ~= "table" then
    rubble.options("rubble.building", given, {})  -- says that it is no table
    given = nil
  end
  local building = {}
  for key, value in pairs(given or {}) do building[key] = value end
  if not building.plan then building.storeys = building.storeys or 4 end
  return { building = building, layers = 0 }
end
