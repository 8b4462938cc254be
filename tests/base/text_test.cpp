#include "kernel/base/number_text.h"
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

TEST(Names, HaveNoControlsSlashesOrDotsInFront) {
  for (const char* name : {"slab", "slab 2, broken", "d\xc3\xa9" "combres", "a.b", "-x", "\"quoted\"", "a<b>&c"})
    EXPECT_EQ(find_name_fault(name), "") << name;
  for (const char* name : {"", "../up", "a/b", "a\\b", ".", "..", ".hidden", "a\nb", "a\tb", "\x1b[2J", "\x7f", "\xc2\x9b" "2J", "\xff"})
    EXPECT_NE(find_name_fault(name), "") << name;
  EXPECT_EQ(find_name_fault(std::string(100, 'x')), "");
  EXPECT_NE(find_name_fault(std::string(101, 'x')), "");
  EXPECT_NE(find_name_fault(std::string_view("a\0b", 3)), "");
}

TEST(Names, MakeFileNamesThatAreEachTheirOwn) {
  EXPECT_EQ(file_name_of("base_link"), "base_link");
  EXPECT_EQ(file_name_of("arm 2"), "arm 2");
  const std::string up = file_name_of("../../up"), other = file_name_of("..\\../up"), slash = file_name_of("a/b");
  for (const std::string& name : {up, other, slash, file_name_of(""), file_name_of(std::string(5000, 'x')), file_name_of("\n")})
    EXPECT_EQ(find_name_fault(name), "") << name;
  EXPECT_NE(up, other) << "both are ______up without the hash";
  EXPECT_NE(slash, file_name_of("a_b"));
}

TEST(OneLine, HasNoBreak) {
  EXPECT_EQ(one_line("a\nb\tc\rd"), "a\\x0ab\\x09c\\x0dd");
  EXPECT_EQ(one_line("plain, \xc3\xa9"), "plain, \xc3\xa9");
}

TEST(Printable, EveryMessageIs) {
  const InputError error({"m.lua", 2, "key\x1b[2J", "unknown", "", "", ""});
  EXPECT_STREQ(error.what(), "m.lua:2: key\\x1b[2J: unknown");
}

// What messages show of numbers: no zeros at the end, and no exponent that hides digits.
TEST(NumberText, OfSentences) {
  EXPECT_EQ(plain_text(0.42), "0.42");
  EXPECT_EQ(plain_text(100000), "100000");
  EXPECT_EQ(plain_text(1e-7), "1e-07");
  EXPECT_EQ(plain_text(1403636579.763556), "1403636579.763556");
  EXPECT_EQ(plain_text(-1), "-1");
  EXPECT_EQ(plain_text(0), "0");
  EXPECT_EQ(brief_text(1.41421356), "1.41421");
  EXPECT_EQ(brief_text(0.42 - 0.02), "0.4");
  EXPECT_EQ(brief_text(33333333.4), "33333333");
  EXPECT_EQ(brief_text(1e20), "1e+20");
}

}  // namespace text_test
}  // namespace rubble
