// SPDX-License-Identifier: MIT
// The texture unit's part of the C interface: a memory, descriptors by registers or by names of
// their fields, quads.
#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <vector>

#include "golden/c/handle.h"
#include "golden/c/parameter_texts.h"
#include "golden/texture/sampling.h"
#include "golden/texture/texture_golden.h"
#include "spec/error.h"
#include "spec/texture/check_build.h"
#include "spec/texture/registers.h"

namespace deburr::golden::c {
namespace {

namespace reg = spec::texture::reg;

constexpr std::uint64_t kMostMemory = std::uint64_t{1} << 32;
constexpr std::uint32_t kDescriptorWords =
    reg::kLevelBase / 4 + static_cast<std::uint32_t>(spec::texture::kMaxLevels);
using DescriptorWords = std::array<std::uint32_t, kDescriptorWords>;

// What the registers of a descriptor hold, masked as they are.
spec::texture::Descriptor descriptor_of(const DescriptorWords& words) {
  const std::uint32_t size = words[reg::kSize / 4], mode = words[reg::kMode / 4];
  const std::uint32_t clamp = words[reg::kLodClamp / 4];
  spec::texture::Descriptor d;
  d.width = static_cast<std::uint16_t>(reg::size::kWidth.of(size));
  d.height = static_cast<std::uint16_t>(reg::size::kHeight.of(size));
  d.levels = static_cast<std::uint8_t>(reg::mode::kLevels.of(mode));
  d.format = static_cast<spec::texture::Format>(reg::mode::kFormat.of(mode));
  d.layout = static_cast<spec::texture::Layout>(reg::mode::kLayout.of(mode));
  d.wrap_s = static_cast<spec::texture::Wrap>(reg::mode::kWrapS.of(mode));
  d.wrap_t = static_cast<spec::texture::Wrap>(reg::mode::kWrapT.of(mode));
  d.min_filter = static_cast<spec::texture::MinFilter>(reg::mode::kMinFilter.of(mode));
  d.mag_filter = static_cast<spec::texture::MagFilter>(reg::mode::kMagFilter.of(mode));
  d.max_anisotropy_log2 = static_cast<std::uint8_t>(reg::mode::kMaxCount.of(mode));
  d.lod_bias = static_cast<std::int16_t>(reg::lod_bias::kBias.of(words[reg::kLodBias / 4]));
  d.min_lod = static_cast<std::uint16_t>(reg::lod_clamp::kMinLod.of(clamp));
  d.max_lod = static_cast<std::uint16_t>(reg::lod_clamp::kMaxLod.of(clamp));
  std::copy_n(words.begin() + reg::kLevelBase / 4, d.base.size(), d.base.begin());
  return d;
}

// After a reset a register of a descriptor is 0.
struct TextureHandle final : deburr_golden {
  static constexpr const char* kWanted = "texture";

  const char* engine() const override { return "texture"; }
  void set(std::string_view name, std::string_view text) override {
    texts.set(name, text);
    stale = true;
  }
  std::string get(std::string_view name) const override { return texts.get(name); }
  void check() const override { check_build(texts.values()); }
  std::span<const std::string> parameter_names() const override { return texts.names(); }
  std::span<const Counter> counters() override {
    const texture::TextureWork work = golden ? golden->work() : texture::TextureWork{};
    shown = {{"fragments", work.fragments},
             {"invalid_fragments", work.invalid_fragments},
             {"clamped", work.clamped},
             {"saturated", work.saturated},
             {"magnified", work.magnified},
             {"samples", work.samples},
             {"bilinears", work.bilinears},
             {"line_fills", work.line_fills},
             {"memory_errors", work.memory_errors}};
    return shown;
  }
  void reset() override {
    if (golden) golden->reset();
  }

  // The model, made anew where a parameter or the memory has changed.
  texture::TextureGolden& model() {
    if (golden && !stale) return *golden;
    auto fresh = std::make_unique<texture::TextureGolden>(texts.values(), memory);
    for (std::size_t i = 0; i < textures.size(); ++i)
      fresh->set_texture(static_cast<int>(i), descriptor_of(textures[i]));
    fresh->record_fills(true);
    golden = std::move(fresh);
    stale = false;
    return *golden;
  }
  void put_words(std::uint32_t texture, const DescriptorWords& words) {
    if (golden) golden->set_texture(static_cast<int>(texture), descriptor_of(words));
    textures[texture] = words;
  }
  DescriptorWords& words(std::uint32_t texture) {
    require_below(texture, textures.size(), "texture");
    return textures[texture];
  }

