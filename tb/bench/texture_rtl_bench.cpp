// SPDX-License-Identifier: MIT
// Speed of the texture unit's hardware model: the whole unit with cache, memory port and a TLM
// memory of 100 cycles latency, without tracing.
//
//   texture_rtl_bench    Mcycle/s, bilinears/s, instructions per cycle if the processor's counters
//       are readable, and speed of the golden model relative to it on the same fragments
//   texture_rtl_bench --cycles <workload> <n>    only n cycles of one workload, for counting
//       instructions with callgrind; workloads: nearest trilinear anisotropic warm, with the
//       paper's configuration; with the prefix deburr_ the preset deburr
#include <benchmark/benchmark.h>
#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <string>
#include <string_view>
#include <vector>

#include "golden/texture/texture_golden.h"
#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/link.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/platform/memory_model.h"
#include "rtl_model/platform/register_host.h"
#include "rtl_model/platform/texture_driver.h"
#include "rtl_model/texture/texture_unit.h"
#include "spec/texture/descriptor.h"
#include "spec/texture/packets.h"
#include "tb/stimuli/texture_quads.h"

namespace deburr::tb {
namespace {

using rtl::Activity;
using rtl::Cycle;

constexpr int kSize = 1024;  // texture side in texels
constexpr std::int32_t kTexel = spec::texture::kCoordinateOne / kSize;

enum class Workload : std::uint8_t { kNearest, kTrilinear, kAnisotropic, kWarm };
constexpr std::array<const char*, 4> kWorkloads = {"nearest", "trilinear", "anisotropic", "warm"};

// Quad number `count` of an endless scan in blocks of 8 x 8 pixels.
spec::texture::Quad quad_of(Workload workload, std::uint32_t count) {
  spec::texture::Quad q;
  q.tag = count;
  q.texture = static_cast<std::uint8_t>(workload);
  // Texels per pixel in x and y. Anisotropic: 12 to 1.5.
  const std::int32_t dx = workload == Workload::kAnisotropic ? 12 * kTexel : 3 * kTexel / 2;
  const std::int32_t dy = 3 * kTexel / 2;
  const std::uint32_t block = workload == Workload::kWarm ? 0 : count / 16;
  const auto x = static_cast<std::int32_t>(block % 64 * 8 + count % 4 * 2);
  const auto y = static_cast<std::int32_t>(block / 64 % 64 * 8 + count / 4 % 4 * 2);
  q.s = {x * dx, (x + 1) * dx, x * dx, (x + 1) * dx};
  q.t = {y * dy, y * dy, (y + 1) * dy, (y + 1) * dy};
  return q;
}

// 11 levels of 1024 x 1024 RGBA8, tiled, trilinear or nearest, N_max 16.
spec::texture::Descriptor texture_of(Workload workload) {
  spec::texture::Descriptor d;
  d.width = d.height = kSize;
  d.levels = 11;
  const bool nearest = workload == Workload::kNearest;
  d.min_filter =
      nearest ? spec::texture::MinFilter::kNearest : spec::texture::MinFilter::kLinearMipmapLinear;
  d.mag_filter = nearest ? spec::texture::MagFilter::kNearest : spec::texture::MagFilter::kLinear;
  d.max_anisotropy_log2 = 4;
  std::uint32_t base = 0;
  for (std::uint32_t k = 0; k < d.levels; ++k) {
    d.base[k] = base;
    base += std::max(64u, (kSize >> k) * (kSize >> k) * 4u);
  }
  return d;
}

std::vector<std::uint8_t> noise() {
  std::vector<std::uint8_t> bytes(8u << 20);
  std::uint32_t state = 1;
  for (std::uint8_t& byte : bytes) {
    state = state * 1664525u + 1013904223u;
    byte = static_cast<std::uint8_t>(state >> 24);
  }
  return bytes;
}

class Fragments final : public rtl::Unit {
 public:
  rtl::Out<spec::texture::Quad> quads_out{"quads_out"};
  Fragments(const sc_core::sc_module_name& name, rtl::ClockDomain& clock) : Unit(name, clock) {}
  void choose(Workload workload) { workload_ = workload; }

