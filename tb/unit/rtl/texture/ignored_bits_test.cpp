// SPDX-License-Identifier: MIT
// Inputs that the texture unit must ignore: register bits without a field, bases of unused levels,
// unreferenced descriptors, memory bytes that are not texels, and fields of a quad that are for the
// testbench. Colours, cycles and memory accesses must not depend on them; meaningful bits must
// change the result, or the noise would prove nothing.
#include <functional>

#include "tb/base/random.h"
#include "tb/harness/engine_state.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl::ignored_bits_test {
namespace {

namespace reg = spec::texture::reg;
using spec::texture::Format;
using spec::texture::Layout;
using Trail = std::vector<std::string>;
using Variant = std::tuple<Format, Layout>;

constexpr int kWidth = 37, kHeight = 21, kLevels = 4;  // of six
constexpr std::uint8_t kHandle = 5;

class IgnoredBits : public testing::TestWithParam<Variant> {
 protected:
  // A texture whose channels are filled in order from `channel`.
  static platform::TextureMemory texture(const std::function<std::uint8_t()>& channel) {
    std::vector<std::vector<platform::Texel>> texels;
    std::vector<platform::TextureLevel> levels;
    for (int k = 0; k < kLevels; ++k) {
      const int width = kWidth >> k, height = kHeight >> k;
      std::vector<platform::Texel>& level = texels.emplace_back();
      for (int i = 0; i < width * height; ++i)
        level.push_back({channel(), channel(), channel(), channel()});
      levels.push_back({width, height, level});
    }
    spec::texture::Descriptor sampler;
    sampler.format = std::get<0>(GetParam());
    sampler.layout = std::get<1>(GetParam());
    sampler.wrap_t = spec::texture::Wrap::kMirroredRepeat;
    sampler.max_anisotropy_log2 = 2;
    sampler.lod_bias = -40;
    platform::TextureMemory memory;
    memory.add(levels, sampler);
    return memory;
  }
  static platform::TextureMemory texture() {
    Random random(3, "texels");
    return texture([&random] { return static_cast<std::uint8_t>(random.word()); });
  }

  // Runs the unit with this memory and these descriptor registers; `change` edits the quads first.
  Trail run(
      const std::vector<std::uint8_t>& bytes,
      const std::vector<std::pair<std::uint32_t, std::uint32_t>>& written,
      const std::function<void(spec::texture::Quad&)>& change = [](auto&) {},
      const std::function<void()>& after = [] {}) {
    bench.reset(40);
    bench.memory.preload(0, bytes);
    bench.memory.clear_statistics();
    for (const auto& [offset, value] : written) bench.bus.write(offset, value);
    const Cycle start = bench.clock.cycle();
    for (std::int32_t i = 0; i < 60; ++i) {
      spec::texture::Quad q = quad_at(i * 911'111, i * 733'333, (i % 9) << 20, (i % 5) << 20,
                                      static_cast<std::uint32_t>(i));
      q.texture = kHandle;
      q.coverage = static_cast<std::uint8_t>(1 + i % 15);
      change(q);
      bench.source.add(q);
    }
    EXPECT_TRUE(bench.finish());
    after();
    Trail trail = engine_state(bench.unit, bench.bus);
    // The descriptor registers themselves were changed, so they are not compared.
    std::erase_if(
        trail, [](const std::string& line) { return line.find("TEXTURE") != std::string::npos; });
    for (const auto& taken : bench.sink.taken)
      trail.push_back(std::to_string(taken.cycle - start) + ": " +
                      rtl::payload_text(taken.token.colour[0]));
    for (const std::uint64_t line : bench.memory.lines_read())
      trail.push_back(std::to_string(line));
    return trail;
  }

