// SPDX-License-Identifier: MIT
#include "tool/regress/junit.h"

#include <fmt/format.h>

namespace deburr::tool {

void JunitReport::begin_suite(std::string name) {
  suite_name_ = std::move(name);
  suite_ = {};
  cases_.clear();
}

void JunitReport::add(const JunitCase& test) {
  ++suite_.tests;
  suite_.seconds += test.seconds;
  cases_ += fmt::format("    <testcase classname=\"{}.{}\" name=\"{}\" time=\"{:.3f}\"",
                        xml_escaped(name_), xml_escaped(suite_name_), xml_escaped(test.name),
                        test.seconds);
  if (test.outcome == JunitOutcome::kPassed) {
    cases_ += "/>\n";
    return;
  }
  const bool failed = test.outcome == JunitOutcome::kFailed;
  ++(failed ? suite_.failures : suite_.errors);
  cases_ += fmt::format(">\n      <{0} type=\"{1}\" message=\"{2}\">{3}</{0}>\n    </testcase>\n",
                        failed ? "failure" : "error", xml_escaped(test.type),
                        xml_escaped(test.message), xml_escaped(test.details));
}

void JunitReport::end_suite() {
  suites_ += fmt::format("  <testsuite name=\"{}\" {}>\n{}  </testsuite>\n",
                         xml_escaped(suite_name_), suite_.attributes(), cases_);
  all_.tests += suite_.tests;
  all_.failures += suite_.failures;
  all_.errors += suite_.errors;
  all_.seconds += suite_.seconds;
}

std::string JunitReport::text() const {
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"{}\" {}>\n{}</testsuites>\n",
      xml_escaped(name_), all_.attributes(), suites_);
}

std::string JunitReport::Counts::attributes() const {
  return fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" time=\"{:.3f}\"", tests, failures,
                     errors, seconds);
}

std::string xml_escaped(std::string_view text) {
  std::string out;
  for (const char c : text) switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\n':
        out += "&#10;";
        break;
      case '\t':
        out += "&#9;";
        break;
      default:
        // Invalid characters would make the whole file unreadable.
        out += c >= ' ' && c != '\x7f' ? c : '?';
    }
  return out;
}

}  // namespace deburr::tool
