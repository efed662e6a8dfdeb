// SPDX-License-Identifier: MIT
#include "rtl_model/fabric/counters.h"

#include <fmt/format.h>

#include "spec/error.h"

namespace deburr::rtl {

Counter::Counter(const char* name, const char* unit, const char* meaning)
    : sc_object(name), unit_(unit), meaning_(meaning) {
  DEBURR_CHECK(!unit_.empty() && !meaning_.empty() && meaning_.find('\n') == std::string::npos,
               fmt::format("{}: a counter needs a unit and a one-line meaning", this->name()));
}

void walk(sc_core::sc_object& root, const std::function<void(sc_core::sc_object&)>& visit) {
  visit(root);
  for (sc_core::sc_object* child : root.get_child_objects()) walk(*child, visit);
}

void walk_all(const std::function<void(sc_core::sc_object&)>& visit) {
  for (sc_core::sc_object* object : sc_core::sc_get_top_level_objects()) walk(*object, visit);
}

// Out of line, to keep the code of its users small.
Counter::~Counter() = default;

}  // namespace deburr::rtl
