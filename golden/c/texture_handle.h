// SPDX-License-Identifier: MIT
// A texture unit in the bindings to other languages: memory, descriptors by register or field name,
// and the model made from them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "golden/c/handle.h"
#include "golden/c/parameter_texts.h"
#include "golden/texture/texture_golden.h"
#include "spec/texture/check_build.h"
#include "spec/texture/registers.h"

namespace deburr::golden::c {

inline constexpr std::uint64_t kMostMemory = std::uint64_t{1} << 32;
inline constexpr std::uint32_t kDescriptorWords =
    spec::texture::reg::kLevelBase / 4 + static_cast<std::uint32_t>(spec::texture::kMaxLevels);
using DescriptorWords = std::array<std::uint32_t, kDescriptorWords>;

// Decodes the registers of a descriptor, masked to their fields.
spec::texture::Descriptor descriptor_of(const DescriptorWords& words);

// Descriptor registers are 0 after a reset.
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

  void set_error_lines(ErrorLines lines) override {
    if (golden) golden->set_error_lines(lines);
    error_lines = std::move(lines);
  }

  // The model; a changed parameter or memory creates a new one.
  texture::TextureGolden& model() {
    if (golden && !stale) return *golden;
    auto fresh = std::make_unique<texture::TextureGolden>(texts.values(), memory);
    for (std::size_t i = 0; i < textures.size(); ++i)
      fresh->set_texture(static_cast<int>(i), descriptor_of(textures[i]));
    fresh->record_fills(true);
    fresh->set_error_lines(error_lines);
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
        return spec::texture::preset_parameters(p.preset, p.build);
      }};
  std::vector<std::uint8_t> memory;
  std::array<DescriptorWords, spec::texture::kMaxTextures> textures{};
  std::unique_ptr<texture::TextureGolden> golden;
  bool stale = false;
  ErrorLines error_lines;
  std::vector<Counter> shown;
  // The advice in the error about addresses beyond the memory.
  std::string_view remedy = "deburr_texture_memory makes it larger";
};

// Throws ArgumentError for bytes beyond the memory; `what`: their name in the error.
void require_in_memory(const TextureHandle& h, std::uint64_t address, std::uint64_t bytes,
                       const std::string& what);
// Implement deburr_texture_memory, _register, _field, _check, _place and _level.
void resize_memory(TextureHandle& h, std::uint64_t bytes);
void set_register(TextureHandle& h, std::uint32_t texture, std::uint32_t offset,
                  std::uint32_t word);
void set_field(TextureHandle& h, std::uint32_t texture, std::string_view name,
               std::string_view text);
// Throws ConfigError for an invalid descriptor, whose quads would get zero.
spec::texture::Descriptor valid_descriptor(TextureHandle& h, std::uint32_t texture);
std::uint64_t place(TextureHandle& h, std::uint32_t texture, std::uint64_t address);
void put_level(TextureHandle& h, std::uint32_t texture, std::uint32_t level,
               std::span<const std::uint8_t> texels, std::uint32_t stride);

}  // namespace deburr::golden::c
