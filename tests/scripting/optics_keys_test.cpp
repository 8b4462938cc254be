// What a mission must not say about lens and sensor, and what it may.
#include <gtest/gtest.h>

#include "scripting/scenario/scenario.h"
#include "tests/scripting/test_support.h"

namespace rubble::testing {
namespace optics_keys_test {

template <typename Change>
std::string mistake(Change change) {
  Scenario s;
  change(s);
  return error_of([&] { s.validate(); });
}

TEST(OpticsKeys, AnIdealImageHasNoFaults) {
  EXPECT_EQ(mistake([](Scenario& s) { s.cameras[0].camera.optics.glare = 0.02; }),
            "camera.optics: an ideal image has a perfect lens: expected camera.exposure.mode of \"fixed\" or "
            "\"automatic\"");
  EXPECT_EQ(mistake([](Scenario& s) { s.cameras[0].camera.sensor.mosaic = Mosaic::rggb; }),
            "camera.sensor: an ideal image has no mosaic, fixed pattern, artefacts or pixel_samples: expected "
            "camera.exposure.mode of \"fixed\" or \"automatic\"");
  EXPECT_EQ(mistake([](Scenario& s) {
              s.cameras[0].camera.optics.glare = 0.02, s.cameras[0].camera.sensor.hot_pixels = 1e-4;
              s.cameras[0].camera.exposure.mode = ExposureMode::automatic;
            }),
            "");
}

TEST(OpticsKeys, NothingIsSharpWithinTheFocalLength) {
  EXPECT_EQ(mistake([](Scenario& s) {
              s.cameras[0].camera.exposure.mode = ExposureMode::fixed;
              s.cameras[0].camera.optics.focal_length = 0.05, s.cameras[0].camera.optics.focus_distance = 0.04;
            }),
            "camera.optics.focus_distance: no lens is sharp within its focal length: expected more than "
            "camera.optics.focal_length, or 0");
}

}  // namespace optics_keys_test
}  // namespace rubble::testing
