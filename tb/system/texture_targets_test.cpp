// SPDX-License-Identifier: MIT
// A frame of the texture unit on memories that use every variant of TLM-2.0's base protocol,
// including some that accept only one way of ending a response: colours, line fills and registers
// equal the golden model's, and the unit follows the protocol.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>

#include "spec/error.h"
#include "tb/base/forked.h"
#include "tb/harness/protocol_target.h"
#include "tb/system/texture_runs.h"

namespace deburr::tb::texture_targets_test {
namespace {

using rtl::ResponseEnd;

// "CYCLES cycles, HASH", or the error. Without `end` the engine's default is used.
std::string frame(const ProtocolTargetParameters& parameters,
                  std::optional<ResponseEnd> end = std::nullopt) {
  return forked_text([&] {
    std::unique_ptr<ProtocolTarget> target;
    TextureRunOptions options;
    options.memory.latency_max = 160;
    options.patience = 3000;
    options.connect = [&](rtl::Engine& engine, platform::MemoryModel& memory) {
      target = std::make_unique<ProtocolTarget>("target", parameters);
      if (end) engine.end_responses(*end);
      engine.memory()->bind(target->socket);
      target->memory.bind(memory.ports);
    };
    const TextureScene scene(picture("tunnel", 48), {}, 1);
    Simulation simulation(options);
    TextureEnvironment environment(simulation, scene, options);
    simulation.elaborate(environment);
    try {
      simulation.run();
      environment.check();
    } catch (const spec::DeadlockError&) {
      return fmt::format("stuck after {} of {}", target->ended(), target->begun());
    }
    if (!target->violations().empty()) return "violation: " + target->violations()[0];
    if (target->begun() < 100 || target->begun() != environment.golden_work().line_fills)
      return fmt::format("{} requests", target->begun());
    if (target->ended() != target->begun() || target->referenced() != 0)
      return fmt::format("{} of {} ended, {} referenced", target->ended(), target->begun(),
                         target->referenced());
    return fmt::format("{} cycles, {:#x}", simulation.cycles(), environment.colour_hash());
  });
}

TEST(TextureTargets, EveryProtocolVariantIsAccepted) {
  for (const Answer answer : {Answer::kFourPhases, Answer::kEndRequest, Answer::kNoEndRequest,
                              Answer::kAnnotated, Answer::kBeginResponse, Answer::kComplete})
    EXPECT_THAT(frame({.answer = answer}), testing::HasSubstr(" cycles, "))
        << static_cast<int>(answer);
}

TEST(TextureTargets, SingleEndTargetRequiresMatchingEnd) {
  constexpr ResponseEnd kEnds[] = {ResponseEnd::kUpdated, ResponseEnd::kCompleted,
                                   ResponseEnd::kCall};
  const std::string all = frame({});
  EXPECT_EQ(frame({.accepts = {.completed = false, .call = false}}), all) << "DRAMSys up to 5.5.0";
  for (const ResponseEnd accepted : kEnds)
    for (const ResponseEnd end : kEnds) {
      const ProtocolTargetParameters parameters{.accepts = {accepted == ResponseEnd::kUpdated,
                                                            accepted == ResponseEnd::kCompleted,
                                                            accepted == ResponseEnd::kCall}};
      const std::string text = frame(parameters, end);
      if (end == accepted)
        EXPECT_EQ(text, all);
      else
        EXPECT_THAT(text, testing::StartsWith("stuck after 0 of"));
    }
}

}  // namespace
}  // namespace deburr::tb::texture_targets_test
