// SPDX-License-Identifier: MIT
// The texture unit through the C interface equals the golden model bit for bit, with textures set
// by registers, by field names and by texels; invalid calls change nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "golden/texture/texture_golden.h"
#include "spec/texture/check_build.h"
#include "spec/texture/registers.h"
#include "tb/stimuli/texture_quads.h"
#include "tb/unit/golden/c/support.h"

namespace deburr::texture_test {
namespace {

using golden::texture::TextureGolden;
using spec::texture::Descriptor;
using tb::Random;
using tb::c::counter_of;
using tb::c::expect_ok;
using tb::c::expect_rejected;
using tb::c::Handle;
namespace reg = spec::texture::reg;

constexpr std::uint32_t kMemoryBytes = 1 << 16;

// Sets every parameter by its text.
void set_all(deburr_golden* golden, const spec::texture::Parameters& parameters) {
  for (const std::string& name : tb::c::names_of(golden)) {
    const std::string text = spec::value_text(parameters, name);
    expect_ok(golden, deburr_set(golden, name.c_str(), text.c_str()));
  }
}

void set_registers(deburr_golden* golden, std::uint32_t texture, const Descriptor& d) {
  const std::array<std::uint32_t, 4> words = {
      spec::texture::size_word(d), spec::texture::mode_word(d), spec::texture::lod_bias_word(d),
      spec::texture::lod_clamp_word(d)};
  // Unused bits are set, and must be ignored.
  for (std::uint32_t i = 0; i < words.size(); ++i)
    expect_ok(golden,
              deburr_texture_register(golden, texture, 4 * i,
                                      words[i] | ~spec::texture::kDescriptorRegisters[i].mask()));
  for (std::uint32_t level = 0; level < d.base.size(); ++level)
    expect_ok(golden,
              deburr_texture_register(golden, texture, reg::kLevelBase + 4 * level, d.base[level]));
}

template <class Enum, std::size_t N>
std::string word(Enum code, const std::array<std::string_view, N>& names) {
  return std::string(names[static_cast<std::size_t>(code)]);
}

void set_fields(deburr_golden* golden, std::uint32_t texture, const Descriptor& d) {
  const auto set = [&](const std::string& name, const std::string& text) {
    expect_ok(golden, deburr_texture_field(golden, texture, name.c_str(), text.c_str()));
  };
  set("width", std::to_string(d.width));
  set("height", std::to_string(d.height));
  set("levels", std::to_string(d.levels));
  set("format", word(d.format, spec::texture::kFormatNames));
  set("srgb", d.srgb ? "1" : "0");
  set("layout", word(d.layout, spec::texture::kLayoutNames));
  set("wrap_s", word(d.wrap_s, spec::texture::kWrapNames));
  set("wrap_t", word(d.wrap_t, spec::texture::kWrapNames));
  set("min_filter", word(d.min_filter, spec::texture::kMinFilterNames));
  set("mag_filter", word(d.mag_filter, spec::texture::kMagFilterNames));
  set("max_count_log2", std::to_string(d.max_anisotropy_log2));
  set("bias", std::to_string(d.lod_bias));
  set("min_lod", std::to_string(d.min_lod));
  set("max_lod", std::to_string(d.max_lod));
  for (std::size_t level = 0; level < d.base.size(); ++level)
    set("base" + std::to_string(level), std::to_string(d.base[level]));
}

struct Quad : spec::texture::Quad {
  explicit Quad(const spec::texture::Quad& quad) : spec::texture::Quad(quad) {}
  int process(deburr_golden* golden, std::array<std::uint8_t, 16>& rgba) const {
    return deburr_texture_quad(golden, texture, coverage, clamped, s.data(), t.data(), rgba.data());
  }
};

std::array<std::uint8_t, 16> by_lanes(const golden::texture::QuadColours& colours) {
  std::array<std::uint8_t, 16> rgba{};
  for (const spec::texture::Colour& colour : colours)
    std::copy(colour.rgba.begin(), colour.rgba.end(),
              rgba.begin() + std::ptrdiff_t{4} * colour.lane);
  return rgba;
}

TEST(Quads, MatchGoldenWithRandomConfigurations) {
  Random random(31);
  std::vector<std::uint8_t> memory(kMemoryBytes);
  for (std::uint8_t& byte : memory) byte = static_cast<std::uint8_t>(random.next());
  std::uint64_t fills = 0, coloured = 0;
  for (int trial = 0; trial < 40; ++trial) {
    auto parameters = tb::stimuli::random_configuration(random);
    parameters.bc =
        tb::stimuli::any_code<spec::texture::BlockRule>(random, spec::texture::kBlockRuleNames);
    if (trial % 4 != 0) parameters.decode = spec::texture::Decode::kAfter;
    parameters.cache_bytes = 1 << random.between(10, 13);
    parameters.cache_replacement =
        tb::stimuli::any_code<spec::texture::Replacement>(random, spec::texture::kReplacementNames);
    TextureGolden golden(parameters, memory);
    golden.record_fills(true);
    const Handle handle(deburr_texture_new());
    set_all(handle.get(), parameters);
    if (trial % 2 == 1) {
      std::vector<std::uint32_t> lines;
      for (std::uint32_t line = 0; line < kMemoryBytes / 16; line += 3) lines.push_back(line);
      golden.set_error_lines([](std::uint32_t line) { return line % 3 == 0; });
      expect_ok(handle, deburr_error_lines(handle.get(), lines.data(), lines.size()));
    }
    expect_ok(handle, deburr_texture_memory(handle.get(), kMemoryBytes));
    expect_ok(handle, deburr_texture_write(handle.get(), 0, memory.data(), memory.size()));
    for (std::uint32_t texture = 0; texture < 4; ++texture) {
      Descriptor d = tb::stimuli::random_texture(random, kMemoryBytes);
      d.srgb = spec::texture::may_be_srgb(d.format) && random.chance(500);
      if (texture == 3) tb::stimuli::spoil(random, d);
      golden.set_texture(static_cast<int>(texture), d);
      if (texture == 3 || random.chance(500)) {
        set_registers(handle.get(), texture, d);
      } else {
        set_fields(handle.get(), texture, d);
      }
      const bool is_valid = golden::texture::valid(d, parameters.decode);
      EXPECT_TRUE(is_valid || texture == 3 || trial % 4 == 0);
      EXPECT_EQ(deburr_texture_check(handle.get(), texture),
                is_valid ? DEBURR_OK : DEBURR_CONFIGURATION);
    }
    for (std::uint32_t i = 0; i < 100; ++i) {
      const auto texture = static_cast<std::uint8_t>(random.chance(20) ? 200 : random.below(4));
      const Quad quad(tb::stimuli::random_quad(random, 0, texture));
      const auto lane = static_cast<std::uint32_t>(random.below(4));
      const auto analysed = golden.analyse(quad, static_cast<int>(lane));
      for (const auto& [what, expected] :
           {std::pair<const char*, std::int64_t>{"samples", analysed.lod.samples},
            {"level", analysed.lod.level},
            {"fraction", analysed.lod.fraction},
            {"valid", analysed.valid},
            {"saturated", analysed.saturated},
            {"magnified", analysed.lod.magnified},
            {"linear", analysed.lod.linear},
            {"lod", analysed.lod.l},
            {"anisotropy", analysed.lod.anisotropy},
            {"axis_s", analysed.axis.s},
            {"axis_t", analysed.axis.t}}) {
        std::int64_t value = -1;
        expect_ok(handle, deburr_texture_analyse(handle.get(), quad.texture, lane, quad.s.data(),
                                                 quad.t.data(), what, &value));
        EXPECT_EQ(value, expected) << what;
      }
      golden.clear_fills();
      const auto expected = by_lanes(golden.process(quad));
      std::array<std::uint8_t, 16> rgba;
      rgba.fill(0xA5);
      expect_ok(handle, quad.process(handle.get(), rgba));
      ASSERT_EQ(rgba, expected);
      std::vector<std::uint32_t> lines(golden.fills().size() + 1, ~0u);
      std::uint32_t count = 0;
      expect_ok(handle, deburr_texture_fills(handle.get(), lines.data(), lines.size(), &count));
      ASSERT_EQ(count, golden.fills().size());
      EXPECT_EQ(lines.back(), ~0u);
      lines.pop_back();
      ASSERT_EQ(lines, golden.fills());
      fills += count;
      coloured += std::count_if(rgba.begin(), rgba.end(), [](std::uint8_t c) { return c != 0; });
    }
    const golden::texture::TextureWork& work = golden.work();
    EXPECT_EQ(counter_of(handle.get(), "fragments"), work.fragments);
    EXPECT_EQ(counter_of(handle.get(), "invalid_fragments"), work.invalid_fragments);
    EXPECT_EQ(counter_of(handle.get(), "clamped"), work.clamped);
    EXPECT_EQ(counter_of(handle.get(), "saturated"), work.saturated);
    EXPECT_EQ(counter_of(handle.get(), "magnified"), work.magnified);
    EXPECT_EQ(counter_of(handle.get(), "samples"), work.samples);
    EXPECT_EQ(counter_of(handle.get(), "bilinears"), work.bilinears);
    EXPECT_EQ(counter_of(handle.get(), "line_fills"), work.line_fills);
    EXPECT_EQ(counter_of(handle.get(), "memory_errors"), work.memory_errors);
  }
  EXPECT_GT(fills, 1000u);
  EXPECT_GT(coloured, 10000u);
}

// Every register that counts has a counter of the same name in lower case.
TEST(Counters, CounterNamesMatchRegisters) {
  const Handle handle(deburr_texture_new());
  for (const spec::RegisterInfo& info : spec::texture::kRegisters) {
    if (!info.is_number() || info.offset == reg::kId) continue;
    std::string name(info.name);
    std::transform(name.begin(), name.end(), name.begin(),
                   [](char c) { return static_cast<char>(std::tolower(c)); });
    EXPECT_EQ(counter_of(handle.get(), name), 0u);
  }
}

// The texels or blocks of a mip chain, in either layout, are found at the addresses that the golden
// model computes.
TEST(Levels, TexelsAndBlocksLieAtGoldenAddresses) {
  Random random(7);
  for (int trial = 0; trial < 60; ++trial) {
    Descriptor d = tb::stimuli::random_texture(random, kMemoryBytes);
    d.width = static_cast<std::uint16_t>(random.between(1, 90));
    d.height = static_cast<std::uint16_t>(random.between(1, 90));
    d.levels = static_cast<std::uint8_t>(std::bit_width(unsigned{std::max(d.width, d.height)}));
    const Handle handle(deburr_texture_new());
    expect_ok(handle, deburr_set(handle.get(), "decode", "after"));
    set_fields(handle.get(), 5, d);
    std::uint64_t end_address = 0;
    const std::uint64_t first = 64u * random.below(100);
    expect_ok(handle, deburr_texture_place(handle.get(), 5, first, &end_address));
    std::uint64_t next = first, end_of_level = first;
    for (std::uint32_t k = 0; k < d.levels; ++k) {
      d.base[k] = static_cast<std::uint32_t>(next);
      end_of_level = next + golden::texture::level_bytes(d, static_cast<int>(k));
      next = (end_of_level + 63) / 64 * 64;
    }
    EXPECT_EQ(end_address, next);
    // First the memory is one byte too small for the last level.
    expect_ok(handle, deburr_texture_memory(handle.get(), end_of_level - 1));
    // Rows of texels or of blocks.
    const auto format = static_cast<std::size_t>(d.format);
    const bool blocks = spec::texture::is_compressed(d.format);
    const std::size_t side = blocks ? 4 : 1;
    const std::size_t bytes =
        blocks ? spec::texture::kFormatBlockBytes[format] : spec::texture::kFormatBytes[format];
    for (std::uint32_t k = 0; k < d.levels; ++k) {
      const auto count = [&](std::uint16_t size) {
        const auto texels =
            static_cast<std::size_t>(golden::texture::level_size(size, static_cast<int>(k)));
        return (texels + side - 1) / side;
      };
      const std::size_t width = count(d.width), height = count(d.height);
      const std::size_t stride = random.chance(500) ? 0 : width * bytes + random.below(9);
      const std::size_t distance = stride == 0 ? width * bytes : stride;
      std::vector<std::uint8_t> texels((height - 1) * distance + width * bytes);
      for (std::uint8_t& byte : texels) byte = static_cast<std::uint8_t>(random.next());
      const auto put = [&](std::size_t size) {
        return deburr_texture_level(handle.get(), 5, k, texels.data(), size,
                                    static_cast<std::uint32_t>(stride));
      };
      expect_rejected(handle, "texels_size is ", put(texels.size() - 1));
      if (k + 1 == d.levels) {
        expect_rejected(handle, "is outside the memory of ", put(texels.size()));
        expect_ok(handle, deburr_texture_memory(handle.get(), next));
      }
      expect_ok(handle, put(texels.size()));
      for (std::size_t y = 0; y < height; ++y) {
        for (std::size_t x = 0; x < width; ++x) {
          std::array<std::uint8_t, 16> read{};
          const std::uint32_t address = golden::texture::texel_address(
              d, static_cast<int>(k), static_cast<std::int32_t>(side * x),
              static_cast<std::int32_t>(side * y));
          expect_ok(handle, deburr_texture_read(handle.get(), address, read.data(), bytes));
          ASSERT_TRUE(std::equal(read.begin(), read.begin() + static_cast<std::ptrdiff_t>(bytes),
                                 texels.data() + y * distance + x * bytes));
        }
      }
    }
  }
}

// A texture unit with a white texture of 4 x 4 texels at address 0.
Handle white_texture() {
  Handle handle(deburr_texture_new());
  for (const auto& [name, text] : {std::pair<const char*, const char*>{"width", "4"},
                                   {"height", "4"},
                                   {"levels", "1"},
                                   {"format", "rgba8"}})
    expect_ok(handle, deburr_texture_field(handle.get(), 0, name, text));
  expect_ok(handle, deburr_texture_memory(handle.get(), 256));
  const std::vector<std::uint8_t> white(64, 255);
  std::uint64_t end_address = 0;
  expect_ok(handle, deburr_texture_place(handle.get(), 0, 0, &end_address));
  expect_ok(handle, deburr_texture_level(handle.get(), 0, 0, white.data(), white.size(), 0));
  return handle;
}

constexpr std::array<std::int32_t, 4> kZero{};
std::uint8_t first_red(deburr_golden* golden) {
  std::array<std::uint8_t, 16> rgba{};
  expect_ok(golden, deburr_texture_quad(golden, 0, 1, 0, kZero.data(), kZero.data(), rgba.data()));
  return rgba[0];
}

TEST(Quads, WriteExactlySixteenBytes) {
  const Handle handle = white_texture();
  std::array<std::uint8_t, 20> rgba;
  constexpr std::uint8_t kGuard = 0xA5;
  rgba.fill(kGuard);
  expect_ok(handle,
            deburr_texture_quad(handle.get(), 0, 0, 0, kZero.data(), kZero.data(), rgba.data()));
  for (std::size_t i = 0; i < rgba.size(); ++i) EXPECT_EQ(rgba[i], i < 16 ? 0 : kGuard) << i;
}

TEST(State, ParameterChangeClearsCountersNotTextures) {
  const Handle handle = white_texture();
  EXPECT_EQ(first_red(handle.get()), 255);
  EXPECT_EQ(counter_of(handle.get(), "line_fills"), 1u);
  EXPECT_EQ(first_red(handle.get()), 255);
  EXPECT_EQ(counter_of(handle.get(), "line_fills"), 1u);
  EXPECT_EQ(counter_of(handle.get(), "fragments"), 2u);
  expect_ok(handle, deburr_texture_invalidate(handle.get()));
  EXPECT_EQ(first_red(handle.get()), 255);
  EXPECT_EQ(counter_of(handle.get(), "line_fills"), 2u);
  // A rejected parameter changes nothing; an accepted one applies from the next quad.
  EXPECT_EQ(deburr_set(handle.get(), "axes", "three"), DEBURR_ARGUMENT);
  EXPECT_EQ(first_red(handle.get()), 255);
  EXPECT_EQ(counter_of(handle.get(), "fragments"), 4u);
  expect_ok(handle, deburr_set(handle.get(), "axes", "two"));
  EXPECT_EQ(counter_of(handle.get(), "fragments"), 4u);
  EXPECT_EQ(first_red(handle.get()), 255);
  EXPECT_EQ(counter_of(handle.get(), "fragments"), 1u);
  EXPECT_EQ(counter_of(handle.get(), "line_fills"), 1u);
  expect_ok(handle, deburr_reset(handle.get()));
  EXPECT_EQ(counter_of(handle.get(), "fragments"), 0u);
  EXPECT_EQ(first_red(handle.get()), 255);
  EXPECT_EQ(counter_of(handle.get(), "line_fills"), 1u);
  // A descriptor may be written between quads.
  expect_ok(handle, deburr_texture_field(handle.get(), 0, "levels", "0"));
  EXPECT_EQ(first_red(handle.get()), 0);
  expect_ok(handle, deburr_texture_register(handle.get(), 0, reg::kMode, 1 << 20));
  expect_ok(handle, deburr_texture_field(handle.get(), 0, "layout", "tiled"));
  EXPECT_EQ(first_red(handle.get()), 255);
  // A smaller memory keeps its contents; addresses outside read as zero.
  expect_ok(handle, deburr_texture_memory(handle.get(), 1 << 20));
  EXPECT_EQ(first_red(handle.get()), 255);
  expect_ok(handle, deburr_texture_memory(handle.get(), 64));
  EXPECT_EQ(first_red(handle.get()), 255);
  expect_ok(handle, deburr_texture_memory(handle.get(), 0));
  EXPECT_EQ(first_red(handle.get()), 0);
  EXPECT_EQ(counter_of(handle.get(), "memory_errors"), 1u);
}

TEST(Levels, PlaceReplacesBasesUpToLastAddress) {
  const Handle handle = white_texture();
  std::uint64_t end_address = 0;
  expect_ok(handle, deburr_texture_field(handle.get(), 0, "base0", "4294967295"));
  expect_rejected(handle, "the base of a level is not a multiple of 64",
                  deburr_texture_check(handle.get(), 0), DEBURR_CONFIGURATION);
  expect_ok(handle, deburr_texture_place(handle.get(), 0, (1ull << 32) - 256, &end_address));
  EXPECT_EQ(end_address, 1ull << 32);
  expect_ok(handle, deburr_texture_check(handle.get(), 0));
  EXPECT_EQ(first_red(handle.get()), 0);  // outside the memory
  expect_ok(handle, deburr_texture_memory(handle.get(), 1024));
  expect_ok(handle, deburr_texture_place(handle.get(), 0, 512, &end_address));
  EXPECT_EQ(first_red(handle.get()), 0);
  const std::vector<std::uint8_t> bytes(256, 200);
  expect_ok(handle, deburr_texture_write(handle.get(), 512, bytes.data(), bytes.size()));
  EXPECT_EQ(first_red(handle.get()), 200);
}

TEST(State, FillsAreEmptyBeforeFirstQuad) {
  const Handle handle = white_texture();
  std::uint32_t line = 77, count = 77;
  expect_ok(handle, deburr_texture_fills(handle.get(), &line, 1, &count));
  EXPECT_EQ(count, 0u);
  EXPECT_EQ(line, 77u);
  EXPECT_EQ(first_red(handle.get()), 255);
  expect_ok(handle, deburr_texture_fills(handle.get(), nullptr, 0, &count));
  EXPECT_EQ(count, 1u);
}

TEST(BadTextureCalls, ReturnErrorWithoutSideEffects) {
  const Handle handle = white_texture();
  deburr_golden* const golden = handle.get();
  const auto rejected = [&](const std::string& words, int status, int expected = DEBURR_ARGUMENT) {
    expect_rejected(golden, words, status, expected);
  };
  std::array<std::uint8_t, 64> bytes;
  bytes.fill(0xA5);
  const auto untouched = bytes;
  std::uint64_t end_address = 77;
  std::uint32_t count = 77;
  std::int64_t value = 77;
  const std::int32_t* const s = kZero.data();
  rejected("4294967297 bytes; at most 2^32", deburr_texture_memory(golden, (1ull << 32) + 1));
  rejected("bytes is NULL", deburr_texture_write(golden, 0, nullptr, 1));
  rejected("bytes, 64 bytes from 193, is outside the memory",
           deburr_texture_write(golden, 193, bytes.data(), 64));
  rejected("is outside the memory of 256 bytes",
           deburr_texture_write(golden, ~0ull, bytes.data(), 2));
  rejected("is outside the memory", deburr_texture_read(golden, 257, bytes.data(), 0));
  rejected("is outside the memory", deburr_texture_read(golden, 200, bytes.data(), 64));
  rejected("texture 16 is outside 0..15", deburr_texture_register(golden, 16, 0, 0));
  rejected("offset 2 is not a register of a descriptor; expected 0, 4, .. 64",
           deburr_texture_register(golden, 0, 2, 0));
  rejected("offset 68 is not a register of a descriptor",
           deburr_texture_register(golden, 0, 68, 0));
  rejected("texture 16 is outside 0..15", deburr_texture_field(golden, 16, "width", "4"));
  rejected("unknown field of a texture 'depth'; known: width, height, format, ",
           deburr_texture_field(golden, 0, "depth", "4"));
  rejected("max_lod, base0 to base12", deburr_texture_field(golden, 0, "depth", "4"));
  expect_ok(golden, deburr_texture_read(golden, 256, nullptr, 0));
  for (const auto& [name, text] : {std::pair<const char*, const char*>{"width", "65536"},
                                   {"width", "-1"},
                                   {"width", "four"},
                                   {"format", "rgb8"},
                                   {"format", "0"},
                                   {"bias", "32768"},
                                   {"bias", "-32769"},
                                   {"bias", "0x-1"},
                                   {"base0", "4294967296"},
                                   {"base0", "-64"},
                                   {"base13", "0"},
                                   {"max_count_log2", "8"},
                                   {"", "0"}})
    EXPECT_EQ(deburr_texture_field(golden, 0, name, text), DEBURR_ARGUMENT) << name << text;
  EXPECT_EQ(deburr_texture_field(golden, 0, nullptr, "1"), DEBURR_ARGUMENT);
  EXPECT_EQ(deburr_texture_field(golden, 0, "width", nullptr), DEBURR_ARGUMENT);
  rejected("texture 1: width or height is zero", deburr_texture_check(golden, 1),
           DEBURR_CONFIGURATION);
  rejected("texture 16 is outside", deburr_texture_check(golden, 16));
  rejected("address 4 is not a multiple of 64", deburr_texture_place(golden, 0, 4, &end_address));
  rejected("would end past address 2^32",
           deburr_texture_place(golden, 0, 1ull << 32, &end_address));
  rejected("would end past address 2^32",
           deburr_texture_place(golden, 0, ~0ull & ~63ull, &end_address));
  rejected("texture 1: width or height is zero", deburr_texture_place(golden, 1, 0, &end_address),
           DEBURR_CONFIGURATION);
  EXPECT_EQ(deburr_texture_place(golden, 0, 0, nullptr), DEBURR_ARGUMENT);
  rejected("level 1 is outside 0..0", deburr_texture_level(golden, 0, 1, bytes.data(), 64, 0));
  rejected("stride 15 is shorter than a row of texels, 16",
           deburr_texture_level(golden, 0, 0, bytes.data(), 64, 15));
  rejected("texels is NULL", deburr_texture_level(golden, 0, 0, nullptr, 64, 0));
  rejected("texels_size is 64; 4 rows need 12884901901",
           deburr_texture_level(golden, 0, 0, bytes.data(), 64, ~0u));
  rejected("texture 1: ", deburr_texture_level(golden, 1, 0, bytes.data(), 64, 0),
           DEBURR_CONFIGURATION);
  rejected("texture 256 is outside 0..255",
           deburr_texture_quad(golden, 256, 15, 0, s, s, bytes.data()));
  rejected("coverage 16 is outside 0..15",
           deburr_texture_quad(golden, 0, 16, 0, s, s, bytes.data()));
  rejected("clamped 16 is outside 0..15",
           deburr_texture_quad(golden, 0, 15, 16, s, s, bytes.data()));
  rejected("s is NULL", deburr_texture_quad(golden, 0, 15, 0, nullptr, s, bytes.data()));
  rejected("t is NULL", deburr_texture_quad(golden, 0, 15, 0, s, nullptr, bytes.data()));
  rejected("rgba is NULL", deburr_texture_quad(golden, 0, 15, 0, s, s, nullptr));
  rejected("lane 4 is outside 0..3", deburr_texture_analyse(golden, 0, 4, s, s, "samples", &value));
  rejected("unknown decision 'sample'; known: valid, ",
           deburr_texture_analyse(golden, 0, 0, s, s, "sample", &value));
  EXPECT_EQ(deburr_texture_analyse(golden, 0, 0, s, s, nullptr, &value), DEBURR_ARGUMENT);
  EXPECT_EQ(deburr_texture_analyse(golden, 0, 0, s, s, "samples", nullptr), DEBURR_ARGUMENT);
  EXPECT_EQ(deburr_texture_fills(golden, nullptr, 1, &count), DEBURR_ARGUMENT);
  EXPECT_EQ(deburr_texture_fills(golden, &count, 1, nullptr), DEBURR_ARGUMENT);
  EXPECT_EQ(bytes, untouched);
  EXPECT_EQ(end_address, 77u);
  EXPECT_EQ(count, 77u);
  EXPECT_EQ(value, 77);
  EXPECT_EQ(first_red(golden), 255);
  EXPECT_EQ(counter_of(golden, "fragments"), 1u);
}

}  // namespace
}  // namespace deburr::texture_test
