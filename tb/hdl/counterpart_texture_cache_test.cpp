// SPDX-License-Identifier: MIT
// Compares the texture cache of hdl/texture: texels with the memory's contents, and every cycle
// with the SystemC cache, at its ports, at memory and inside, under random stalls, latencies and
// memory limits, in several geometries and with each replacement policy.
#include <VCacheDefault.h>
#include <VCacheDirect.h>
#include <VCacheEveryUse.h>
#include <VCacheFreedLater.h>
#include <VCacheLarge.h>
#include <VCacheLateFill.h>
#include <VCacheNotAhead.h>
#include <VCacheNotTurned.h>
#include <VCacheOldSet.h>
#include <VCacheRandom.h>
#include <VCacheSmall.h>
#include <VCacheWhileHeld.h>
#include <VCacheWrongTap.h>
#include <gtest/gtest.h>
#include <models.h>

#include <array>
#include <cstdint>
#include <iostream>
#include <string>
#include <vector>

#include "rtl_model/fabric/memory_port.h"
#include "rtl_model/platform/memory_model.h"
#include "rtl_model/texture/texture_cache.h"
#include "tb/hdl/settings.h"
#include "tb/hdl/side_by_side.h"
#include "tb/hdl/verilated_cache.h"
#include "tb/unit/rtl/texture/equivalence.h"

namespace deburr::tb::counterpart_texture_cache_test {
namespace {

using hdl::stalled;
using hw::TexelQuadToken;
using hw::TexelToken;
using spec::texture::Format;

constexpr std::uint32_t kBytes = 1 << 18;    // of memory; a line beyond the end is an error
constexpr std::uint32_t kBroken = 0x2'0000;  // lines from here to kBrokenEnd are errors as well
constexpr std::uint32_t kBrokenEnd = 0x2'1000;

// Bytes of a texel.
std::uint32_t bytes_of(const hw::FilterControl& control) {
  const auto format = static_cast<Format>(control.format);
  if (format == Format::kL8) return 1;
  return format == Format::kRgb565 || format == Format::kRgba4444 ? 2 : 4;
}
std::uint8_t byte_at(std::uint32_t address) {
  return static_cast<std::uint8_t>(((address & ~3U) * 2654435761U + 12345) >> (8 * (address & 3)));
}
// Masks don't-care bits: those above a texel's own bytes, and all texels of an invalid fragment.
TexelQuadToken what_counts(const TexelQuadToken& token) {
  TexelQuadToken normal = token;
  if (!token.ticket.valid) {
    normal = {};
    normal.ticket = token.ticket;
    normal.control.last_of_sample = token.control.last_of_sample;
    normal.control.last_of_fragment = token.control.last_of_fragment;
    return normal;
  }
  for (std::uint32_t& texel : normal.texel) texel &= ~0U >> (32 - 8 * bytes_of(token.control));
  return normal;
}
TexelQuadToken wanted_of(const TexelToken& request) {
  TexelQuadToken token{};
  token.ticket = request.ticket;
  token.control = request.control;
  for (std::size_t k = 0; k < 4; ++k)
    for (std::uint32_t b = 0; b < bytes_of(request.control); ++b) {
      const std::uint32_t at = request.address[k] + b;
      const bool error = at >= kBytes || (at >= kBroken && at < kBrokenEnd);
      token.texel[k] |= error ? 0U : std::uint32_t{byte_at(at)} << (8 * b);
    }
  return what_counts(token);
}

// Requests with many hits, many misses and many bank conflicts: footprints of every kind within a
// moving range of memory.
class Requests {
 public:
  Requests(Random& random, std::uint32_t line_bytes, std::uint32_t cache_bytes)
      : random_(random), line_(line_bytes), cache_(cache_bytes) {}
  TexelToken next(std::uint32_t tag) {
    if (random_.chance(4)) {
      base_ = random_.below(kBytes + 4 * line_) & ~(line_ - 1);
      window_ = line_ << random_.below(6);
      kind_ = random_.below(5);
      if (random_.chance(150)) base_ = kBroken - line_;
    }
    TexelToken request{};
    request.ticket = {tag, static_cast<std::uint8_t>(random_.below(4)), random_.chance(250),
                      !random_.chance(30), static_cast<std::uint8_t>(random_.below(16))};
    request.control = {static_cast<std::uint8_t>(random_.below(256)),
                       static_cast<std::uint8_t>(random_.below(256)),
                       static_cast<std::uint16_t>(random_.below(257)),
                       static_cast<std::uint8_t>(random_.below(16)),
                       static_cast<std::uint8_t>(random_.below(16)),
                       static_cast<std::uint8_t>(random_.below(5)),
                       random_.chance(500),
                       random_.chance(500)};
    const std::uint32_t bytes = bytes_of(request.control);
    const std::uint32_t at = base_ + (random_.below(window_) & ~(bytes - 1));
    const std::uint32_t pitch = random_.chance(500) ? 64 : 64 << random_.below(5);
    const auto anywhere = [&] { return base_ + (random_.below(window_) & ~(bytes - 1)); };
    switch (kind_) {
      case 0:  // neighbours of a linear texture
        request.address = {at, at + bytes, at + pitch, at + pitch + bytes};
        request.turned = {(at / pitch) % 2 != 0, (at / pitch) % 2 == 0};
        break;
      case 1:  // neighbours of a tiled texture
        request.address = {at, at + bytes, at + 16, at + 16 + bytes};
        break;
      case 2:  // one set, several lines: one word per bank
        for (std::uint32_t k = 0; k < 4; ++k) request.address[k] = at + random_.below(6) * cache_;
        request.turned = {random_.chance(300), random_.chance(300)};
        break;
      case 3:  // four texels anywhere in the range
        for (std::uint32_t& address : request.address) address = anywhere();
        request.turned = {random_.chance(100), random_.chance(100)};
        break;
      default:  // a single texel
        request.address = {at, at, at, at};
        request.turned = {random_.chance(100), false};
        request.turned[1] = request.turned[0];
    }
    for (std::uint32_t& address : request.address) address &= ~(bytes - 1);
    return request;
  }

