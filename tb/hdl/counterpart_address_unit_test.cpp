// SPDX-License-Identifier: MIT
// Compares the address unit of hdl/texture: results with the golden model's functions, and every
// cycle with the SystemC unit, under random stalls at both ends and after resets in mid-work, for
// every option.
#include <VAddressAxis.h>
#include <VAddressCapped.h>
#include <VAddressCeil.h>
#include <VAddressDeburr.h>
#include <VAddressEight.h>
#include <VAddressEightInFour.h>
#include <VAddressEightInTwo.h>
#include <VAddressFourInTwo.h>
#include <VAddressMax.h>
#include <VAddressNotEmptied.h>
#include <VAddressPaper.h>
#include <VAddressQuarter.h>
#include <VAddressTent.h>
#include <VAddressThirdPlace.h>
#include <VAddressUnevenPitch.h>
#include <VAddressWrongEqual.h>
#include <VAddressWrongLane.h>
#include <VAddressWrongMorton.h>
#include <gtest/gtest.h>
#include <models.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "golden/texture/footprint.h"
#include "golden/texture/level_of_detail.h"
#include "golden/texture/sampling.h"
#include "rtl_model/texture/address_unit.h"
#include "tb/hdl/adapter.h"
#include "tb/hdl/settings.h"
#include "tb/hdl/side_by_side.h"
#include "tb/unit/rtl/texture/equivalence.h"

