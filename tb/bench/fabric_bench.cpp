// SPDX-License-Identifier: MIT
// Speed of the fabric: a pipeline of ten units that pass tokens of 64 bytes, each unit stalled at
// random in one of eight cycles, against the same work in a plain loop without timing.
//
//   fabric_bench                               wall time, Mcycle/s
//   fabric_bench --cycles <mode> <n>           only n cycles of one mode, for counting instructions
//       with callgrind (docs/explanation/fabric.md); modes: plain fast slow shuffled
#include <benchmark/benchmark.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/link.h"
#include "rtl_model/fabric/unit.h"

namespace deburr::tb {
namespace {

using rtl::Activity;
using rtl::Cycle;

constexpr int kStages = 8;  // plus a source and a sink

struct Token {
  std::array<std::uint32_t, 16> words;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("words", self.words, 32);
  }
};

// Noise from one register: a linear congruential generator; the top bits are used.
class Noise {
 public:
  explicit Noise(std::uint32_t seed) : state_(seed * 2654435761U + 1) {}
  bool one_in_eight() {
    state_ = state_ * 1664525U + 1013904223U;
    return state_ >> 29 == 0;
  }

 private:
  std::uint32_t state_;
};

void work(Token& to, const Token& from, std::uint32_t key) {
  for (std::size_t i = 0; i < from.words.size(); ++i)
    to.words[i] = (from.words[i] + key) ^ (from.words[i] >> 7);
}

std::uint32_t fold(const Token& token) {
  std::uint32_t sum = 0;
  for (const std::uint32_t word : token.words) sum += word;
  return sum;
}

class Source final : public rtl::Unit {
 public:
  rtl::Out<Token> tokens_out{"tokens_out"};
  Source(const sc_core::sc_module_name& name, rtl::ClockDomain& clock)
      : Unit(name, clock), stalled_(declare_stall("noise", "stalled at random")) {}
  Activity tick(Cycle cycle) override {
    if (noise_.one_in_eight()) return stalled_;
    if (!tokens_out.can_push(cycle)) return rtl::kStalledDownstream;
    Token& token = tokens_out.emplace(cycle);
    for (std::uint32_t& word : token.words) word = count_ * 0x9E3779B9U;
    ++count_;
    return rtl::kBusy;
  }
  void reset() override { count_ = 0; }

 private:
  Activity stalled_;
  Noise noise_{1};
  std::uint32_t count_ = 0;
};

class Stage final : public rtl::Unit {
 public:
  rtl::In<Token> tokens_in{"tokens_in"};
  rtl::Out<Token> tokens_out{"tokens_out"};
  Stage(const sc_core::sc_module_name& name, rtl::ClockDomain& clock, std::uint32_t key)
      : Unit(name, clock),
        stalled_(declare_stall("noise", "stalled at random")),
        noise_(key + 2),
        key_(key) {}
  Activity tick(Cycle cycle) override {
    if (noise_.one_in_eight()) return stalled_;
    if (!tokens_in.can_pop(cycle)) return rtl::kIdle;
    if (!tokens_out.can_push(cycle)) return rtl::kStalledDownstream;
    work(tokens_out.emplace(cycle), tokens_in.front(cycle), key_);
    tokens_in.pop(cycle);
    return rtl::kBusy;
  }
  void reset() override {}

 private:
  Activity stalled_;
  Noise noise_;
  std::uint32_t key_;
};

class Sink final : public rtl::Unit {
 public:
  rtl::In<Token> tokens_in{"tokens_in"};
  Sink(const sc_core::sc_module_name& name, rtl::ClockDomain& clock)
      : Unit(name, clock), stalled_(declare_stall("noise", "stalled at random")) {}
  Activity tick(Cycle cycle) override {
    if (noise_.one_in_eight()) return stalled_;
    if (!tokens_in.can_pop(cycle)) return rtl::kIdle;
    checksum_ = checksum_ * 31 + fold(tokens_in.front(cycle));
    tokens_in.pop(cycle);
    ++count_;
    return rtl::kBusy;
  }
  void reset() override { count_ = checksum_ = 0; }
  std::uint64_t count() const { return count_; }
  std::uint64_t checksum() const { return checksum_; }

