// Keys of lights, lamp and air.
#include "scripting/scenario/part_schemas.h"

#include <string>

namespace rubble {
namespace {

void add_light(Schema& k, LightScenario& l) {
  k.group("light", "The main light.");
  k.choice(
      "light.type", l.spec.type, {"directional", "spot", "point", "sun"},
      "Type of light. Strength, colour and sky of the sun follow from its elevation.");
  k.value("light.intensity", l.spec.intensity,
          "Illuminance of a directional light in klx (clear sun: 100 klx); luminous intensity of a spot or "
          "point light in kcd.")
      .between(0, 1000)
      .unit("klx or kcd");
  k.value("light.rpy_deg", l.spec.rpy_deg, "Direction of the beam: roll, pitch (positive: down), yaw.")
      .between(-360, 360)
      .unit("degree");
  k.value("light.random_rotation", l.random_rotation,
          "Draws the direction from the seed: 20 to 80 degrees down, any yaw.");
  k.value("light.position", l.spec.position, "Position of a spot or point light in the world.")
      .between(-1000, 1000)
      .unit("m");
  k.value("light.cone_deg", l.spec.cone_deg, "Full angle of the cone of a spot light.")
      .between(1, 170)
      .unit("degree");
  k.value("light.elevation_deg", l.spec.elevation_deg,
          "Elevation of the sun above the horizon; slightly below 0 is dusk, -18 is night.")
      .between(-18, 90)
      .unit("degree");
  k.value("light.azimuth_deg", l.spec.azimuth_deg, "Azimuth of the sun, from X towards Y.")
      .between(-360, 360)
      .unit("degree");
  k.value("light.random_position", l.random_position,
          "Draws the position from the seed, in a box around `position`.");
  k.value("light.position_bounds", l.position_bounds, "Full edge lengths of the box of `random_position`.")
      .between(0, 1000)
      .unit("m");
  add_sky_keys(k, l);
}

void add_more_lights(Schema& k, std::vector<LightScenario>& lights) {
  k.list("lights", lights,
         "Further lights, at most three. Only the main light has a sky.");
  k.add("lights[].type", "Type of light.", [&lights](std::size_t i) {
    return Schema::choice_slot(lights[i].spec.type, {"directional", "spot", "point"});
  });
  const auto item = [&](const char* key, auto LightSpec::*member, const char* doc) {
    return &k.add(std::string("lights[].") + key, doc, [&lights, member](std::size_t i) { return Slot(&(lights[i].spec.*member)); });
  };
  item("intensity", &LightSpec::intensity,
       "Illuminance of a directional light in klx; luminous intensity of a spot or point light in kcd.")
      ->between(0, 1000)
      .unit("klx or kcd");
  item("rpy_deg", &LightSpec::rpy_deg, "Direction of the beam: roll, pitch (positive: down), yaw.")
      ->between(-360, 360)
      .unit("degree");
  item("position", &LightSpec::position, "Position of a spot or point light.")
      ->between(-1000, 1000)
      .unit("m");
  item("cone_deg", &LightSpec::cone_deg, "Full angle of the cone of a spot light.")
      ->between(1, 170)
      .unit("degree");
}

void add_dust(Schema& k, DustSpec& dust) {
  k.group("air.dust", "Bursts of dust, as from shifting debris.");
  k.value("air.dust.period", dust.period, "Mean time between bursts; 0: no dust.")
      .between(0, 3600)
      .unit("s");
  k.value("air.dust.irregularity", dust.irregularity,
          "Irregularity of the times between bursts, as a share of the period; 0: regular.")
      .between(0, 1);
  k.value("air.dust.position", dust.position, "Centre of the box in which bursts start.")
      .between(-1000, 1000)
      .unit("m");
  k.value("air.dust.bounds", dust.bounds, "Full edge lengths of the box in which bursts start.")
      .between(0, 1000)
      .unit("m");
  k.value("air.dust.density", dust.density, "Extinction in the centre of a fresh plume.")
      .between(0, 100)
      .unit("1/m");
  k.value("air.dust.radius", dust.radius, "Radius of a fresh plume.").between(0.01, 10).unit("m");
  k.value("air.dust.speed", dust.speed, "Initial speed of the dust.").between(0, 50).unit("m/s");
  k.value("air.dust.spread", dust.spread, "Turbulent diffusivity.").between(0, 10).unit("m2/s");
  k.value("air.dust.fall", dust.fall, "Settling speed.").between(0, 10).unit("m/s");
  k.value("air.dust.half_life", dust.half_life, "Time after which half of the dust has left the air.")
      .between(0.1, 3600)
      .unit("s");
  k.value("air.dust.asymmetry", dust.asymmetry, "As `air.fog_asymmetry`, for the dust.")
      .between(-0.99, 0.99);
}

void add_air_and_lamp(Schema& k, AirSpec& air, LampSpec& lamp) {
  k.group("air", "Fog, wind and dust.");
  k.value("air.fog_density", air.fog_density,
          "Extinction coefficient: the transmittance over a distance d is exp(-density d).")
      .between(0, 10)
      .unit("1/m");
  k.value("air.fog_intensity", air.fog_intensity, "Brightness of the fog.").between(0, 1);
  k.value("air.fog_asymmetry", air.fog_asymmetry,
          "Mean cosine of the scattering angle (Henyey-Greenstein); 0: isotropic; near 1: forward. Smoke: 0.75; "
          "droplets: 0.85.")
      .between(-0.99, 0.99);
  k.value("air.fog_height", air.fog_height,
          "Height above the ground over which the density falls by a factor of e; 0: constant density.")
      .between(0, 1000)
      .unit("m");
  k.value("air.fog_noise", air.fog_noise,
          "Strength of the billows: 0: uniform density; 1: density from zero to double.")
      .between(0, 1);
  k.value("air.fog_noise_size", air.fog_noise_size, "Size of the largest billows.")
      .between(0.05, 100)
      .unit("m");
  k.value("air.rain_mm_h", air.rain_mm_h,
          "Rate of rain. It makes a veil, and streaks in images with a modelled exposure "
          "(docs/explanation/weather.md).")
      .between(0, 100)
      .unit("mm/h");
  k.value("air.snow_mm_h", air.snow_mm_h, "Rate of snowfall, as melted water. It makes a veil and streaks.")
      .between(0, 10)
      .unit("mm/h");
  k.value("air.wind", air.wind, "Velocity of billows, dust, drops and flakes.").between(-50, 50).unit("m/s");
  add_dust(k, air.dust);
  k.group("lamp", "A lamp on the camera.");
  k.value("lamp.on", lamp.on, "Switches the lamp on.");
  k.value("lamp.intensity_cd", lamp.intensity_cd, "Luminous intensity on the axis.").between(0, 100000).unit("cd");
  k.value("lamp.cone_deg", lamp.cone_deg, "Full angle at which the intensity is half of that on the axis.")
      .between(5, 170)
      .unit("degree");
  k.choice("lamp.shape", lamp.shape, {"point", "ring", "cluster"},
           "`point`: one small source; `ring`: diodes in a ring; `cluster`: diodes on a disc.");
  k.value("lamp.size", lamp.size, "Diameter of the ring or disc.").between(0, 1).unit("m");
  k.value("lamp.position", lamp.position, "Position in the camera frame: X forward, Y left, Z up.")
      .between(-10, 10)
      .unit("m");
}

}  // namespace

void add_light_keys(Schema& keys, MissionForm& form) {
  add_light(keys, form.light);
  add_more_lights(keys, form.rest.lights);
  add_air_and_lamp(keys, form.rest.air, form.rest.lamp);
}

}  // namespace rubble