namespace deburr::tb::counterpart_address_unit_test {
namespace {

namespace gold = golden::texture;
using hdl::stalled;
using hdl::VerilatedUnit;
using spec::texture::Quad;

// Masks don't-care fields: with an invalid descriptor only the ticket is valid.
hw::TexelToken what_counts(const hw::TexelToken& token) {
  if (token.ticket.valid) return token;
  hw::TexelToken normal{};
  normal.ticket = token.ticket;
  normal.control.last_of_sample = token.control.last_of_sample;
  normal.control.last_of_fragment = token.control.last_of_fragment;
  return normal;
}

// The requests of a quad by the golden model.
void append_requests(const spec::texture::Parameters& configuration, const Descriptors& descriptors,
                     const std::array<bool, 16>& valid, const Quad& q,
                     std::vector<hw::TexelToken>& all) {
  for (std::size_t lane = 0; lane < 4; ++lane) {
    if ((q.coverage >> lane & 1) == 0) continue;
    hw::TexelToken request{};
    request.ticket = {q.tag, static_cast<std::uint8_t>(lane), q.coverage >> (lane + 1) == 0,
                      q.texture < 16 && valid[q.texture % 16],
                      static_cast<std::uint8_t>(q.texture % 16)};
    if (!request.ticket.valid) {
      request.control.last_of_sample = request.control.last_of_fragment = true;
      all.push_back(request);
      continue;
    }
    const spec::texture::Descriptor& d = descriptors[q.texture];
    const std::size_t row = lane & 2, column = lane & 1;
    const gold::Step d_x = {std::int64_t{q.s[row + 1]} - q.s[row],
                            std::int64_t{q.t[row + 1]} - q.t[row]};
    const gold::Step d_y = {std::int64_t{q.s[column + 2]} - q.s[column],
                            std::int64_t{q.t[column + 2]} - q.t[column]};
    const auto texels = [&](const gold::Step& step) {
      return gold::Step{gold::derivative_in_texels(step.s, d.width).texels,
                        gold::derivative_in_texels(step.t, d.height).texels};
    };
    const gold::Footprint footprint =
        gold::footprint(configuration.axes, configuration.footprint, texels(d_x), texels(d_y));
    const gold::AxisLogarithms logs =
        gold::axis_logarithms(configuration.axes, configuration.log2, footprint);
    const gold::LevelOfDetail lod = gold::select_level(configuration, d, logs.d_max, logs.d_min);
    const gold::Step axis =
        gold::candidate_in_coordinates(configuration.axes, footprint.major, d_x, d_y);
    const spec::texture::Kernel kernel =
        gold::fragment_kernel(configuration, footprint.major, lod.samples);
    const std::int32_t spread = gold::spread_of(kernel, lod.samples, configuration.spread);
    const bool tent = kernel == spec::texture::Kernel::kAxis;
    const auto place = lod.linear ? gold::linear_position : gold::nearest_position;
    for (int i = 0; i < lod.samples; ++i)
      for (int of_two = 0; of_two < lod.requests_per_sample(); ++of_two) {
        const int level = lod.level + of_two;
        const std::int64_t s = q.s[lane] + gold::sample_offset(i, lod.samples, spread, axis.s),
                           t = q.t[lane] + gold::sample_offset(i, lod.samples, spread, axis.t);
        const gold::TexelPosition x = place(d.wrap_s, s, gold::level_size(d.width, level)),
                                  y = place(d.wrap_t, t, gold::level_size(d.height, level));
        const auto address = [&](std::int32_t u, std::int32_t v) {
          return gold::texel_address(d, level, u, v);
        };
        request.address = {address(x.i0, y.i0), address(x.i1, y.i0), address(x.i0, y.i1),
                           address(x.i1, y.i1)};
        const bool turned = d.layout == spec::texture::Layout::kLinear;
        request.turned = {turned && y.i0 % 2 != 0, turned && y.i1 % 2 != 0};
        request.control = {
            static_cast<std::uint8_t>(x.fraction),
            static_cast<std::uint8_t>(y.fraction),
            static_cast<std::uint16_t>(of_two == 1 ? lod.fraction : 256 - lod.fraction),
            static_cast<std::uint8_t>(i),
            static_cast<std::uint8_t>(lod.samples - 1 + (tent ? hw::kTent : 0)),
            static_cast<std::uint8_t>(d.format),
            of_two + 1 == lod.requests_per_sample(),
            of_two + 1 == lod.requests_per_sample() && i + 1 == lod.samples};
        all.push_back(request);
      }
  }
}

struct Result {
  std::uint64_t quads = 0, requests = 0, broken_off = 0;
  std::uint64_t golden_differ = 0;  // requests that differ from the golden model's
  std::uint64_t payloads_differ = 0, cycles_differ = 0;  // differences from the SystemC unit
  bool finished = true;
  std::string first;
};

// Batches of quads with new descriptors each, some of them invalid. `permille` of the cycles are
// stalls, at both ends. Each batch is aborted by a reset once, then repeated.
template <class Model>
Result compare(const char* settings, std::uint64_t least_requests, std::uint32_t permille,
               std::uint64_t seed = 1) {
  const spec::texture::Parameters parameters = hdl::parameters_of(settings);
  rtl::ClockDomain clock("clock", period());
  rtl::Link<Quad> quads_of_model("quads_of_model"), quads_of_counterpart("quads_of_counterpart");
  rtl::Link<hw::TexelToken> texels_of_model("texels_of_model"),
      texels_of_counterpart("texels_of_counterpart");
  Store store(clock);
  rtl::LatencyProbe probe;
  std::vector<Quad> quads;
  const EndOptions before = stalled({permille, seed}), after = stalled({permille, seed + 1000});
  Driver<Quad> source_of_model("source_of_model", clock, before),
      source_of_counterpart("source_of_counterpart", clock, before);
  for (Driver<Quad>* const source : {&source_of_model, &source_of_counterpart})
    source->send(hdl::those_of(quads));
  hw::AddressUnit model("model", clock, parameters, store.control, store.descriptors, probe);
  VerilatedUnit<Model, Quad, hw::TexelToken> counterpart("counterpart", clock, seed, parameters);
  Sink<hw::TexelToken> sink_of_model("sink_of_model", clock, after),
      sink_of_counterpart("sink_of_counterpart", clock, after);
  sink_of_model.keep(false);
  sink_of_counterpart.keep(false);
  hdl::LinkComparison<Quad> before_it("before_it", clock, quads_of_model, quads_of_counterpart);
  hdl::LinkComparison<hw::TexelToken> behind_it("behind_it", clock, texels_of_model,
                                                texels_of_counterpart, what_counts);
  std::vector<const rtl::LinkBase*> links;
  for (const char* name : {"derivatives", "footprints", "logs", "levels", "samples"})
    rtl::for_each<rtl::LinkBase>(model, [&](rtl::LinkBase& link) {
      if (std::string(name) == link.basename()) links.push_back(&link);
    });
  EXPECT_EQ(links.size(), 5u);
  hdl::InnerLinks inside("inside", clock, links);
  counterpart.on_clock = [&](Model& says) {
    inside.counterpart_does(says.link_push, says.link_pop);
  };
  source_of_model.beats_out(quads_of_model);
  model.quads_in(quads_of_model);
  model.texels_out(texels_of_model);
  sink_of_model.beats_in(texels_of_model);
  source_of_counterpart.beats_out(quads_of_counterpart);
  counterpart.beats_in(quads_of_counterpart);
  counterpart.beats_out(texels_of_counterpart);
  sink_of_counterpart.beats_in(texels_of_counterpart);

  Result result;
  std::vector<hw::TexelToken> wanted;
  const rtl::Payload payload = rtl::Payload::of<hw::TexelToken>();
  sink_of_model.on_beat = [&](rtl::Cycle, const hw::TexelToken& got) {
    if (got.control.last_of_fragment) probe.leaves(clock.cycle());
  };
  sink_of_counterpart.on_beat = [&](rtl::Cycle, const hw::TexelToken& got) {
    const std::uint64_t number = sink_of_counterpart.received() - 1;
    if (number >= wanted.size()) {
      ++result.golden_differ;
      return;
    }
    const hw::TexelToken normal = what_counts(got);
    const std::string difference =
        payload.difference(reinterpret_cast<const std::byte*>(&wanted[number]),
                           reinterpret_cast<const std::byte*>(&normal));
    if (!difference.empty() && result.golden_differ++ == 0)
      result.first +=
          "golden/counterpart request " + std::to_string(number) + ": " + difference + "; ";
  };

  Random random(seed);
  while (result.requests < least_requests) {
    Descriptors descriptors;
    std::array<bool, 16> valid;
    for (std::size_t h = 0; h < 16; ++h) {
      descriptors[h] = stimuli::random_texture(random, kMemoryBytes);
      valid[h] = h % 4 != 3;
      if (!valid[h]) stimuli::spoil(random, descriptors[h]);
    }
    quads.clear();
    wanted.clear();
    for (std::uint32_t tag = 0; tag < 4000; ++tag) {
      const auto texture =
          static_cast<std::uint8_t>(random.chance(20) ? 16 + random.below(240) : random.below(16));
      quads.push_back(stimuli::random_quad(random, tag, texture));
      append_requests(parameters, descriptors, valid, quads.back(), wanted);
    }
    for (const rtl::Cycle work : {10 + random.below(3000), 0u}) {
      clock.set_reset_n(false);
      clock.run(1 + random.below(3));
      clock.set_reset_n(true);
      probe.reset();
      write(store, descriptors);
      for (std::uint32_t h = 0; h < 16; ++h)
        for (const auto& [offset, value] :
             platform::descriptor_registers(static_cast<int>(h), descriptors[h]))
          hdl::write_word(
              counterpart, h,
              (offset - spec::texture::reg::kTextureBase) % spec::texture::reg::kTextureStride / 4,
              value);
      clock.run(work);
      result.broken_off += sink_of_counterpart.received() != 0 && work != 0;
    }
    const bool finished = clock.run_until(
        [&] {
          return sink_of_model.received() >= wanted.size() &&
                 sink_of_counterpart.received() >= wanted.size();
        },
        20 * wanted.size() + 10'000);
    clock.run(100);  // no excess requests
    result.quads += quads.size();
    result.requests += wanted.size();
    result.finished &= finished && sink_of_counterpart.received() == wanted.size();
    if (!result.finished || behind_it.cycles_that_differ() + inside.cycles_that_differ() != 0)
      break;
  }
  result.cycles_differ =
      before_it.cycles_that_differ() + behind_it.cycles_that_differ() + inside.cycles_that_differ();
  result.payloads_differ = behind_it.payloads_that_differ();
  result.first +=
      before_it.first() + inside.first() + behind_it.first() + "; seed " + std::to_string(seed);
  return result;
}

template <class Model>
void expect_equal_unit(const char* settings) {
  constexpr std::uint64_t requests = 1'000'000;
  const Result r = compare<Model>(settings, requests, 300);
  EXPECT_TRUE(r.finished) << r.first;
  EXPECT_EQ(r.golden_differ, 0u) << r.first;
  EXPECT_EQ(r.payloads_differ, 0u) << r.first;
  EXPECT_EQ(r.cycles_differ, 0u) << r.first;
  EXPECT_GE(r.requests, requests);
  EXPECT_GE(r.broken_off, 10u);
}

TEST(CounterpartAddressUnit, MatchesPaperPreset) {
  expect_equal_unit<VAddressPaper>(hdl::kVAddressPaper);
}
TEST(CounterpartAddressUnit, MatchesDeburrPreset) {
  expect_equal_unit<VAddressDeburr>(hdl::kVAddressDeburr);
}
TEST(CounterpartAddressUnit, MatchesCeilCount) {
  expect_equal_unit<VAddressCeil>(hdl::kVAddressCeil);
}
TEST(CounterpartAddressUnit, MatchesQuarterFootprint) {
  expect_equal_unit<VAddressQuarter>(hdl::kVAddressQuarter);
}
TEST(CounterpartAddressUnit, MatchesCappedCount) {
  expect_equal_unit<VAddressCapped>(hdl::kVAddressCapped);
}
TEST(CounterpartAddressUnit, MatchesMaxFootprint) {
  expect_equal_unit<VAddressMax>(hdl::kVAddressMax);
}
TEST(CounterpartAddressUnit, MatchesTentKernel) {
  expect_equal_unit<VAddressTent>(hdl::kVAddressTent);
}
// Samples as far away as 35 bits reach.
TEST(CounterpartAddressUnit, MatchesKernelByAxis) {
  expect_equal_unit<VAddressAxis>(hdl::kVAddressAxis);
}
TEST(CounterpartAddressUnit, MatchesFourAxesInTwoCycles) {
  expect_equal_unit<VAddressFourInTwo>(hdl::kVAddressFourInTwo);
}
TEST(CounterpartAddressUnit, MatchesEightAxes) {
  expect_equal_unit<VAddressEight>(hdl::kVAddressEight);
}
TEST(CounterpartAddressUnit, MatchesEightAxesInTwoCycles) {
  expect_equal_unit<VAddressEightInTwo>(hdl::kVAddressEightInTwo);
}
TEST(CounterpartAddressUnit, MatchesEightAxesInFourCycles) {
  expect_equal_unit<VAddressEightInFour>(hdl::kVAddressEightInFour);
}

// Without stalls, and with a sink that is stalled most of the time.
TEST(CounterpartAddressUnit, MatchesWithoutStalls) {
  const Result r = compare<VAddressDeburr>(hdl::kVAddressDeburr, 100'000, 0, 5);
  EXPECT_TRUE(r.finished && r.golden_differ + r.payloads_differ + r.cycles_differ == 0) << r.first;
}
TEST(CounterpartAddressUnit, MatchesUnderHeavyStalls) {
  const Result r = compare<VAddressDeburr>(hdl::kVAddressDeburr, 50'000, 800, 6);
  EXPECT_TRUE(r.finished && r.golden_differ + r.payloads_differ + r.cycles_differ == 0) << r.first;
}

// ---- injected faults in the SystemVerilog

TEST(CounterpartAddressUnitFaults, WrongNeighbourLaneIsDetected) {
  EXPECT_GE(compare<VAddressWrongLane>(hdl::kVAddressWrongLane, 20'000, 300).golden_differ, 1u);
}
TEST(CounterpartAddressUnitFaults, LaterOfEqualCandidatesIsDetected) {
  EXPECT_GE(compare<VAddressWrongEqual>(hdl::kVAddressWrongEqual, 20'000, 300).golden_differ, 1u);
}
TEST(CounterpartAddressUnitFaults, SwappedMortonIndexIsDetected) {
  EXPECT_GE(compare<VAddressWrongMorton>(hdl::kVAddressWrongMorton, 20'000, 300).golden_differ, 1u);
}
TEST(CounterpartAddressUnitFaults, UnroundedPitchIsDetected) {
  EXPECT_GE(compare<VAddressUnevenPitch>(hdl::kVAddressUnevenPitch, 20'000, 300).golden_differ, 1u);
}
// A request of the aborted work is issued after the reset.
TEST(CounterpartAddressUnitFaults, FragmentKeptOverResetIsDetected) {
  const Result r = compare<VAddressNotEmptied>(hdl::kVAddressNotEmptied, 20'000, 300);
  EXPECT_GE(r.golden_differ, 1u);
  EXPECT_GE(r.cycles_differ, 1u);
}
// Correct requests; timing differs only if the downstream units stall.
TEST(CounterpartAddressUnitFaults, ThirdLinkEntryIsDetected) {
  const Result stalled = compare<VAddressThirdPlace>(hdl::kVAddressThirdPlace, 20'000, 300);
  EXPECT_EQ(stalled.golden_differ, 0u) << stalled.first;
  EXPECT_GE(stalled.cycles_differ, 1u);
}

}  // namespace
}  // namespace deburr::tb::counterpart_address_unit_test
