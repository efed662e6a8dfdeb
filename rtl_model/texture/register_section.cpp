// SPDX-License-Identifier: MIT
#include "rtl_model/texture/register_section.h"

#include <cstdint>

#include "rtl_model/texture/descriptors.h"
#include "spec/texture/registers.h"

namespace deburr::rtl::texture {

RegisterSection register_section(const spec::texture::Parameters& parameters) {
  namespace reg = spec::texture::reg;
  // One descriptor represents all.
  constexpr std::uint32_t kSecond = reg::kTextureBase + reg::kTextureStride;
  RegisterSection section{"TextureUnit", "DEBURR_TEXTURE", {}};
  for (const spec::RegisterInfo& r : register_table())
    if (r.offset < kSecond) section.rows.push_back(r);
  const auto loaded = spec::texture::loaded_registers(parameters);
  section.loaded.assign(loaded.begin(), loaded.end());
  section.busy_ignores_writes = spec::texture::kBusyIgnoresWrites;
  section.repeated = {"TEXTURE", reg::kTextureStride,
                      static_cast<std::uint32_t>(spec::texture::kMaxTextures)};
  return section;
}

}  // namespace deburr::rtl::texture
