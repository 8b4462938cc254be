#include "kernel/base/error.h"

#include <gtest/gtest.h>

namespace rubble {
namespace error_test {

TEST(Diagnostic, SaysWhereWhatAndWhy) {
  const Diagnostic d{"m.lua", 12, "camera.width", "wrong type", "an integer", "the string \"a\"",
                     "remove the quotes"};
  EXPECT_EQ(d.text(),
            "m.lua:12: camera.width: wrong type: expected an integer, found the string \"a\" "
            "(remove the quotes)");
}

TEST(InputError, CarriesEveryMistake) {
  const InputError error({{"a", 1, "x", "bad", "", "", ""}, {"a", 2, "y", "bad", "", "", ""}});
  EXPECT_EQ(error.diagnostics().size(), 2u);
  EXPECT_STREQ(error.what(), "a:1: x: bad\na:2: y: bad");
}

}  // namespace error_test
}  // namespace rubble