  ParameterTexts<spec::texture::Parameters> texts{
      "texture", [](const spec::texture::Parameters& p) {
        return spec::texture::preset_parameters(p.preset);
      }};
  std::vector<std::uint8_t> memory;
  std::array<DescriptorWords, spec::texture::kMaxTextures> textures{};
  std::unique_ptr<texture::TextureGolden> golden;
  bool stale = false;
  std::vector<Counter> shown;
};

void require_in_memory(const TextureHandle& h, std::uint64_t address, std::uint64_t bytes,
                       const std::string& what) {
  require(address <= h.memory.size() && bytes <= h.memory.size() - address,
          what + ", " + std::to_string(bytes) + " bytes from " + std::to_string(address) +
              ", is outside the memory of " + std::to_string(h.memory.size()) +
              " bytes; deburr_texture_memory makes it larger");
}

// ConfigError where quads would be given zero.
spec::texture::Descriptor valid_descriptor(TextureHandle& h, std::uint32_t texture) {
  const spec::texture::Descriptor d = descriptor_of(h.words(texture));
  if (const char* fault = texture::descriptor_fault(d))
    throw spec::ConfigError("texture " + std::to_string(texture) + ": " + fault);
  return d;
}

std::string level_name(int level) { return "base" + std::to_string(level); }

// Sets a field of a descriptor's registers, or the base of a level.
void set_field(DescriptorWords& words, std::string_view name, std::string_view text) {
  for (std::uint32_t level = 0; level < spec::texture::kMaxLevels; ++level) {
    if (name != level_name(static_cast<int>(level))) continue;
    words[reg::kLevelBase / 4 + level] =
        static_cast<std::uint32_t>(number_in_range(name, text, 0, 0xFFFFFFFF));
    return;
  }
  std::vector<std::string> known;
  for (const spec::RegisterInfo& info : spec::texture::kDescriptorRegisters) {
    for (const spec::Field& field : info.fields) {
      known.emplace_back(field.name);
      if (field.name != name) continue;
      std::int64_t value = 0;
      if (!field.codes.empty()) {
        value = static_cast<std::int64_t>(code_of(name, text, field.codes));
      } else {
        const std::int64_t most = field.of(field.mask());
        const bool has_sign = field.name == reg::lod_bias::kBias.name;
        value = has_sign ? number_in_range(name, text, -(most / 2) - 1, most / 2)
                         : number_in_range(name, text, 0, most);
      }
      std::uint32_t& word = words[info.offset / 4];
      word = (word & ~field.mask()) | field.in(static_cast<std::uint32_t>(value));
      return;
    }
  }
  known.push_back(level_name(0) + " to " + level_name(spec::texture::kMaxLevels - 1));
  refuse_name("field of a texture", name, known);
}

// The texels of a level, row by row, to where its layout has them.
void put_texels(TextureHandle& h, const spec::texture::Descriptor& d, int level,
                const std::uint8_t* texels, std::size_t distance) {
  const texture::LevelAddresses addresses = texture::level_addresses(d, level);
  const std::size_t bytes = spec::texture::kFormatBytes[static_cast<std::size_t>(d.format)];
  for (std::size_t y = 0; y < addresses.row.size(); ++y)
    for (std::size_t x = 0; x < addresses.column.size(); ++x)
      std::memcpy(h.memory.data() + (addresses.column[x] + addresses.row[y]),
                  texels + y * distance + x * bytes, bytes);
}

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

// What is decided about a fragment, by name.
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
  refuse_name("decision", what, known);
}

}  // namespace
}  // namespace deburr::golden::c

using deburr::golden::c::array_of;
using deburr::golden::c::call_of;
using deburr::golden::c::require;
using deburr::golden::c::require_below;
using deburr::golden::c::require_in_memory;
using deburr::golden::c::require_pointer;
using deburr::golden::c::TextureHandle;

