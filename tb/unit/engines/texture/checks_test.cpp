// SPDX-License-Identifier: MIT
// Failures that the checks of the texture unit report.
#include <cstdint>
#include <map>
#include <memory>

#include "spec/texture/registers.h"
#include "tb/engines/texture/texture_checks.h"
#include "tb/unit/platform/fakes.h"

namespace deburr::tb::checks_test {
namespace {

namespace reg = spec::texture::reg;

TEST(TextureChecks, EachCounterEqualsItsWork) {
  const std::map<std::uint32_t, std::uint32_t> right = {
      {reg::kFragments, 11},       {reg::kBilinears, 22}, {reg::kLineFills, 33},
      {reg::kClamped, 44},         {reg::kSaturated, 55}, {reg::kMemoryErrors, 66},
      {reg::kInvalidFragments, 77}};
  const auto expectation = std::make_shared<TextureExpectation>();
  golden::texture::TextureWork& work = expectation->work;
  work.fragments = 11;
  work.bilinears = 22;
  work.line_fills = 33;
  work.clamped = 44;
  work.saturated = 55;
  work.memory_errors = 66;
  work.invalid_fragments = 77;
  SceneParameters parameters;
  parameters.width = parameters.height = 2;
  parameters.texture_size = 4;
  const TextureScene scene = TextureScene::without_fragments(parameters, {}, 1, 2, 2);
  TextureSetup setup;
  setup.expectation = expectation;
  const SentQuads sent;
  const platform::MemoryModel memory("memory", sc_core::sc_time(10, sc_core::SC_NS));
  const auto mismatches = [&](const std::map<std::uint32_t, std::uint32_t>& values) {
    TextureChecks checks(scene, setup, sent, true);
    FakeRegisters registers;
    registers.values = values;
    checks.finish(0, memory, registers);
    return checks.registers.board().mismatches();
  };
  EXPECT_EQ(mismatches(right), 0u);
  for (const auto& [offset, value] : right) {
    std::map<std::uint32_t, std::uint32_t> wrong = right;
    ++wrong[offset];
    EXPECT_EQ(mismatches(wrong), 1u) << offset;
  }
}

// A run with too few comparisons must not pass.
TEST(TextureChecks, RequireEveryFragmentAndOneLine) {
  SceneParameters parameters;
  parameters.width = parameters.height = 2;
  parameters.texture_size = 4;
  const TextureScene scene = TextureScene::without_fragments(parameters, {}, 1, 2, 2);
  const TextureSetup setup;
  const SentQuads sent;
  const platform::MemoryModel memory("memory", sc_core::sc_time(10, sc_core::SC_NS));
  TextureChecks checks(scene, setup, sent, true);
  FakeRegisters registers;
  checks.finish(37, memory, registers);
  const auto needed = [](const ScoreboardBase& board) {
    return error_of<spec::Error>([&] { board.check(); });
  };
  EXPECT_THAT(needed(checks.colours), testing::HasSubstr("at least 37 are needed"));
  EXPECT_THAT(needed(checks.fills), testing::HasSubstr("at least 1 are needed"));
}

}  // namespace
}  // namespace deburr::tb::checks_test
