// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <systemc>
#include <type_traits>
#include <utility>

#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/link.h"
#include "rtl_model/texture/texture_unit.h"
#include "spec/error.h"
#include "tb/harness/monitor.h"

namespace deburr::tb {

// Finds a link inside the unit by its name there.
template <class T>
const rtl::Link<T>& link_of(const rtl::texture::TextureUnit& unit, const std::string& name) {
  const auto* link = dynamic_cast<const rtl::Link<T>*>(
      sc_core::sc_find_object((std::string(unit.name()) + "." + name).c_str()));
  DEBURR_CHECK(link != nullptr, "the texture unit has no link " + name);
  return *link;
}

// Calls see() with each token that is pushed into a link of the unit: at widths above 1 with each
// of a group, in order.
template <class T, class Group>
std::unique_ptr<rtl::Clocked> watch_tokens(rtl::ClockDomain& clock,
                                           const rtl::texture::TextureUnit& unit,
                                           const std::string& name,
                                           std::function<void(rtl::Cycle, const T&)> see) {
  if (unit.parameters().width == 1)
    return std::make_unique<Monitor<T>>(clock, link_of<T>(unit, name), std::move(see));
  return std::make_unique<Monitor<Group>>(
      clock, link_of<Group>(unit, name),
      [see = std::move(see)](rtl::Cycle cycle, const Group& group) {
        for (std::size_t i = 0; i < group.count; ++i) see(cycle, group.at[i]);
      });
}

}  // namespace deburr::tb
