// SPDX-License-Identifier: MIT
#include "rtl_model/platform/texture_driver.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <string>
#include <vector>

#include "rtl_model/platform/region_check.h"
#include "spec/texture/registers.h"

namespace deburr::platform {

DriverLayout TextureDriver::layout() { return {"texture unit", spec::texture::kRegisters}; }

void TextureDriver::load(std::span<const std::uint8_t> bytes) {
  const NamedRegion textures = {"textures", 0, bytes.size()};
  if (const std::string complaint = region_complaint({&textures, 1}, 1, memory_.size());
      !complaint.empty())
    reject(complaint);
  memory_.write(0, bytes);
}

void TextureDriver::check(int handle, const spec::texture::Descriptor& d) const {
  if (handle < 0 || handle >= spec::texture::kMaxTextures)
    reject(fmt::format("handle of a texture: expected 0..{}, got {}",
                       spec::texture::kMaxTextures - 1, handle));
  require_range("width of a texture", d.width, 1, spec::texture::kMaxTextureSize);
  require_range("height of a texture", d.height, 1, spec::texture::kMaxTextureSize);
  const unsigned longest = std::max(d.width, d.height);
  require_range("levels of a texture", d.levels, 1,
                static_cast<std::uint64_t>(std::bit_width(longest)));
  std::vector<std::string> names;
  names.reserve(d.levels);
  for (int k = 0; k < d.levels; ++k) names.push_back(fmt::format("level {}", k));
  std::vector<NamedRegion> levels;
  levels.reserve(d.levels);
  for (int k = 0; k < d.levels; ++k)
    levels.push_back({names[static_cast<std::size_t>(k)], d.base[static_cast<std::size_t>(k)],
                      texel_layout(d, k).bytes()});
  if (const std::string complaint =
          region_complaint(levels, spec::texture::kTileBytes, memory_.size());
      !complaint.empty())
    reject(fmt::format("texture {}: {}", handle, complaint));
}

void TextureDriver::set_texture(int handle, const spec::texture::Descriptor& descriptor) {
  check(handle, descriptor);
  require_idle("a descriptor");
  for (const auto& [offset, value] : descriptor_registers(handle, descriptor))
    registers_.write(offset, value);
}

void TextureDriver::invalidate() {
  require_idle("an invalidate command");
  registers_.write(spec::texture::reg::kControl, registers_.read(spec::texture::reg::kControl) |
                                                     spec::texture::reg::kControlInvalidate);
}

TextureWork TextureDriver::work() {
  return {registers_.read(spec::texture::reg::kFragments),
          registers_.read(spec::texture::reg::kBilinears),
          registers_.read(spec::texture::reg::kLineFills),
          registers_.read(spec::texture::reg::kClamped),
          registers_.read(spec::texture::reg::kSaturated),
          registers_.read(spec::texture::reg::kMemoryErrors),
          registers_.read(spec::texture::reg::kInvalidFragments)};
}

}  // namespace deburr::platform