extern "C" {

deburr_golden* deburr_texture_new(void) { return deburr::golden::c::new_handle<TextureHandle>(); }

int deburr_texture_memory(deburr_golden* golden, uint64_t bytes) {
  return call_of<TextureHandle>(golden, __func__, [&](TextureHandle& h) {
    require(bytes <= deburr::golden::c::kMostMemory,
            std::to_string(bytes) + " bytes; at most 2^32 have an address");
    std::vector<std::uint8_t> memory(static_cast<std::size_t>(bytes));
    std::copy_n(h.memory.begin(), std::min(h.memory.size(), memory.size()), memory.begin());
    // The model looks at the memory that goes.
    h.golden.reset();
    h.memory.swap(memory);
  });
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
    auto words = h.words(texture);
    require(offset % 4 == 0 && offset / 4 < words.size(),
            "offset " + std::to_string(offset) + " is none of a descriptor's registers, 0, 4, .. " +
                std::to_string(4 * (words.size() - 1)));
    words[offset / 4] = word;
    h.put_words(texture, words);
  });
}

int deburr_texture_field(deburr_golden* golden, uint32_t texture, const char* name,
                         const char* text) {
  return call_of<TextureHandle>(golden, __func__, [&](TextureHandle& h) {
    require_pointer(name, "name");
    require_pointer(text, "text");
    auto words = h.words(texture);
    deburr::golden::c::set_field(words, name, text);
    h.put_words(texture, words);
  });
}

int deburr_texture_check(deburr_golden* golden, uint32_t texture) {
  return call_of<TextureHandle>(
      golden, __func__, [&](TextureHandle& h) { deburr::golden::c::valid_descriptor(h, texture); });
}

int deburr_texture_place(deburr_golden* golden, uint32_t texture, uint64_t address,
                         uint64_t* behind) {
  return call_of<TextureHandle>(golden, __func__, [&](TextureHandle& h) {
    namespace reg = deburr::spec::texture::reg;
    auto words = h.words(texture);
    require_pointer(behind, "behind");
    require(address % 64 == 0,
            "address " + std::to_string(address) + " is no multiple of 64, as bases are");
    // The bases that are there may be what makes the descriptor invalid.
    std::fill(words.begin() + reg::kLevelBase / 4, words.end(), 0);
    const auto d = deburr::golden::c::descriptor_of(words);
    if (const char* fault = deburr::golden::texture::descriptor_fault(d))
      throw deburr::spec::ConfigError("texture " + std::to_string(texture) + ": " + fault);
    std::uint64_t next = address;
    for (std::uint32_t level = 0; level < d.levels; ++level) {
      words[reg::kLevelBase / 4 + level] = static_cast<std::uint32_t>(next);
      next += deburr::golden::texture::level_bytes(d, static_cast<int>(level));
      require(address < deburr::golden::c::kMostMemory && next <= deburr::golden::c::kMostMemory,
              "the texture would end behind address 2^32");
    }
    h.put_words(texture, words);
    *behind = next;
  });
}

int deburr_texture_level(deburr_golden* golden, uint32_t texture, uint32_t level,
                         const uint8_t* texels, size_t texels_size, uint32_t stride) {
  return call_of<TextureHandle>(golden, __func__, [&](TextureHandle& h) {
    namespace texture_model = deburr::golden::texture;
    const auto d = deburr::golden::c::valid_descriptor(h, texture);
    require_below(level, d.levels, "level");
    const auto given = array_of(texels, texels_size, "texels");
    const int k = static_cast<int>(level);
    const std::size_t bytes =
        deburr::spec::texture::kFormatBytes[static_cast<std::size_t>(d.format)];
    const auto width = static_cast<std::size_t>(texture_model::level_size(d.width, k));
    const auto height = static_cast<std::size_t>(texture_model::level_size(d.height, k));
    const std::size_t distance =
        deburr::golden::c::row_distance("texels", texels_size, width * bytes, height, stride);
    require_in_memory(h, d.base[level], texture_model::level_bytes(d, k),
                      "level " + std::to_string(level));
    deburr::golden::c::put_texels(h, d, k, given.data(), distance);
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
    const auto& fills = h.golden->fills();
    std::copy_n(fills.begin(), std::min(fills.size(), to.size()), to.data());
    *count = static_cast<std::uint32_t>(fills.size());
  });
}

int deburr_texture_invalidate(deburr_golden* golden) {
  return call_of<TextureHandle>(golden, __func__, [](TextureHandle& h) {
    if (h.golden) h.golden->invalidate_cache();
  });
}

}  // extern "C"
