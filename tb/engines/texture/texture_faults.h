// SPDX-License-Identifier: MIT
// Injected faults of the texture unit: on links, in build parameters, in the BlockDecoder, in
// memory and on the way to memory.
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
  // `setup` must outlive it.
  TextureFaults(const FaultPlan& plan, std::string environment, const TextureSetup& setup)
      : EngineFaults(plan, std::move(environment)), setup_(setup) {}

  // Those of blocks need a texture in which they show.
  std::vector<InjectedFault> list(const platform::TextureMemory& textures) const;
  // Parameters of the hardware with faults; the golden model always gets the intended ones.
  spec::texture::Parameters as_built() const;
  void inject(rtl::texture::TextureUnit& unit) const;
  // Writes the textures to memory, with faults.
  void load(platform::TextureDriver& driver, const platform::TextureMemory& textures) const;
  bool fetches_again() const { return injected("duplicate-fetch"); }

 private:
  const TextureSetup& setup_;
};

}  // namespace deburr::tb
