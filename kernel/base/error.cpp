#include "kernel/base/error.h"

#include "kernel/base/text.h"

namespace rubble {
namespace {

std::string join(const std::vector<Diagnostic>& diagnostics) {
  std::string text;
  for (const Diagnostic& d : diagnostics) text += (text.empty() ? "" : "\n") + d.text();
  return text;
}

}  // namespace

std::string Diagnostic::text() const {
  std::string out = file;
  if (line > 0) out += ":" + std::to_string(line);
  const auto add = [&out](const std::string& part) {
    if (!part.empty()) out += (out.empty() ? "" : ": ") + part;
  };
  add(key);
  add(message);
  std::string comparison;
  if (!expected.empty()) comparison = "expected " + expected;
  if (!found.empty()) comparison += (comparison.empty() ? "found " : ", found ") + found;
  add(comparison);
  if (!hint.empty()) out += " (" + hint + ")";
  return printable(out);  // keys and strings of a script may hold anything
}

InputError::InputError(Diagnostic diagnostic)
    : InputError(std::vector<Diagnostic>{std::move(diagnostic)}) {}

InputError::InputError(std::vector<Diagnostic> diagnostics)
    : std::runtime_error(join(diagnostics)), diagnostics_(std::move(diagnostics)) {}

}  // namespace rubble