 private:
  Activity stalled_;
  Noise noise_{99};
  std::uint64_t count_ = 0, checksum_ = 0;
};

struct Pipeline {
  rtl::ClockDomain clock{"clock", sc_core::sc_time(1, sc_core::SC_NS)};
  Source source{"source", clock};
  std::vector<std::unique_ptr<Stage>> stages;
  Sink sink{"sink", clock};
  std::vector<std::unique_ptr<rtl::Link<Token>>> links;

  Pipeline() {
    for (int i = 0; i <= kStages; ++i)
      links.push_back(std::make_unique<rtl::Link<Token>>(("link_" + std::to_string(i)).c_str()));
    source.tokens_out(*links[0]);
    for (std::size_t i = 0; i < kStages; ++i) {
      const auto key = static_cast<std::uint32_t>(i);
      stages.push_back(std::make_unique<Stage>(("stage_" + std::to_string(i)).c_str(), clock, key));
      stages[i]->tokens_in(*links[i]);
      stages[i]->tokens_out(*links[i + 1]);
    }
    sink.tokens_in(*links[kStages]);
  }
  // SystemC elaborates once per process, so all benchmarks share the pipeline and continue with it.
  static Pipeline& only() {
    static Pipeline pipeline;
    return pipeline;
  }
};

// The same tokens through the same eight functions, with the noise, but without links and timing.
std::uint64_t plain(std::uint64_t tokens) {
  std::uint64_t checksum = 0;
  Noise noise(1);
  for (std::uint64_t n = 0; n < tokens; ++n) {
    Token a, b;
    for (std::uint32_t& word : a.words) word = static_cast<std::uint32_t>(n) * 0x9E3779B9U;
    for (std::uint32_t i = 0; i < kStages; i += 2) {
      checksum += noise.one_in_eight();
      work(b, a, i);
      benchmark::DoNotOptimize(b);
      checksum += noise.one_in_eight();
      work(a, b, i + 1);
      benchmark::DoNotOptimize(a);
    }
    checksum = checksum * 31 + fold(a);
  }
  return checksum;
}

void set_mode(const std::string& mode) {
  rtl::ClockDomain& clock = Pipeline::only().clock;
  clock.set_fast_path(mode != "slow");
  clock.shuffle(mode == "shuffled" ? std::optional<std::uint64_t>(7) : std::nullopt);
}

void bm_fabric(benchmark::State& state, const std::string& mode) {
  constexpr Cycle kCycles = 100'000;
  Pipeline& pipeline = Pipeline::only();
  set_mode(mode);
  for (auto _ : state) pipeline.clock.run(kCycles);
  state.counters["cycles"] = benchmark::Counter(static_cast<double>(state.iterations()) * kCycles,
                                                benchmark::Counter::kIsRate);
}

void bm_plain(benchmark::State& state) {
  constexpr std::uint64_t kTokens = 100'000;
  for (auto _ : state) benchmark::DoNotOptimize(plain(kTokens));
  state.counters["cycles"] = benchmark::Counter(static_cast<double>(state.iterations()) * kTokens,
                                                benchmark::Counter::kIsRate);
}

BENCHMARK_CAPTURE(bm_fabric, fast, std::string("fast"));
BENCHMARK_CAPTURE(bm_fabric, slow, std::string("slow"));
BENCHMARK_CAPTURE(bm_fabric, shuffled, std::string("shuffled"));
BENCHMARK(bm_plain);

int count_instructions(const std::string& mode, std::uint64_t cycles) {
  if (mode == "plain") {
    std::cout << "plain: " << cycles << " tokens, checksum " << plain(cycles) << '\n';
    return 0;
  }
  Pipeline& pipeline = Pipeline::only();
  set_mode(mode);
  pipeline.clock.run(cycles);
  std::cout << mode << ": " << cycles << " cycles, " << pipeline.sink.count()
            << " tokens, checksum " << pipeline.sink.checksum() << '\n';
  return 0;
}

}  // namespace
}  // namespace deburr::tb

int main(int argc, char** argv) {
  if (argc == 4 && std::strcmp(argv[1], "--cycles") == 0)
    return deburr::tb::count_instructions(argv[2], std::strtoull(argv[3], nullptr, 10));
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