 private:
  Random& random_;
  std::uint32_t line_, cache_;
  std::uint32_t base_ = 0, window_ = 1024, kind_ = 0;
};

// Timing of the memory's responses.
struct Answers {
  std::uint32_t latency = 20, scatter = 0, outstanding = 1024, bytes_per_cycle = 0;
};
struct Result {
  std::uint64_t requests = 0, lines = 0, cycles = 0;
  std::uint64_t memory_differs = 0;  // texels that differ from the memory's contents
  std::uint64_t payloads_differ = 0, cycles_differ = 0;  // differences from the SystemC cache
  bool finished = true;
  std::string first;
};

template <class Model>
Result compare(const char* settings, std::uint64_t least_requests, std::uint32_t permille,
               const Answers& answers = {}, std::uint64_t seed = 1) {
  spec::texture::Parameters parameters = hdl::parameters_of(settings);
  parameters.cache_fifo_depth = hw::LatencyFifo::depth(parameters, {});
  rtl::ClockDomain clock("clock", period());
  Store store(clock);
  rtl::Link<TexelToken> texels_of_model("texels_of_model"),
      texels_of_counterpart("texels_of_counterpart");
  rtl::Link<TexelQuadToken> quads_of_model("quads_of_model"),
      quads_of_counterpart("quads_of_counterpart");
  rtl::Link<rtl::MemoryRequest> requests_of_counterpart("requests_of_counterpart", 2,
                                                        hdl::memory_request_shape(parameters));
  rtl::Link<rtl::MemoryResponse> responses_of_counterpart("responses_of_counterpart", 2,
                                                          hdl::memory_response_shape(parameters));
  std::vector<TexelToken> requests;
  const EndOptions before = stalled({permille, seed}), after = stalled({permille, seed + 1000});
  Driver<TexelToken> source_of_model("source_of_model", clock, before),
      source_of_counterpart("source_of_counterpart", clock, before);
  for (Driver<TexelToken>* const source : {&source_of_model, &source_of_counterpart})
    source->send(hdl::those_of(requests));
  hw::TextureCache model("model", clock, parameters, store.control);
  hdl::VerilatedCache<Model> counterpart("counterpart", clock, seed, parameters);
  rtl::MemoryPort port_of_counterpart("port_of_counterpart", clock,
                                      hdl::memory_port_of(parameters));
  Sink<TexelQuadToken> sink_of_model("sink_of_model", clock, after),
      sink_of_counterpart("sink_of_counterpart", clock, after);
  sink_of_model.keep(false);
  sink_of_counterpart.keep(false);
  platform::MemoryModelParameters memory;
  memory.bytes = kBytes;
  memory.latency_min = answers.latency;
  memory.latency_max = answers.latency + answers.scatter;
  memory.outstanding = answers.outstanding;
  memory.bytes_per_cycle = answers.bytes_per_cycle;
  memory.seed = seed;
  platform::MemoryModel memory_of_model("memory_of_model", period(), memory),
      memory_of_counterpart("memory_of_counterpart", period(), memory);
  std::vector<std::uint8_t> image(kBytes);
  for (std::uint32_t i = 0; i < kBytes; ++i) image[i] = byte_at(i);
  for (platform::MemoryModel* each : {&memory_of_model, &memory_of_counterpart}) {
    each->preload(0, image);
    each->fail_range(kBroken, kBrokenEnd);
  }
  model.memory_port.memory.bind(memory_of_model.ports);
  port_of_counterpart.memory.bind(memory_of_counterpart.ports);

  source_of_model.beats_out(texels_of_model);
  model.texels_in(texels_of_model);
  model.texels_out(quads_of_model);
  sink_of_model.beats_in(quads_of_model);
  source_of_counterpart.beats_out(texels_of_counterpart);
  counterpart.texels_in(texels_of_counterpart);
  counterpart.texels_out(quads_of_counterpart);
  sink_of_counterpart.beats_in(quads_of_counterpart);
  counterpart.requests_out(requests_of_counterpart);
  port_of_counterpart.requests_in(requests_of_counterpart);
  port_of_counterpart.responses_out(responses_of_counterpart);
  counterpart.responses_in(responses_of_counterpart);

  std::vector<const rtl::LinkBase*> links;
  const rtl::Link<rtl::MemoryRequest>* requests_of_model = nullptr;
  const rtl::Link<rtl::MemoryResponse>* responses_of_model = nullptr;
  for (const char* name : {"misses", "requests", "entries_entries"})
    rtl::for_each<rtl::LinkBase>(model, [&](rtl::LinkBase& link) {
      if (std::string(name) == link.basename()) links.push_back(&link);
    });
  rtl::for_each<rtl::LinkBase>(model, [&](rtl::LinkBase& link) {
    if (auto* const found = dynamic_cast<rtl::Link<rtl::MemoryRequest>*>(&link))
      requests_of_model = found;
    if (auto* const found = dynamic_cast<rtl::Link<rtl::MemoryResponse>*>(&link))
      responses_of_model = found;
  });
  Result result;
  if (links.size() != 3 || !requests_of_model || !responses_of_model) {
    ADD_FAILURE() << "the links of the cache are not found";
    return result;
  }
  hdl::InnerLinks inside("inside", clock, links);
  counterpart.on_clock = [&](Model& says) {
    inside.counterpart_does(says.link_push, says.link_pop);
  };
  hdl::LinkComparison<TexelToken> before_it("before_it", clock, texels_of_model,
                                            texels_of_counterpart);
  hdl::LinkComparison<TexelQuadToken> behind_it("behind_it", clock, quads_of_model,
                                                quads_of_counterpart, what_counts);
  hdl::LinkComparison<rtl::MemoryRequest> asked("asked", clock, *requests_of_model,
                                                requests_of_counterpart);
  hdl::LinkComparison<rtl::MemoryResponse> answered("answered", clock, *responses_of_model,
                                                    responses_of_counterpart);
  const auto differing_cycles = [&] {
    return before_it.cycles_that_differ() + behind_it.cycles_that_differ() +
           asked.cycles_that_differ() + answered.cycles_that_differ() + inside.cycles_that_differ();
  };
  const rtl::Payload payload = rtl::Payload::of<TexelQuadToken>();
  sink_of_counterpart.on_beat = [&](rtl::Cycle, const TexelQuadToken& got) {
    const std::uint64_t number = sink_of_counterpart.received() - 1;
    if (number >= requests.size()) {
      ++result.memory_differs;
      return;
    }
    const TexelQuadToken wanted = wanted_of(requests[number]), normal = what_counts(got);
    const std::string difference = payload.difference(reinterpret_cast<const std::byte*>(&wanted),
                                                      reinterpret_cast<const std::byte*>(&normal));
    if (!difference.empty() && result.memory_differs++ == 0)
      result.first +=
          "memory/counterpart request " + std::to_string(number) + ": " + difference + "; ";
  };

  Random random(seed);
  Requests stream(random, static_cast<std::uint32_t>(parameters.cache_line_bytes),
                  static_cast<std::uint32_t>(parameters.cache_bytes));
  std::uint32_t tag = 0;
  std::uint64_t lines = 0;
  for (int batch = 0; result.requests < least_requests; ++batch) {
    const std::uint64_t of_batch = 5000;
    requests.clear();
    for (std::uint64_t i = 0; i < of_batch; ++i) requests.push_back(stream.next(tag++));
    // Every second batch starts after a reset in mid-work with lines in flight, the others after an
    // invalidation.
    if (batch % 2 == 0) {
      for (const rtl::Cycle work : {0, 300}) {
        clock.run(work);
        clock.set_reset_n(false);
        clock.run(2);
        clock.set_reset_n(true);
      }
    } else {
      model.tag_stage.invalidate();
      counterpart.invalidate();
      source_of_model.reset();
      source_of_counterpart.reset();
      sink_of_model.reset();
      sink_of_counterpart.reset();
    }
    const bool finished = clock.run_until(
        [&] {
          return (sink_of_model.received() >= of_batch &&
                  sink_of_counterpart.received() >= of_batch) ||
                 differing_cycles() != 0;
        },
        400 * of_batch);
    clock.run(100);  // no excess texels
    result.finished &= finished && sink_of_counterpart.received() == of_batch;
    result.requests += of_batch;
    lines += requests_of_counterpart.pushes();
    if (!result.finished || differing_cycles() != 0) break;
  }
  result.lines = lines;
  result.cycles = clock.cycle();
  result.cycles_differ = differing_cycles();
  result.payloads_differ = behind_it.payloads_that_differ() + asked.payloads_that_differ() +
                           answered.payloads_that_differ();
  result.first += before_it.first() + " | " + inside.first() + " | " + asked.first() + " | " +
                  answered.first() + " | " + behind_it.first() + " | seed " + std::to_string(seed);
  return result;
}

template <class Model>
void expect_equal_unit(const char* settings, std::uint64_t requests, std::uint32_t permille = 300,
                       const Answers& answers = {.latency = 20, .scatter = 30},
                       std::uint64_t seed = 1) {
  const Result r = compare<Model>(settings, requests, permille, answers, seed);
  EXPECT_TRUE(r.finished) << r.first;
  EXPECT_EQ(r.memory_differs, 0u) << r.first;
  EXPECT_EQ(r.payloads_differ, 0u) << r.first;
  EXPECT_EQ(r.cycles_differ, 0u) << r.first;
  EXPECT_GE(r.requests, requests);
  EXPECT_GE(r.lines, requests / 50);
  std::cout << r.requests << " requests, " << r.lines << " lines, " << r.cycles << " cycles\n";
}

// The cache of both presets.
TEST(CounterpartTextureCache, MatchesDefault) {
  expect_equal_unit<VCacheDefault>(hdl::kVCacheDefault, 1'000'000);
}
TEST(CounterpartTextureCache, MatchesWithoutStalls) {
  expect_equal_unit<VCacheDefault>(hdl::kVCacheDefault, 100'000, 0, {.latency = 20});
}
TEST(CounterpartTextureCache, MatchesUnderHeavyStalls) {
  expect_equal_unit<VCacheDefault>(hdl::kVCacheDefault, 50'000, 800);
}
// Memory that accepts three requests at a time, and one that delivers a line in four cycles.
TEST(CounterpartTextureCache, MatchesWithThreeOutstandingRequests) {
  expect_equal_unit<VCacheDefault>(hdl::kVCacheDefault, 50'000, 300,
                                   {.latency = 20, .scatter = 60, .outstanding = 3});
}
TEST(CounterpartTextureCache, MatchesWithFourCyclesPerLine) {
  expect_equal_unit<VCacheDefault>(hdl::kVCacheDefault, 50'000, 300,
                                   {.latency = 20, .bytes_per_cycle = 16});
}
// Distant memory: the LatencyFifo and the line entries become full.
TEST(CounterpartTextureCache, MatchesWithDistantMemory) {
  expect_equal_unit<VCacheDefault>(hdl::kVCacheDefault, 50'000, 100,
                                   {.latency = 300, .scatter = 100});
}
TEST(CounterpartTextureCache, MatchesSmallCache) {
  expect_equal_unit<VCacheSmall>(hdl::kVCacheSmall, 100'000);
}
TEST(CounterpartTextureCache, MatchesSmallCacheWithoutStalls) {
  expect_equal_unit<VCacheSmall>(hdl::kVCacheSmall, 100'000, 0, {.latency = 1});
}
TEST(CounterpartTextureCache, MatchesDirectMapped) {
  expect_equal_unit<VCacheDirect>(hdl::kVCacheDirect, 100'000);
}
TEST(CounterpartTextureCache, MatchesDirectMappedWithoutStalls) {
  expect_equal_unit<VCacheDirect>(hdl::kVCacheDirect, 100'000, 0, {.latency = 1});
}
TEST(CounterpartTextureCache, MatchesRandomReplacement) {
  expect_equal_unit<VCacheRandom>(hdl::kVCacheRandom, 200'000);
}
TEST(CounterpartTextureCache, MatchesLargeCache) {
  expect_equal_unit<VCacheLarge>(hdl::kVCacheLarge, 200'000);
}

// ---- injected faults in the SystemVerilog

// Two stages that do not stall together: a line's entry is freed too early.
TEST(CounterpartTextureCacheFaults, FillDuringStallIsDetected) {
  EXPECT_GE(compare<VCacheWhileHeld>(hdl::kVCacheWhileHeld, 20'000, 300).cycles_differ, 1u);
}
// Only the timing differs: every texel is right.
template <class Model>
void expect_other_cycles(const char* settings, std::uint32_t permille = 300) {
  const Result r = compare<Model>(settings, 20'000, permille, {.latency = 20, .scatter = 30});
  EXPECT_EQ(r.memory_differs, 0u) << r.first;
  EXPECT_GE(r.cycles_differ, 1u);
}
TEST(CounterpartTextureCacheFaults, LateFillIsDetected) {
  expect_other_cycles<VCacheLateFill>(hdl::kVCacheLateFill);
}
TEST(CounterpartTextureCacheFaults, LateMissQueueReleaseIsDetected) {
  expect_other_cycles<VCacheFreedLater>(hdl::kVCacheFreedLater);
}
TEST(CounterpartTextureCacheFaults, MissingReadAheadIsDetected) {
  expect_other_cycles<VCacheNotAhead>(hdl::kVCacheNotAhead);
}
// Other lines are replaced.
template <class Model>
void expect_other_lines(const char* settings) {
  const Result r = compare<Model>(settings, 20'000, 300, {.latency = 20, .scatter = 30});
  EXPECT_GE(r.cycles_differ + r.payloads_differ, 1u);
}
TEST(CounterpartTextureCacheFaults, HitCountedAsUseInFifoIsDetected) {
  expect_other_lines<VCacheEveryUse>(hdl::kVCacheEveryUse);
}
TEST(CounterpartTextureCacheFaults, WrongShiftRegisterTapIsDetected) {
  expect_other_lines<VCacheWrongTap>(hdl::kVCacheWrongTap);
}
TEST(CounterpartTextureCacheFaults, StaleSetReadIsDetected) {
  expect_other_lines<VCacheOldSet>(hdl::kVCacheOldSet);
}
// Wrong texels.
TEST(CounterpartTextureCacheFaults, UnturnedLineIsDetected) {
  EXPECT_GE(compare<VCacheNotTurned>(hdl::kVCacheNotTurned, 20'000, 300).memory_differs, 1u);
}
}  // namespace
}  // namespace deburr::tb::counterpart_texture_cache_test
