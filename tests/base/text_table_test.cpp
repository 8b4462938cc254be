// The lexer of numbers and tables.
#include "kernel/base/tables/text_table.h"

#include <gtest/gtest.h>

#include <cmath>

namespace rubble {
namespace text_table_test {

TEST(TextTable, NumbersAreReadInEveryUsualForm) {
  EXPECT_EQ(parse_number("+1.5"), 1.5);
  EXPECT_EQ(parse_number("-.5"), -0.5);
  EXPECT_EQ(parse_number("5."), 5);
  EXPECT_EQ(parse_number("1e-3"), 1e-3);
  EXPECT_EQ(parse_number("1E+3"), 1000);
  EXPECT_EQ(parse_number("-.1468930D-02"), -0.001468930);
  EXPECT_EQ(parse_number("1e-400"), 0);
  EXPECT_TRUE(std::isnan(*parse_number("NaN")));
  EXPECT_TRUE(std::isinf(*parse_number("-Inf")));
  for (const char* word : {"", "+", "-", ".", "1,5", "1 2", "0x10", "1e", "--1", "+-1", "one", "1.5m", "1e999"})
    EXPECT_FALSE(parse_number(word)) << word;
}

TEST(TextTable, StampsAreExact) {
  EXPECT_EQ(parse_scaled_integer("1403636579.763555584", 9), 1403636579763555584);
  EXPECT_EQ(parse_scaled_integer("1403636579763555584", 0), 1403636579763555584);
  EXPECT_EQ(parse_scaled_integer("1403636579763555584.000000", 0), 1403636579763555584);
  EXPECT_EQ(parse_scaled_integer("+0.1", 9), 100000000);
  EXPECT_EQ(parse_scaled_integer("-0.0000000015", 9), -2);
  EXPECT_EQ(parse_scaled_integer("1e3", 3), 1000000);
  EXPECT_EQ(parse_scaled_integer("555555555555555555555555d-20", 3), 5555556);
  EXPECT_EQ(parse_scaled_integer("555555555555555555555555e-655", 9), 0);
  EXPECT_FALSE(parse_scaled_integer("1e300", 9));
  EXPECT_FALSE(parse_scaled_integer("nan", 9));
}

TEST(TextTable, LineEndsMarksAndSeparatorsMakeNoDifference) {
  const std::vector<std::string_view> expected{"1", "2.5", "-3"};
  for (const char* text : {"1 2.5 -3\n", "\xef\xbb\xbf" "1 2.5 -3", "1\t2.5\t-3\r\n", "1,2.5,-3\r", " 1 ; 2.5 ; -3 ", "1, 2.5, \"-3\"\n",
                           "# a comment\n1 2.5 -3 # and one behind\n", "\n\n1 2.5   -3\n\n"}) {
    const TextTable table = read_text_table(text);
    ASSERT_EQ(table.rows.size(), 1u) << text;
    EXPECT_EQ(table.rows[0].words, expected) << text;
  }
}

TEST(TextTable, RowsKnowTheirLinesAndEmptyCells) {
  const TextTable table = read_text_table("#t,x\r\n1,,3\r\n\r\n% note\r4,5,\n");
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.rows[0].line, 2);
  EXPECT_EQ(table.rows[0].words, (std::vector<std::string_view>{"1", "", "3"}));
  EXPECT_EQ(table.rows[1].line, 5);
  EXPECT_EQ(table.rows[1].words.back(), "");
  ASSERT_EQ(table.comments.size(), 2u);
  EXPECT_EQ(table.comments[0].words, (std::vector<std::string_view>{"t", "x"}));
}

TEST(TextTable, KnowsUtf16) {
  EXPECT_TRUE(is_utf16(std::string_view("\xff\xfe" "1\0", 4)));
  EXPECT_FALSE(is_utf16("\xef\xbb\xbf" "1"));
}

}  // namespace text_table_test
}  // namespace rubble
