// SPDX-License-Identifier: MIT
// Files embedded into the program by the build, so that reports need no other files.
#pragma once

#include <string_view>

namespace deburr::tool::embedded {

std::string_view chart_js();             // Chart.js (MIT), from Debian's libjs-chart.js
std::string_view style_css();            // page.css
std::string_view page_template();        // page.mustache
std::string_view kit_js();               // kit.js
std::string_view report_template();      // report.mustache
std::string_view report_js();            // report.js
std::string_view sweep_template();       // sweep.mustache
std::string_view sweep_js();             // sweep.js
std::string_view comparison_template();  // comparison.mustache
std::string_view comparison_js();        // comparison.js
std::string_view regression_template();  // regression.mustache
std::string_view regression_js();        // regression.js
std::string_view papers_template();      // papers.mustache

}  // namespace deburr::tool::embedded
