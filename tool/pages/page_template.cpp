// SPDX-License-Identifier: MIT
#include "tool/pages/page_template.h"

#include "spec/error.h"

namespace deburr::tool {

std::string filled_page(std::string_view page_template, std::string_view name,
                        const kainjow::mustache::data& values) {
  kainjow::mustache::mustache page{std::string(page_template)};
  DEBURR_CHECK(page.is_valid(), std::string(name) + ": " + page.error_message());
  return page.render(values);
}

}  // namespace deburr::tool
