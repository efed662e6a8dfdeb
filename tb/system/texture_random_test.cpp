// SPDX-License-Identifier: MIT
// The whole texture unit on random input that no scene produces: random descriptors, some of them
// invalid, over random bytes; quads of every slope with any coverage; random configuration, cache,
// memory and stalls. Every colour, line fill and status register is compared.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include "tb/base/random.h"
#include "tb/stimuli/texture_quads.h"
#include "tb/system/texture_quad_bench.h"

namespace deburr::tb::texture_random_test {

using stimuli::any_of;

namespace {

constexpr std::uint32_t kMemoryBytes = 2u << 20;
constexpr std::uint32_t kQuads = 1500;

QuadInput random_input(Random& random) {
  QuadInput input;
  input.memory.resize(kMemoryBytes);
  for (std::uint8_t& byte : input.memory) byte = static_cast<std::uint8_t>(random.next());
  for (int handle = 0; handle < spec::texture::kMaxTextures; ++handle) {
    input.textures.push_back(stimuli::random_texture(random, kMemoryBytes));
    if (handle % 5 == 3) stimuli::spoil(random, input.textures.back());
  }
  // One texture for several quads, or another one each time; sometimes an invalid handle.
  std::uint8_t handle = 0;
  for (std::uint32_t tag = 0; tag < kQuads; ++tag) {
    if (tag / 100 % 2 || random.chance(200)) handle = static_cast<std::uint8_t>(random.below(16));
    const bool nowhere = random.chance(10);
    input.quads.push_back(stimuli::random_quad(random, tag, nowhere ? std::uint8_t{200} : handle));
  }
  return input;
}

spec::texture::Parameters random_parameters(Random& random) {
  spec::texture::Parameters p = stimuli::random_configuration(random);
  p.cache_line_bytes = any_of(random, std::array{32, 64, 128});
  p.cache_ways = any_of(random, std::array{1, 2, 4, 8});
  p.cache_bytes = any_of(random, std::array{1024, 4096, 16384});
  p.cache_replacement =
      stimuli::any_code<spec::texture::Replacement>(random, spec::texture::kReplacementNames);
  p.cache_outstanding = any_of(random, std::array{4, 17, 64});
  p.cache_fifo_depth = any_of(random, std::array{0, 2, 33, 160});
  return p;
}

platform::MemoryModelParameters random_memory(Random& random) {
  platform::MemoryModelParameters m;
  m.latency_min = 1 + random.below(60);
  m.latency_max = m.latency_min + (random.chance(500) ? 0 : random.below(200));
  m.seed = random.next();
  m.bytes_per_cycle = any_of(random, std::array{0u, 16u, 64u});
  m.banks = any_of(random, std::array{1u, 4u});
  m.bank_busy = random.below(8);
  m.outstanding = any_of(random, std::array{4u, 64u, 256u});
  return m;
}

BenchOptions random_weather(Random& random) {
  BenchOptions options;
  options.stall_permille = random.chance(500) ? 0 : random.below(300);
  options.seed = random.next();
  if (random.chance(500)) options.shuffle = random.next();
  options.fast_path = random.chance(700);
  return options;
}

class RandomQuads : public testing::TestWithParam<std::uint64_t> {};

TEST_P(RandomQuads, QuadsMatchGolden) {
  Random random(GetParam(), "random quads");
  const QuadInput input = random_input(random);
  const spec::texture::Parameters parameters = random_parameters(random);
  const platform::MemoryModelParameters memory = random_memory(random);
  QuadBench bench(input, parameters, memory, random_weather(random));
  bench.reset();
  const QuadOutcome outcome = bench.run();
  golden::texture::TextureWork work;
  EXPECT_EQ(bench.check(input, outcome, &work), "");
  // The seed exercised the intended cases.
  EXPECT_GT(work.fragments, kQuads);
  EXPECT_GT(work.invalid_fragments, 0u);
  EXPECT_GT(work.clamped, 0u);
  EXPECT_GT(work.saturated, 0u);
  EXPECT_GT(work.magnified, 0u);
  EXPECT_GT(work.samples, work.fragments);
  EXPECT_GT(work.line_fills, 0u);
}

// Also after a reset in the middle of the quads.
TEST_P(RandomQuads, WideQuadsMatchGolden) {
  Random random(GetParam(), "random wide quads");
  const QuadInput input = random_input(random);
  spec::texture::Parameters parameters = random_parameters(random);
  stimuli::random_width(random, parameters);
  const platform::MemoryModelParameters memory = random_memory(random);
  QuadBench bench(input, parameters, memory, random_weather(random));
  bench.reset();
  if (random.chance(300)) {
    bench.run_for(random.below(3000));
    bench.reset();
  }
  const QuadOutcome outcome = bench.run();
  golden::texture::TextureWork work;
  EXPECT_EQ(bench.check(input, outcome, &work), "");
  EXPECT_GT(work.invalid_fragments, 0u);
  EXPECT_GT(work.line_fills, 0u);
  const rtl::texture::GroupFormer& former = bench.unit().cache.wide->group_former;
  EXPECT_EQ(former.slots.value(),
            former.requests.value() + former.lookups.value() + former.banks.value() +
                former.set.value() + former.partial_quad.value() + former.starved.value() +
                former.allocate.value() + former.miss_queue.value() + former.wait_fill.value() +
                former.write_fill.value() + former.bank_pass.value() + former.output.value());
  EXPECT_EQ(former.slots.value() % static_cast<std::uint64_t>(parameters.width), 0u);
  EXPECT_EQ(former.requests.value(), work.bilinears + work.invalid_fragments);
}

INSTANTIATE_TEST_SUITE_P(Texture, RandomQuads, testing::Range<std::uint64_t>(1, 37));

// Injected: the golden model's input differs from the hardware's.
enum class Wrong { kNothing, kByte, kBias, kWrap, kBase, kInvalid, kCoverage };
constexpr std::array kWrongNames = {"nothing", "byte",    "bias",    "wrap",
                                    "base",    "invalid", "coverage"};
// A design built with parameters that differ from the expected ones.
struct WrongBuild {
  const char* name;
  void (*change)(spec::texture::Parameters&);
};
constexpr std::array kWrongBuilds = {
    WrongBuild{"axes", [](auto& p) { p.axes = spec::texture::Axes::kEight; }},
    WrongBuild{"measure", [](auto& p) { p.footprint = spec::texture::FootprintRule::kTwoSegment; }},
    WrongBuild{"count", [](auto& p) { p.count = spec::texture::CountRule::kCeil; }},
    WrongBuild{"kernel", [](auto& p) { p.kernel = spec::texture::Kernel::kTent; }},
    WrongBuild{"diagonals", [](auto& p) { p.kernel = spec::texture::Kernel::kAxis; }},
    WrongBuild{"output", [](auto& p) { p.srgb_output = spec::texture::SrgbOutput::kEncoded; }}};

class RandomQuadsNoticeBuild : public testing::TestWithParam<int> {};

TEST_P(RandomQuadsNoticeBuild, WrongBuildIsDetected) {
  const auto& wrong = kWrongBuilds[static_cast<std::size_t>(GetParam())];
  Random random(1, "random quads");
  const QuadInput input = random_input(random);
  spec::texture::Parameters built;
  wrong.change(built);
  QuadBench bench(input, built);
  bench.reset();
  const QuadOutcome outcome = bench.run();
  EXPECT_EQ(bench.check(input, outcome), "");
  bench.order({});
  EXPECT_NE(bench.check(input, outcome), "");
}
INSTANTIATE_TEST_SUITE_P(Texture, RandomQuadsNoticeBuild, testing::Range(0, 6), [](const auto& p) {
  return std::string(kWrongBuilds[static_cast<std::size_t>(p.param)].name);
});

// A wrong word in a table.
struct WrongWord {
  const char* table;
  std::uint64_t address;
};
class RandomQuadsNoticeTable : public testing::TestWithParam<WrongWord> {};

TEST_P(RandomQuadsNoticeTable, WrongWordIsDetected) {
  const WrongWord& wrong = GetParam();
  Random random(1, "random quads");
  const QuadInput input = random_input(random);
  spec::texture::Parameters p;
  p.srgb_output = spec::texture::SrgbOutput::kEncoded;
  p.kernel = spec::texture::Kernel::kAxis;
  QuadBench bench(input, p);
  int changed = 0;
  const auto spoil_words = [&](auto& memory) {
    if (std::string(memory.basename()) != wrong.table) return;
    memory.backdoor(wrong.address) ^= 4;
    ++changed;
  };
  rtl::for_each<rtl::Memory<std::uint8_t>>(bench.unit(), spoil_words);
  rtl::for_each<rtl::Memory<std::uint16_t>>(bench.unit(), spoil_words);
  rtl::for_each<rtl::Memory<std::uint32_t>>(bench.unit(), spoil_words);
  ASSERT_EQ(changed, 1);
  bench.reset();
  EXPECT_NE(bench.check(input, bench.run()), "");
}
INSTANTIATE_TEST_SUITE_P(Texture, RandomQuadsNoticeTable,
                         testing::Values(WrongWord{"weights", 16 * 2 + 1},
                                         WrongWord{"weights", 16 * (16 + 15) + 8},  // of a tent
                                         WrongWord{"reciprocal", 2}, WrongWord{"codes", 881},
                                         WrongWord{"srgb", 128}),
                         [](const auto& p) {
                           return p.param.table + ("_" + std::to_string(p.param.address));
                         });

// A wrong weight of the first of N samples.
class RandomQuadsNoticeWeights : public testing::TestWithParam<int> {};

TEST_P(RandomQuadsNoticeWeights, WrongWeightIsDetected) {
  const int n = GetParam();
  Random random(1, "random quads");
  const QuadInput input = random_input(random);
  spec::texture::Parameters p;
  p.kernel = spec::texture::Kernel::kTent;
  QuadBench bench(input, p);
  int changed = 0;
  rtl::for_each<rtl::Memory<std::uint16_t>>(bench.unit(), [&](auto& memory) {
    if (std::string(memory.basename()) != "weights") return;
    memory.backdoor(static_cast<std::uint64_t>(16 * (n - 1))) ^= 8;
    ++changed;
  });
  ASSERT_EQ(changed, 1);
  bench.reset();
  EXPECT_NE(bench.check(input, bench.run()), "");
}
INSTANTIATE_TEST_SUITE_P(Texture, RandomQuadsNoticeWeights, testing::Range(1, 17));

class RandomQuadsNotice : public testing::TestWithParam<int> {};

TEST_P(RandomQuadsNotice, WrongInputIsDetected) {
  const auto wrong = static_cast<Wrong>(GetParam());
  Random random(1, "random quads");
  const QuadInput input = random_input(random);
  QuadInput reference = input;
  spec::texture::Descriptor& texture = reference.textures[4];
  QuadBench bench(input, {});
  bench.reset();
  const QuadOutcome outcome = bench.run();
  switch (wrong) {
    case Wrong::kNothing:
      break;
    case Wrong::kByte: {  // a memory line
      const auto inside = [&](std::uint64_t address) { return address < kMemoryBytes; };
      const auto fill = std::find_if(outcome.fills.begin(), outcome.fills.end(), inside);
      ASSERT_NE(fill, outcome.fills.end());
      for (std::uint64_t at = *fill; at < *fill + 64; ++at) reference.memory[at] ^= 64;
      break;
    }
    case Wrong::kBias:
      for (auto& t : reference.textures) t.lod_bias = static_cast<std::int16_t>(t.lod_bias ^ 256);
      break;
    case Wrong::kWrap:
      for (auto& t : reference.textures)
        t.wrap_s = t.wrap_s == spec::texture::Wrap::kRepeat ? spec::texture::Wrap::kClampToEdge
                                                            : spec::texture::Wrap::kRepeat;
      break;
    case Wrong::kBase:
      for (std::uint32_t& base : texture.base) base ^= 64;
      break;
    case Wrong::kInvalid:
      texture.levels = 0;
      break;
    case Wrong::kCoverage:
      reference.quads[700].coverage ^= 1;
      break;
  }
  EXPECT_EQ(bench.check(reference, outcome).empty(), wrong == Wrong::kNothing);
}

INSTANTIATE_TEST_SUITE_P(Texture, RandomQuadsNotice, testing::Range(0, 7), [](const auto& p) {
  return std::string(kWrongNames[static_cast<std::size_t>(p.param)]);
});

}  // namespace
}  // namespace deburr::tb::texture_random_test
