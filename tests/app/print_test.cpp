// What is printed steers no terminal.
#include "app/support/print.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace rubble {
namespace print_test {

using ::testing::internal::CaptureStderr, ::testing::internal::CaptureStdout;
using ::testing::internal::GetCapturedStderr, ::testing::internal::GetCapturedStdout;

TEST(Print, EscapesWhatSteersATerminal) {
  CaptureStdout(), CaptureStderr();
  print_out("%s: %d\n", "a\x1b[2J", 7);
  print_err("%s\n", "\x1b]0;title\x07\r\xc2\x9b" "31m");
  EXPECT_EQ(GetCapturedStdout(), "a\\x1b[2J: 7\n");
  EXPECT_EQ(GetCapturedStderr(), "\\x1b]0;title\\x07\\x0d\\xc2\\x9b31m\n");
}

TEST(Print, TakesTextsOfAnyLength) {
  const std::string text(100000, 'x');
  CaptureStdout();
  print_out("%s", text.c_str());
  EXPECT_EQ(GetCapturedStdout(), text);
}

TEST(Print, JsonStaysJson) {
  const nlohmann::json json{{"name", "a\x1b[2J\x7f\xc2\x9b" "31m \xc3\xa9"}};
  CaptureStdout();
  print_json(json.dump());
  const std::string printed = GetCapturedStdout();
  for (const char c : printed) EXPECT_FALSE((c >= 0 && c < 0x20) || c == 0x7f) << printed;
  EXPECT_EQ(printed.find("\xc2\x9b"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(printed), json);
}

TEST(Print, ALineIsRedrawnByOurOwnControlsAlone) {
  CaptureStderr();
  redraw_line("a\x1b[2J\n", false);
  EXPECT_EQ(GetCapturedStderr(), "\r\033[Ka\\x1b[2J\n");
}

}  // namespace print_test
}  // namespace rubble
