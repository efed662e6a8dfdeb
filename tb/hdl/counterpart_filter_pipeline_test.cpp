// SPDX-License-Identifier: MIT
// Compares the filter pipeline of hdl/texture: colours with the golden model, cycles with the
// SystemC unit, under random stalls at both ends and after resets in mid-work, for all kinds of
// weights and both outputs.
#include <VFilterAxis.h>
#include <VFilterDeburr.h>
#include <VFilterEncoded.h>
#include <VFilterEncodedPaper.h>
#include <VFilterNotEmptied.h>
#include <VFilterPaper.h>
#include <VFilterTent.h>
#include <VFilterWrongHold.h>
#include <VFilterWrongOpen.h>
#include <VFilterWrongRound.h>
#include <gtest/gtest.h>
#include <models.h>

#include <cstdint>
#include <string>
#include <vector>

#include "rtl_model/texture/filter_pipeline.h"
#include "tb/base/random.h"
#include "tb/hdl/adapter.h"
#include "tb/hdl/settings.h"
#include "tb/hdl/side_by_side.h"
#include "tb/unit/rtl/texture/filter_work.h"

namespace deburr::tb::counterpart_filter_pipeline_test {
namespace {

using spec::texture::ColourGroup;

struct Result {
  std::uint64_t requests = 0, colours = 0, broken_off = 0;
  std::uint64_t golden_differ = 0, payloads_differ = 0, cycles_differ = 0;
  bool finished = false;
  std::string first;
  bool equal() const { return finished && golden_differ + payloads_differ + cycles_differ == 0; }
};

template <class Model>
Result compare(const char* settings, std::uint32_t permille, std::uint64_t seed = 1) {
  const spec::texture::Parameters parameters = hdl::parameters_of(settings);
  FilterWork work = filter_work(parameters);
  // Includes fragments of invalid descriptors, whose colour is zero.
  for (hw::TexelQuadToken& token : work.tokens)
    if (token.ticket.tag % 16 == 9) {
      token.ticket.valid = false;
      work.colours[token.ticket.tag].rgba = {};
    }
  rtl::ClockDomain clock("clock", period());
  rtl::Link<hw::TexelQuadToken> texels_of_model("texels_of_model"),
      texels_of_counterpart("texels_of_counterpart");
  rtl::Link<ColourGroup> colours_of_model("colours_of_model", 2, hw::colours_shape(parameters)),
      colours_of_counterpart("colours_of_counterpart", 2, hw::colours_shape(parameters));
  rtl::LatencyProbe probe;
  const EndOptions before = hdl::stalled({permille, seed}),
                   after = hdl::stalled({permille, seed + 1000});
  std::vector<hw::TexelQuadToken> sent;
  Driver<hw::TexelQuadToken> source_of_model("source_of_model", clock, before),
      source_of_counterpart("source_of_counterpart", clock, before);
  for (Driver<hw::TexelQuadToken>* const source : {&source_of_model, &source_of_counterpart})
    source->send(hdl::those_of(sent));
  hw::FilterPipeline model("model", clock, parameters, probe);
  hdl::VerilatedUnit<Model, hw::TexelQuadToken, ColourGroup> counterpart("counterpart", clock, seed,
                                                                         parameters);
  Sink<ColourGroup> sink_of_model("sink_of_model", clock, after),
      sink_of_counterpart("sink_of_counterpart", clock, after);
  sink_of_model.keep(false);
  sink_of_counterpart.keep(false);
  hdl::LinkComparison<hw::TexelQuadToken> before_it("before_it", clock, texels_of_model,
                                                    texels_of_counterpart);
  hdl::LinkComparison<ColourGroup> behind_it("behind_it", clock, colours_of_model,
                                             colours_of_counterpart);
  source_of_model.beats_out(texels_of_model);
  model.texels_in(texels_of_model);
  model.colours_out(colours_of_model);
  sink_of_model.beats_in(colours_of_model);
  source_of_counterpart.beats_out(texels_of_counterpart);
  counterpart.beats_in(texels_of_counterpart);
  counterpart.beats_out(colours_of_counterpart);
  sink_of_counterpart.beats_in(colours_of_counterpart);
  source_of_model.on_send = [&](rtl::Cycle cycle, const hw::TexelQuadToken& token) {
    if (token.control.last_of_fragment) probe.enters(cycle);
  };

  Result result;
  sink_of_counterpart.on_beat = [&](rtl::Cycle, const ColourGroup& got) {
    const std::uint64_t number = sent.front().ticket.tag + sink_of_counterpart.received() - 1;
    if (number >= work.colours.size() || !(got.colour[0] == work.colours[number]))
      if (result.golden_differ++ == 0)
        result.first = "golden/counterpart colour " + std::to_string(number) + "; ";
  };
  // Aborts by reset among the multi-sample fragments, which come last.
  Random random(seed);
  for (int i = 0; i < 40; ++i) {
    auto begin = work.tokens.end() - 4000 - random.below(60'000);
    while (!begin[-1].control.last_of_fragment) --begin;
    sent.assign(begin, begin + 3000);
    clock.run(20 + random.below(1000));
    result.broken_off += sink_of_counterpart.received() != 0;
    clock.set_reset_n(false);
    clock.run(1 + random.below(3));
    clock.set_reset_n(true);
    probe.reset();
  }
  sent = work.tokens;
  const std::uint64_t wanted = work.colours.size();
  result.finished = clock.run_until(
      [&] {
        return sink_of_model.received() >= wanted && sink_of_counterpart.received() >= wanted;
      },
      20 * work.tokens.size() + 10'000);
  clock.run(100);  // no excess colours
  result.finished &= sink_of_counterpart.received() == wanted;
  result.requests = work.tokens.size();
  result.colours = wanted;
  result.cycles_differ = before_it.cycles_that_differ() + behind_it.cycles_that_differ();
  result.payloads_differ = behind_it.payloads_that_differ();
  result.first += before_it.first() + behind_it.first() + "; seed " + std::to_string(seed);
  return result;
}

template <class Model>
void expect_equal_unit(const char* settings, std::uint32_t permille = 300) {
  const Result r = compare<Model>(settings, permille);
  EXPECT_TRUE(r.finished) << r.first;
  EXPECT_EQ(r.golden_differ, 0u) << r.first;
  EXPECT_EQ(r.payloads_differ, 0u) << r.first;
  EXPECT_EQ(r.cycles_differ, 0u) << r.first;
  EXPECT_GE(r.requests, 200'000u);
  EXPECT_GE(r.broken_off, 20u);
}

TEST(CounterpartFilterPipeline, MatchesPaperPreset) {
  expect_equal_unit<VFilterPaper>(hdl::kVFilterPaper);
}
TEST(CounterpartFilterPipeline, MatchesDeburrPreset) {
  expect_equal_unit<VFilterDeburr>(hdl::kVFilterDeburr);
}
TEST(CounterpartFilterPipeline, MatchesTentKernel) {
  expect_equal_unit<VFilterTent>(hdl::kVFilterTent);
}
TEST(CounterpartFilterPipeline, MatchesKernelByAxis) {
  expect_equal_unit<VFilterAxis>(hdl::kVFilterAxis);
}
TEST(CounterpartFilterPipeline, MatchesEncodedOutput) {
  expect_equal_unit<VFilterEncoded>(hdl::kVFilterEncoded);
}
TEST(CounterpartFilterPipeline, MatchesEncodedOutputOfPaperPreset) {
  expect_equal_unit<VFilterEncodedPaper>(hdl::kVFilterEncodedPaper);
}
TEST(CounterpartFilterPipeline, MatchesWithoutStalls) {
  expect_equal_unit<VFilterDeburr>(hdl::kVFilterDeburr, 0);
}
TEST(CounterpartFilterPipeline, MatchesUnderHeavyStalls) {
  expect_equal_unit<VFilterEncoded>(hdl::kVFilterEncoded, 800);
}

// ---- injected faults in the SystemVerilog

TEST(CounterpartFilterPipelineFaults, MissingSecondLevelIsDetected) {
  EXPECT_GE(compare<VFilterWrongOpen>(hdl::kVFilterWrongOpen, 300).golden_differ, 1u);
}
TEST(CounterpartFilterPipelineFaults, TruncationIsDetected) {
  EXPECT_GE(compare<VFilterWrongRound>(hdl::kVFilterWrongRound, 300).golden_differ, 1u);
}
// A sample of the aborted work continues after the reset.
TEST(CounterpartFilterPipelineFaults, SampleKeptOverResetIsDetected) {
  EXPECT_GE(compare<VFilterNotEmptied>(hdl::kVFilterNotEmptied, 300).golden_differ, 1u);
}
// Correct colours with different timing: the pipeline does not close gaps at its end.
TEST(CounterpartFilterPipelineFaults, UnneededWaitIsDetected) {
  const Result r = compare<VFilterWrongHold>(hdl::kVFilterWrongHold, 300);
  EXPECT_EQ(r.golden_differ, 0u) << r.first;
  EXPECT_GE(r.cycles_differ, 1u);
}

}  // namespace
}  // namespace deburr::tb::counterpart_filter_pipeline_test