  Activity tick(Cycle cycle) override {
    if (!quads_out.can_push(cycle)) return rtl::kStalledDownstream;
    quads_out.push(cycle, quad_of(workload_, count_++));
    return rtl::kBusy;
  }
  void reset() override { count_ = 0; }

 private:
  Workload workload_ = Workload::kTrilinear;
  std::uint32_t count_ = 0;
};

class Picture final : public rtl::Unit {
 public:
  rtl::In<spec::texture::ColourGroup> colours_in{"colours_in"};
  Picture(const sc_core::sc_module_name& name, rtl::ClockDomain& clock) : Unit(name, clock) {}
  Activity tick(Cycle cycle) override {
    if (!colours_in.can_pop(cycle)) return rtl::kIdle;
    sum_ += colours_in.take(cycle).colour[0].rgba[0];
    return rtl::kBusy;
  }
  void reset() override { sum_ = 0; }

 private:
  std::uint64_t sum_ = 0;
};

platform::MemoryModelParameters memory_parameters() {
  platform::MemoryModelParameters p;
  p.bytes = 8u << 20;
  p.latency_min = p.latency_max = 100;
  p.outstanding = 256;
  p.record_reads = false;
  return p;
}

// SystemC elaborates once per process, so all benchmarks share the unit.
struct System {
  explicit System(const spec::texture::Parameters& parameters)
      : unit("texture", clock, with_fifo(parameters)) {
    fragments.quads_out(quads);
    unit.quads_in(quads);
    unit.colours_out(colours);
    picture.colours_in(colours);
    unit.memory()->bind(memory.ports);
    host.bus.bind(unit.registers);
    driver.load(noise());
  }
  static spec::texture::Parameters with_fifo(spec::texture::Parameters p) {
    p.cache_fifo_depth = 160;
    return p;
  }
  rtl::ClockDomain clock{"clock", sc_core::sc_time(6, sc_core::SC_NS)};
  rtl::Link<spec::texture::Quad> quads{"quads"};
  rtl::Link<spec::texture::ColourGroup> colours{"colours"};
  Fragments fragments{"fragments", clock};
  rtl::texture::TextureUnit unit;
  Picture picture{"picture", clock};
  platform::MemoryModel memory{"memory", clock.period(), memory_parameters()};
  platform::RegisterHost host{"host"};
  platform::TextureDriver driver{host, memory};

  // The first call selects the configuration.
  static System& only(
      const spec::texture::Parameters& parameters = stimuli::paper_configuration()) {
    static System system(parameters);
    return system;
  }

  void start(Workload workload) {
    clock.set_reset_n(false);
    clock.run(2);
    clock.set_reset_n(true);
    fragments.choose(workload);
    driver.set_texture(static_cast<int>(workload), texture_of(workload));
    clock.run(2000);
  }
  std::uint64_t bilinears() const { return unit.address.addresser.bilinears.value(); }
};

// Counts instructions of this process in user mode; 0 if the kernel does not allow it.
class InstructionCounter {
 public:
  InstructionCounter() {
    perf_event_attr attributes{};
    attributes.type = PERF_TYPE_HARDWARE;
    attributes.size = sizeof attributes;
    attributes.config = PERF_COUNT_HW_INSTRUCTIONS;
    attributes.exclude_kernel = 1;
    file_ = static_cast<int>(syscall(SYS_perf_event_open, &attributes, 0, -1, -1, 0));
  }
  ~InstructionCounter() {
    if (file_ >= 0) close(file_);
  }
  InstructionCounter(const InstructionCounter&) = delete;
  InstructionCounter& operator=(const InstructionCounter&) = delete;
  std::uint64_t value() const {
    std::uint64_t count = 0;
    return file_ >= 0 && read(file_, &count, sizeof count) == sizeof count ? count : 0;
  }