  const platform::TextureMemory plain = texture();
  const std::vector<std::pair<std::uint32_t, std::uint32_t>> registers =
      platform::descriptor_registers(kHandle, plain.descriptors().front());
  UnitBench bench{spec::texture::Parameters{}, 12};
  Random random{1, "noise"};
};

TEST_P(IgnoredBits, DescriptorBitsDoNotChangeResult) {
  const Trail fresh = run(plain.bytes(), registers);
  ASSERT_GT(bench.sink.taken.size(), 100u);
  const std::uint32_t at = reg::kTextureBase + kHandle * reg::kTextureStride;
  const auto mask_of = [&](std::uint32_t offset) {
    for (const spec::RegisterInfo& info : spec::texture::kDescriptorRegisters)
      if (at + info.offset == offset) return info.mask();
    return offset < at + reg::kLevelBase + 4 * kLevels ? ~0u : 0;
  };
  std::size_t ignored = 0;
  for (int round = 0; round < 3; ++round) {
    auto noisy = registers;
    for (auto& [offset, value] : noisy) {
      const std::uint32_t mask = mask_of(offset);
      ignored += mask != ~0u;
      value = (value & mask) | ((round == 0 ? ~0u : random.word()) & ~mask);
    }
    // Unreferenced descriptors.
    for (const std::uint32_t handle : {kHandle - 1u, kHandle + 1u})
      for (std::uint32_t offset = 0; offset < reg::kLevelBase + 4 * spec::texture::kMaxLevels;
           offset += 4)
        noisy.emplace_back(reg::kTextureBase + handle * reg::kTextureStride + offset,
                           random.word());
    EXPECT_EQ(state_difference(fresh, run(plain.bytes(), noisy)), "");
  }
  EXPECT_EQ(ignored, 3u * (2 + spec::texture::kMaxLevels - kLevels));
  for (std::size_t i = 0; i < registers.size(); ++i) {
    auto changed = registers;
    const std::uint32_t mask = mask_of(changed[i].first);
    changed[i].second ^= mask;
    EXPECT_EQ(!state_difference(fresh, run(plain.bytes(), changed)).empty(), mask != 0)
        << changed[i].first;
  }
}

// Registers other than descriptors, before and after a job.
TEST_P(IgnoredBits, RegisterBitsDoNotChangeResult) {
  const Trail fresh = run(plain.bytes(), registers);
  for (const bool all : {true, false}) {
    auto noisy = registers;
    for (const spec::RegisterInfo& info : spec::texture::kRegisters) {
      const std::uint32_t noise = (all ? ~0u : random.word()) & ~info.mask();
      if (info.written() != 0)
        noisy.emplace_back(info.offset, bench.bus.read(info.offset) | noise);
      else if (info.writable() != 0)
        noisy.emplace_back(info.offset, noise);
    }
    ASSERT_EQ(noisy.size(), registers.size() + 2) << "CONTROL and STATUS";
    const auto again = [&] {
      for (std::size_t i = registers.size(); i < noisy.size(); ++i)
        bench.bus.write(noisy[i].first, noisy[i].second);
    };
    EXPECT_EQ(state_difference(fresh, run(
                                          plain.bytes(), noisy, [](auto&) {}, again)),
              "");
  }
}

TEST_P(IgnoredBits, MemoryOutsideTexelsDoesNotChangeResult) {
  const Trail fresh = run(plain.bytes(), registers);
  const std::vector<std::uint8_t> none = texture([] { return std::uint8_t{0}; }).bytes(),
                                  all = texture([] { return std::uint8_t{255}; }).bytes();
  std::vector<std::uint8_t> noisy = plain.bytes();
  std::size_t ignored = 0;
  for (std::size_t i = 0; i < noisy.size(); ++i)
    if (none[i] == all[i]) {
      noisy[i] = static_cast<std::uint8_t>(random.word());
      ++ignored;
    }
  EXPECT_GT(ignored, 200u);
  EXPECT_EQ(state_difference(fresh, run(noisy, registers)), "");
  for (std::size_t i = 0; i < noisy.size(); ++i)
    if (none[i] != all[i]) noisy[i] = static_cast<std::uint8_t>(~noisy[i]);
  EXPECT_NE(state_difference(fresh, run(noisy, registers)), "");
}

TEST_P(IgnoredBits, TestbenchFieldsOfQuadDoNotChangeResult) {
  const Trail fresh = run(plain.bytes(), registers);
  EXPECT_EQ(state_difference(fresh, run(plain.bytes(), registers,
                                        [&](spec::texture::Quad& q) {
                                          q.x = static_cast<std::uint16_t>(random.word());
                                          q.y = static_cast<std::uint16_t>(random.word());
                                          // Lanes without a fragment.
                                          q.clamped = static_cast<std::uint8_t>(~q.coverage & 15);
                                        })),
            "");
  EXPECT_NE(state_difference(fresh, run(plain.bytes(), registers,
                                        [](spec::texture::Quad& q) { q.clamped = q.coverage; })),
            "");
}

INSTANTIATE_TEST_SUITE_P(Texels, IgnoredBits,
                         testing::Values(Variant{Format::kRgba8, Layout::kTiled},
                                         Variant{Format::kRgba8, Layout::kLinear},
                                         Variant{Format::kRgb565, Layout::kTiled},
                                         Variant{Format::kRgba4444, Layout::kLinear},
                                         Variant{Format::kL8, Layout::kTiled},
                                         Variant{Format::kSrgb8A8, Layout::kTiled}));

}  // namespace
}  // namespace deburr::tb::texture_rtl::ignored_bits_test
