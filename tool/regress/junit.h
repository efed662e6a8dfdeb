// SPDX-License-Identifier: MIT
// JUnit's XML, as read by continuous integration servers.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace deburr::tool {

enum class JunitOutcome : std::uint8_t { kPassed, kFailed, kError };

struct JunitCase {
  std::string name;
  double seconds = 0;
  JunitOutcome outcome = JunitOutcome::kPassed;
  std::string type, message, details;  // if it did not pass
};

class JunitReport {
 public:
  explicit JunitReport(std::string name) : name_(std::move(name)) {}
  void begin_suite(std::string name);
  void add(const JunitCase& test);  // within a suite
  void end_suite();
  std::string text() const;

 private:
  struct Counts {
    std::uint64_t tests = 0, failures = 0, errors = 0;
    double seconds = 0;
    std::string attributes() const;
  };

  std::string name_, suites_, suite_name_, cases_;
  Counts all_, suite_;
};

// For an attribute value or element text; characters that XML does not allow become '?'.
std::string xml_escaped(std::string_view text);

}  // namespace deburr::tool
