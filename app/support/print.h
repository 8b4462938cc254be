// All that the program prints. Names, messages and logs may come from strangers: what steers a terminal is written as
// \x1b (kernel/base/text.h). tests/app/guarded_calls_test.cpp finds the sources that print by other means.
#pragma once

#include <string>
#include <vector>

namespace rubble {

// As printf, to standard output: results.
__attribute__((format(printf, 1, 2))) void print_out(const char* format, ...);
// As printf, to standard error: progress, warnings, errors.
__attribute__((format(printf, 1, 2))) void print_err(const char* format, ...);
// "warning: " and a sentence, to standard error; each sentence once in a process, which may read one mission for many seeds.
// Any thread may call it.
void print_warnings(const std::vector<std::string>& sentences);
// JSON to standard output, where \x1b would be no JSON: \u001b.
void print_json(const std::string& json);
// A result in one of its two forms.
void print_result(const std::string& text, bool is_json);
// Replaces the last line of a terminal on standard error. end: goes on to the next line.
void redraw_line(const std::string& text, bool end);

}  // namespace rubble
