#include "kernel/base/text.h"

#include <gtest/gtest.h>

#include "kernel/base/error.h"

namespace rubble {
namespace text_test {

TEST(Utf8, FindsTheFirstByteThatIsNone) {
  const std::size_t none = std::string_view::npos;
  EXPECT_EQ(find_invalid_utf8(""), none);
  EXPECT_EQ(find_invalid_utf8("gr\xc3\xbc\xc3\x9f \xe2\x82\xac \xf0\x9f\x8f\x9a"), none);
  EXPECT_EQ(find_invalid_utf8("a\xe9 latin"), 1u);
  EXPECT_EQ(find_invalid_utf8("a\xc3"), 1u) << "cut off";
  EXPECT_EQ(find_invalid_utf8("\xc0\xaf"), 0u) << "overlong";
  EXPECT_EQ(find_invalid_utf8("ab\xed\xa0\x80"), 2u) << "a surrogate";
  EXPECT_EQ(find_invalid_utf8("\xf4\x90\x80\x80"), 0u) << "beyond U+10FFFF";
}

TEST(Printable, MakesVisibleWhatSteersATerminal) {
  EXPECT_EQ(printable("line\n\tnext \xc3\xa9"), "line\n\tnext \xc3\xa9");
  EXPECT_EQ(printable("\x1b]0;owned\x07"), "\\x1b]0;owned\\x07");
  EXPECT_EQ(printable("\xc2\x9b" "31m \xc2\xa0"), "\\xc2\\x9b31m \xc2\xa0") << "a C1 control";
  EXPECT_EQ(printable("\x9b" "31m\r"), "\\x9b31m\\x0d");
}

TEST(Printable, EveryMessageIs) {
  const InputError error({"m.lua", 2, "key\x1b[2J", "unknown", "", "", ""});
  EXPECT_STREQ(error.what(), "m.lua:2: key\\x1b[2J: unknown");
}

}  // namespace text_test
}  // namespace rubble
