#include "app/batch/junit.h"

#include <cstdio>

#include "io/base/escaped_text.h"

namespace rubble {
namespace {

std::string seconds_text(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", seconds);
  return text;
}

std::string problem(const char* kind, const std::string& message, const std::string& text) {
  return std::string("    <") + kind + " message=\"" + xml_text(message) + "\">" + xml_text(text) +
         "</" + kind + ">\n";
}

std::string make_case(const std::string& suite, const CaseResult& result) {
  std::string xml = "  <testcase classname=\"" + xml_text(suite) + "\" name=\"" +
                    xml_text(result.name) + "\" time=\"" + seconds_text(result.seconds) + "\"";
  if (result.passed()) return xml + "/>\n";
  xml += ">\n";
  if (!result.error.empty()) xml += problem("error", result.error, result.log);
  std::string all;
  for (const std::string& sentence : result.failures) all += sentence + "\n";
  if (!result.failures.empty()) xml += problem("failure", result.failures.front(), all);
  return xml + "  </testcase>\n";
}

}  // namespace

std::string make_junit(const std::string& suite, const std::vector<CaseResult>& cases) {
  std::size_t failures = 0, errors = 0;
  double seconds = 0;
  std::string body;
  for (const CaseResult& result : cases) {
    errors += !result.error.empty();
    failures += result.error.empty() && !result.failures.empty();
    seconds += result.seconds;
    body += make_case(suite, result);
  }
  const std::string counts = "tests=\"" + std::to_string(cases.size()) + "\" failures=\"" +
                             std::to_string(failures) + "\" errors=\"" + std::to_string(errors) +
                             "\" time=\"" + seconds_text(seconds) + "\"";
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites " + counts +
         ">\n<testsuite name=\"" + xml_text(suite) + "\" " + counts + ">\n" + body +
         "</testsuite>\n</testsuites>\n";
}

}  // namespace rubble
