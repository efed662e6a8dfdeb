// SPDX-License-Identifier: MIT
// What can be wrong with a texture unit on purpose: on its links, in how it is built, in memory and
// on its way there.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "rtl_model/platform/texture_driver.h"
#include "rtl_model/platform/texture_memory.h"
#include "spec/texture/parameters.h"
#include "tb/engines/texture/texture_setup.h"
#include "tb/env/injected_faults.h"

namespace deburr::tb {

class TextureFaults : public EngineFaults {
 public:
  // The setup must outlive it.
  TextureFaults(const FaultPlan& plan, std::string environment, const TextureSetup& setup)
      : EngineFaults(plan, std::move(environment)), setup_(setup) {}

  static std::vector<InjectedFault> list();
  // What the unit is built with; the golden model always gets what was ordered.
  spec::texture::Parameters as_built() const;
  // The textures, as they go to memory.
  void load(platform::TextureDriver& driver, const platform::TextureMemory& textures) const;
  bool fetches_again() const { return injected("duplicate-fetch"); }

 private:
  const TextureSetup& setup_;
};

}  // namespace deburr::tb