 private:
  int file_;
};

void bm_texture_rtl(benchmark::State& state, Workload workload) {
  constexpr Cycle kCycles = 100'000;
  System& system = System::only();
  system.start(workload);
  const InstructionCounter instructions;
  const std::uint64_t bilinears = system.bilinears(), counted = instructions.value();
  for (auto _ : state) system.clock.run(kCycles);
  const double cycles = static_cast<double>(state.iterations()) * kCycles;
  using benchmark::Counter;
  state.counters["cycles"] = Counter(cycles, Counter::kIsRate);
  state.counters["bilinears"] =
      Counter(static_cast<double>(system.bilinears() - bilinears), Counter::kIsRate);
  if (instructions.value() != 0)
    state.counters["instructions/cycle"] =
        static_cast<double>(instructions.value() - counted) / cycles;
}

// The golden model on the same fragments, in turns, so that the ratio is valid on a busy machine.
void bm_golden_over_rtl(benchmark::State& state, Workload workload,
                        golden::texture::TextureGolden::Traffic traffic) {
  constexpr Cycle kCycles = 50'000;
  System& system = System::only();
  system.start(workload);
  const std::vector<std::uint8_t> memory = noise();
  golden::texture::TextureGolden golden(stimuli::paper_configuration(), memory, traffic);
  golden.set_texture(static_cast<int>(workload), texture_of(workload));
  std::clock_t rtl_time = 0, golden_time = 0;
  std::uint32_t count = 0;
  for (auto _ : state) {
    const std::uint64_t before = system.bilinears();
    const std::clock_t begin = std::clock();
    system.clock.run(kCycles);
    const std::clock_t middle = std::clock();
    const std::uint64_t end = golden.work().bilinears + system.bilinears() - before;
    while (golden.work().bilinears < end)
      benchmark::DoNotOptimize(golden.process(quad_of(workload, count++)).colours);
    rtl_time += middle - begin;
    golden_time += std::clock() - middle;
  }
  state.counters["golden/rtl"] = static_cast<double>(rtl_time) / static_cast<double>(golden_time);
}

using Traffic = golden::texture::TextureGolden::Traffic;
BENCHMARK_CAPTURE(bm_golden_over_rtl, trilinear, Workload::kTrilinear, Traffic::kIgnore);
BENCHMARK_CAPTURE(bm_golden_over_rtl, trilinear_traffic, Workload::kTrilinear, Traffic::kPredict);
BENCHMARK_CAPTURE(bm_golden_over_rtl, anisotropic, Workload::kAnisotropic, Traffic::kIgnore);
BENCHMARK_CAPTURE(bm_texture_rtl, nearest, Workload::kNearest);
BENCHMARK_CAPTURE(bm_texture_rtl, trilinear, Workload::kTrilinear);
BENCHMARK_CAPTURE(bm_texture_rtl, anisotropic, Workload::kAnisotropic);
BENCHMARK_CAPTURE(bm_texture_rtl, warm, Workload::kWarm);

}  // namespace
}  // namespace deburr::tb

int main(int argc, char** argv) {
  using namespace deburr::tb;
  if (argc == 4 && std::string(argv[1]) == "--cycles") {
    constexpr std::string_view kPreset = "deburr_";
    std::string name = argv[2];
    const bool own_configuration = name.starts_with(kPreset);
    if (own_configuration) name.erase(0, kPreset.size());
    System& system = System::only(own_configuration ? deburr::spec::texture::Parameters{}
                                                    : stimuli::paper_configuration());
    for (std::size_t i = 0; i < kWorkloads.size(); ++i)
      if (name == kWorkloads[i]) system.start(static_cast<Workload>(i));
    const std::uint64_t before = system.bilinears();
    system.clock.run(std::strtoull(argv[3], nullptr, 10));
    std::cout << system.bilinears() - before << " bilinears\n";
    return 0;
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
