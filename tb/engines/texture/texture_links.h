// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <systemc>

#include "rtl_model/fabric/link.h"
#include "rtl_model/texture/texture_unit.h"
#include "spec/error.h"

namespace deburr::tb {

// Finds a link inside the unit by its name there.
template <class T>
const rtl::Link<T>& link_of(const rtl::texture::TextureUnit& unit, const std::string& name) {
  const auto* link = dynamic_cast<const rtl::Link<T>*>(
      sc_core::sc_find_object((std::string(unit.name()) + "." + name).c_str()));
  DEBURR_CHECK(link != nullptr, "the texture unit has no link " + name);
  return *link;
}

}  // namespace deburr::tb
