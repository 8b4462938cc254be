#include "app/measures/frame_watch.h"

#include <gtest/gtest.h>

#include <cmath>

namespace rubble::testing {
namespace frame_watch_test {

Frame even_frame(int index, std::uint8_t value, float depth) {
  Frame frame;
  frame.index = index;
  frame.rgb.assign(64 * 3, value);
  frame.depth.assign(64, depth);
  frame.truth["normals"] = std::vector<float>(64 * 3, 1);
  return frame;
}

TEST(FrameWatch, NamesTheFirstEvenFrameOnce) {
  FrameWatch watch;
  Frame good = even_frame(0, 100, 2);
  good.rgb[30] = 110;
  EXPECT_FALSE(watch.notice(good));
  EXPECT_TRUE(watch.notice(even_frame(7, 100, 2)));
  EXPECT_NE(watch.warning().find("frame 7 is all one colour (100, 100, 100)"), std::string::npos);
  EXPECT_FALSE(watch.notice(even_frame(8, 100, 2)));
}

TEST(FrameWatch, LooksThroughTheNoiseOfDithering) {
  Frame frame = even_frame(0, 1, 2);
  for (std::size_t i = 0; i < frame.rgb.size(); i += 2) frame.rgb[i] = 0;
  FrameWatch watch;
  EXPECT_TRUE(watch.notice(frame));
  EXPECT_NE(watch.warning().find("lamp.on"), std::string::npos) << watch.warning();
}

TEST(FrameWatch, SaysWhatToDoByWhatTheCameraSees) {
  const auto warning = [](const Frame& frame) {
    FrameWatch watch;
    EXPECT_TRUE(watch.notice(frame));
    return watch.warning();
  };
  EXPECT_NE(warning(even_frame(0, 90, 0.01f)).find("inside a piece"), std::string::npos);
  EXPECT_NE(warning(even_frame(0, 90, NAN)).find("no surface in view"), std::string::npos);
  EXPECT_NE(warning(even_frame(0, 255, 3)).find("thick air"), std::string::npos);
}

}  // namespace frame_watch_test
}  // namespace rubble::testing
