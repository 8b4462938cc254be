#include "scripting/scenario/mission_form.h"

namespace rubble {

MissionForm::MissionForm(const Scenario& scenario) : rest(scenario), light(scenario.lights.front()) {
  rest.lights.erase(rest.lights.begin());
  if (!scenario.names_cameras()) camera = scenario.cameras.front(), rest.cameras.clear();
  imu_on = !scenario.imus.empty() && !scenario.imus.front().named;
  if (imu_on) imu = scenario.imus.front(), rest.imus.clear();
}

Scenario MissionForm::normalized() const {
  Scenario scenario = rest;
  for (MountedCamera& one : scenario.cameras) one.named = true;
  if (scenario.cameras.empty()) scenario.cameras.push_back(camera);
  for (ImuScenario& one : scenario.imus) one.named = true;
  if (scenario.imus.empty() && imu_on) scenario.imus.push_back(imu);
  scenario.lights.insert(scenario.lights.begin(), light);
  return scenario;
}

}  // namespace rubble
