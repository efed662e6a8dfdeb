// SPDX-License-Identifier: MIT
// Figures of the texture unit: units and counters, and costs per fragment.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "rtl_model/platform/memory_model.h"
#include "rtl_model/platform/texture_memory.h"
#include "rtl_model/texture/texture_unit.h"
#include "tb/env/meter.h"

namespace deburr::tb {

class TextureMeter : public Meter {
 public:
  // All arguments must outlive it.
  TextureMeter(std::string name, const rtl::texture::TextureUnit& unit,
               const platform::MemoryModel& memory, const platform::TextureMemory& textures)
      : Meter(std::move(name)), unit_(unit), memory_(memory), textures_(textures) {}

  void collect(Result& result) const;
  void show_parts(Observer& observer, const rtl::LinkBase& in, const rtl::LinkBase& out) const;
  void collect_headline(Result& result) const;

 private:
  // Whether lookups are counted; a replaced cache does not count them.
  bool looks_up() const { return !unit_.cache.tag_stage.replaced(); }
  void collect_lookups(Result& result, double texel_hits) const;

  const rtl::texture::TextureUnit& unit_;
  const platform::MemoryModel& memory_;
  const platform::TextureMemory& textures_;
};

}  // namespace deburr::tb
