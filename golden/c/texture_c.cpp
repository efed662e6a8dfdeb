// SPDX-License-Identifier: MIT
// C interface of the texture unit: memory, descriptors by register or field name, quads.
#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "golden/c/handle.h"
#include "golden/c/texture_handle.h"

namespace deburr::golden::c {
namespace {

spec::texture::Quad quad_of(std::uint32_t texture, const std::int32_t* s, const std::int32_t* t) {
  require_below(texture, 256, "texture");
  require_pointer(s, "s");
  require_pointer(t, "t");
  spec::texture::Quad quad;
  quad.texture = static_cast<std::uint8_t>(texture);
  std::copy_n(s, 4, quad.s.begin());
  std::copy_n(t, 4, quad.t.begin());
  return quad;
}

// A decision about a fragment, by name.
std::int64_t decided(const texture::FragmentAnalysis& of, const char* what) {
  const struct {
    const char* name;
    std::int64_t value;
  } all[] = {
      {"valid", of.valid},           {"saturated", of.saturated}, {"magnified", of.lod.magnified},
      {"linear", of.lod.linear},     {"samples", of.lod.samples}, {"level", of.lod.level},
      {"fraction", of.lod.fraction}, {"lod", of.lod.l},           {"anisotropy", of.lod.anisotropy},
      {"axis_s", of.axis.s},         {"axis_t", of.axis.t}};
  std::vector<std::string> known;
  for (const auto& one : all) {
    if (std::strcmp(one.name, what) == 0) return one.value;
    known.emplace_back(one.name);
  }
  reject_name("decision", what, known);
}

}  // namespace
}  // namespace deburr::golden::c

using deburr::golden::c::array_of;
using deburr::golden::c::call_of;
using deburr::golden::c::require_below;
using deburr::golden::c::require_in_memory;
using deburr::golden::c::require_pointer;
using deburr::golden::c::TextureHandle;

extern "C" {

deburr_golden* deburr_texture_new(void) { return deburr::golden::c::new_handle<TextureHandle>(); }

int deburr_texture_memory(deburr_golden* golden, uint64_t bytes) {
  return call_of<TextureHandle>(
      golden, __func__, [&](TextureHandle& h) { deburr::golden::c::resize_memory(h, bytes); });
}

int deburr_texture_write(deburr_golden* golden, uint64_t address, const uint8_t* bytes,
                         size_t bytes_size) {
  return call_of<TextureHandle>(golden, __func__, [&](TextureHandle& h) {
    const auto from = array_of(bytes, bytes_size, "bytes");
    require_in_memory(h, address, bytes_size, "bytes");
    std::copy_n(from.data(), from.size(), h.memory.data() + address);
  });
}

int deburr_texture_read(deburr_golden* golden, uint64_t address, uint8_t* bytes,
                        size_t bytes_size) {
  return call_of<TextureHandle>(golden, __func__, [&](TextureHandle& h) {
    const auto to = array_of(bytes, bytes_size, "bytes");
    require_in_memory(h, address, bytes_size, "bytes");
    std::copy_n(h.memory.data() + address, to.size(), to.data());
  });
}

int deburr_texture_register(deburr_golden* golden, uint32_t texture, uint32_t offset,
                            uint32_t word) {
  return call_of<TextureHandle>(golden, __func__, [&](TextureHandle& h) {
    deburr::golden::c::set_register(h, texture, offset, word);
  });
}

int deburr_texture_field(deburr_golden* golden, uint32_t texture, const char* name,
                         const char* text) {
  return call_of<TextureHandle>(golden, __func__, [&](TextureHandle& h) {
    require_pointer(name, "name");
    require_pointer(text, "text");
    deburr::golden::c::set_field(h, texture, name, text);
  });
}

int deburr_texture_check(deburr_golden* golden, uint32_t texture) {
  return call_of<TextureHandle>(
      golden, __func__, [&](TextureHandle& h) { deburr::golden::c::valid_descriptor(h, texture); });
}

int deburr_texture_place(deburr_golden* golden, uint32_t texture, uint64_t address,
                         uint64_t* behind) {
  return call_of<TextureHandle>(golden, __func__, [&](TextureHandle& h) {
    require_pointer(behind, "behind");
    *behind = deburr::golden::c::place(h, texture, address);
  });
}

int deburr_texture_level(deburr_golden* golden, uint32_t texture, uint32_t level,
                         const uint8_t* texels, size_t texels_size, uint32_t stride) {
  return call_of<TextureHandle>(golden, __func__, [&](TextureHandle& h) {
    deburr::golden::c::put_level(h, texture, level, array_of(texels, texels_size, "texels"),
                                 stride);
  });
}

int deburr_texture_quad(deburr_golden* golden, uint32_t texture, uint32_t coverage,
                        uint32_t clamped, const int32_t s[4], const int32_t t[4],
                        uint8_t rgba[16]) {
  return call_of<TextureHandle>(golden, __func__, [&](TextureHandle& h) {
    auto quad = deburr::golden::c::quad_of(texture, s, t);
    require_below(coverage, 16, "coverage");
    require_below(clamped, 16, "clamped");
    require_pointer(rgba, "rgba");
    quad.coverage = static_cast<std::uint8_t>(coverage);
    quad.clamped = static_cast<std::uint8_t>(clamped);
    auto& model = h.model();
    model.clear_fills();
    const auto colours = model.process(quad);
    std::fill_n(rgba, 16, std::uint8_t{0});
    for (const auto& colour : colours)
      std::copy(colour.rgba.begin(), colour.rgba.end(), rgba + std::size_t{4} * colour.lane);
  });
}

int deburr_texture_analyse(deburr_golden* golden, uint32_t texture, uint32_t lane,
                           const int32_t s[4], const int32_t t[4], const char* what,
                           int64_t* value) {
  return call_of<TextureHandle>(golden, __func__, [&](TextureHandle& h) {
    const auto quad = deburr::golden::c::quad_of(texture, s, t);
    require_below(lane, 4, "lane");
    require_pointer(what, "what");
    require_pointer(value, "value");
    *value = deburr::golden::c::decided(h.model().analyse(quad, static_cast<int>(lane)), what);
  });
}

int deburr_texture_fills(deburr_golden* golden, uint32_t* lines, size_t lines_size,
                         uint32_t* count) {
  return call_of<TextureHandle>(golden, __func__, [&](TextureHandle& h) {
    const auto to = array_of(lines, lines_size, "lines");
    require_pointer(count, "count");
    if (!h.golden) {
      *count = 0;
      return;
    }
    const auto& fetched = h.golden->memory_lines();
    std::copy_n(fetched.begin(), std::min(fetched.size(), to.size()), to.data());
    *count = static_cast<std::uint32_t>(fetched.size());
  });
}

int deburr_texture_invalidate(deburr_golden* golden) {
  return call_of<TextureHandle>(golden, __func__, [](TextureHandle& h) {
    if (h.golden) h.golden->invalidate_cache();
  });
}

}  // extern "C"
