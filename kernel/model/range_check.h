// Collects what is out of range in a description, so that a user reads of all mistakes at once.
#pragma once

#include <string>
#include <vector>

#include "kernel/base/error.h"
#include "kernel/base/number_text.h"

namespace rubble {

class RangeCheck {
 public:
  // key: of the whole, as in "pile.assemblies.chain"; a member is named by what follows it.
  explicit RangeCheck(const std::string& key) : key_(key) {}
  void expect(bool fine, const std::string& member, const std::string& message,
              const std::string& expected, const std::string& found) {
    if (!fine) problems_.push_back({"", 0, key_ + member, message, expected, found, ""});
  }
  void expect(bool fine, const std::string& member, const std::string& expected, double found) {
    expect(fine, member, "out of range", expected, plain_text(found));
  }
  // Throws InputError with all that was not fine.
  void finish() const {
    if (!problems_.empty()) throw InputError(problems_);
  }

 private:
  std::string key_;
  std::vector<Diagnostic> problems_;
};

}  // namespace rubble
