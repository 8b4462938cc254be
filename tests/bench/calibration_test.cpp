#include "bench/calibration.h"

#include <gtest/gtest.h>

namespace rubble {
namespace calibration_test {

// The same work on every machine, or figures could not be compared: its result is this number.
TEST(Calibration, DoesTheSameWorkEverywhere) {
  std::vector<std::uint64_t> memory(kCalibrationWords);
  EXPECT_EQ(do_calibration_work(memory), 0xe122edcab9d1eb13ULL);
}

TEST(Calibration, TwoThreadsTakeNoLessTimeThanOne) {
  const Calibration calibration = calibrate();
  EXPECT_GT(calibration.one_thread, 1);
  EXPECT_GT(calibration.two_threads, 0.5 * calibration.one_thread);  // measured in turns
}

TEST(Calibration, HasAFigureForEveryColumn) {
  EXPECT_EQ(calibration_csv_header(), "calibration_1_ms,calibration_2_ms");
  EXPECT_EQ(calibration_csv({12.345, 23.456}), "12.35,23.46");
  EXPECT_EQ(calibration_text({12.345, 23.456}),
            "calibration of the machine: 12.3 ms on one thread, 23.5 ms on two\n");
}

}  // namespace calibration_test
}  // namespace rubble
