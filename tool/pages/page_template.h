// SPDX-License-Identifier: MIT
// A page from its template. Reading and filling one are templates: compiled here once, and not for
// every page.
#pragma once

#include <kainjow/mustache.hpp>
#include <string>
#include <string_view>

namespace deburr::tool {

// `name` is the file of the template, for what is said of one that is not valid.
std::string filled_page(std::string_view page_template, std::string_view name,
                        const kainjow::mustache::data& values);

}  // namespace deburr::tool
